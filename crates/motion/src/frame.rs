//! One sample of one subject.

use crate::time::seconds;
use crate::{Error, Pose, Stamp, Subject, Timecode};
use glam::{DQuat, DVec3};
use std::sync::Arc;
use std::time::Duration;

/// One sample of one subject: everything the source said of one instant.
///
/// A section is a list with an entry for each segment, joint or sensor of the subject's skeleton, in its order. An empty
/// list means that the source does not send the section; a `None` in it, that the entry was not tracked. All values are
/// canonical: metres, radians, seconds, X forward, Y left, Z up, in the world unless said otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Whose sample it is.
    pub subject: Arc<Subject>,
    /// The source's number of the sample.
    pub sample: u32,
    /// The source's clock: time since its recording began.
    pub time: Duration,
    /// When it arrived here.
    pub received: Option<Stamp>,
    /// Whether a newer sample of the subject had arrived before it. A take does not keep that.
    pub late: bool,
    /// The time of day, UTC, where the source says.
    pub timecode: Option<Timecode>,

    /// Per segment: its origin, m.
    pub position: Vec<Option<DVec3>>,
    /// Per segment: from its axes to the world's.
    pub orientation: Vec<Option<DQuat>>,
    /// Per segment: velocity of its origin, m/s.
    pub velocity: Vec<Option<DVec3>>,
    /// Per segment: acceleration of its origin, m/s².
    pub acceleration: Vec<Option<DVec3>>,
    /// Per segment: angular velocity, rad/s.
    pub angular_velocity: Vec<Option<DVec3>>,
    /// Per segment: angular acceleration, rad/s².
    pub angular_acceleration: Vec<Option<DVec3>>,

    /// Per joint: abduction, internal rotation, flexion (x, y, z) by the ISB's ZXY sequence, rad.
    pub joint_angles: Vec<Option<DVec3>>,
    /// Per joint: the same by the XZY sequence, rad.
    pub joint_angles_xzy: Vec<Option<DVec3>>,
    /// Per ergonomic angle, ZXY, rad.
    pub ergonomic_angles: Vec<Option<DVec3>>,
    /// Per ergonomic angle, XZY, rad.
    pub ergonomic_angles_xzy: Vec<Option<DVec3>>,

    /// Per sensor: from its axes to the world's.
    pub sensor_orientation: Vec<Option<DQuat>>,
    /// Per sensor: acceleration without gravity, in the world, m/s².
    pub sensor_free_acceleration: Vec<Option<DVec3>>,
    /// Per sensor: acceleration with gravity, in the sensor's axes, m/s².
    pub sensor_acceleration: Vec<Option<DVec3>>,
    /// Per sensor: angular velocity in the sensor's axes, rad/s.
    pub sensor_angular_velocity: Vec<Option<DVec3>>,
    /// Per sensor: magnetic field in the sensor's axes, in units of the field at calibration.
    pub sensor_magnetic_field: Vec<Option<DVec3>>,

    /// The body's centre of mass.
    pub center_of_mass: Option<CenterOfMass>,
    /// Per contact of the skeleton: whether it touches the ground.
    pub contacts: Vec<bool>,
    /// Points that the source sends on their own.
    pub markers: Vec<Marker>,
    /// Names of events that the operator set at this sample.
    pub events: Vec<String>,
}

impl Frame {
    /// An empty sample 0 of a subject.
    pub fn new(subject: Arc<Subject>) -> Self {
        Self {
            subject,
            sample: 0,
            time: Duration::ZERO,
            received: None,
            late: false,
            timecode: None,
            position: Vec::new(),
            orientation: Vec::new(),
            velocity: Vec::new(),
            acceleration: Vec::new(),
            angular_velocity: Vec::new(),
            angular_acceleration: Vec::new(),
            joint_angles: Vec::new(),
            joint_angles_xzy: Vec::new(),
            ergonomic_angles: Vec::new(),
            ergonomic_angles_xzy: Vec::new(),
            sensor_orientation: Vec::new(),
            sensor_free_acceleration: Vec::new(),
            sensor_acceleration: Vec::new(),
            sensor_angular_velocity: Vec::new(),
            sensor_magnetic_field: Vec::new(),
            center_of_mass: None,
            contacts: Vec::new(),
            markers: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Makes the frame an empty sample 0 of the same subject again. Its lists keep their memory.
    pub fn clear(&mut self) {
        // Named one by one, so that a new field cannot be forgotten.
        let Self {
            subject: _,
            sample,
            time,
            received,
            late,
            timecode,
            position,
            orientation,
            velocity,
            acceleration,
            angular_velocity,
            angular_acceleration,
            joint_angles,
            joint_angles_xzy,
            ergonomic_angles,
            ergonomic_angles_xzy,
            sensor_orientation,
            sensor_free_acceleration,
            sensor_acceleration,
            sensor_angular_velocity,
            sensor_magnetic_field,
            center_of_mass,
            contacts,
            markers,
            events,
        } = self;
        (*sample, *time, *late) = (0, Duration::ZERO, false);
        (*received, *timecode, *center_of_mass) = (None, None, None);
        for rotations in [orientation, sensor_orientation] {
            rotations.clear();
        }
        for vectors in [
            position,
            velocity,
            acceleration,
            angular_velocity,
            angular_acceleration,
            joint_angles,
            joint_angles_xzy,
            ergonomic_angles,
            ergonomic_angles_xzy,
            sensor_free_acceleration,
            sensor_acceleration,
            sensor_angular_velocity,
            sensor_magnetic_field,
        ] {
            vectors.clear();
        }
        contacts.clear();
        markers.clear();
        events.clear();
    }

    /// The pose of the segment at a place of the skeleton, when both its position and its orientation are known.
    pub fn pose(&self, segment: usize) -> Option<Pose> {
        let position = self.position.get(segment).copied().flatten()?;
        let orientation = self.orientation.get(segment).copied().flatten()?;
        Some(Pose::new(position, orientation))
    }

    /// The source's clock in seconds, as [`Take::seconds`](crate::Take::seconds) has it.
    pub fn seconds(&self) -> f64 {
        seconds(self.time)
    }

    /// Checks that every section that is there has an entry for each segment, joint or sensor.
    ///
    /// # Errors
    /// [`Error::SectionLength`] for the first section that has not.
    pub fn check(&self) -> Result<(), Error> {
        let skeleton = &self.subject.skeleton;
        let (segments, joints) = (skeleton.segments.len(), skeleton.joints.len());
        let (angles, sensors) = (skeleton.ergonomic_angles.len(), skeleton.sensors.len());
        let lengths = [
            ("position", self.position.len(), segments),
            ("orientation", self.orientation.len(), segments),
            ("velocity", self.velocity.len(), segments),
            ("acceleration", self.acceleration.len(), segments),
            ("angular_velocity", self.angular_velocity.len(), segments),
            ("angular_acceleration", self.angular_acceleration.len(), segments),
            ("joint_angles", self.joint_angles.len(), joints),
            ("joint_angles_xzy", self.joint_angles_xzy.len(), joints),
            ("ergonomic_angles", self.ergonomic_angles.len(), angles),
            ("ergonomic_angles_xzy", self.ergonomic_angles_xzy.len(), angles),
            ("sensor_orientation", self.sensor_orientation.len(), sensors),
            ("sensor_free_acceleration", self.sensor_free_acceleration.len(), sensors),
            ("sensor_acceleration", self.sensor_acceleration.len(), sensors),
            ("sensor_angular_velocity", self.sensor_angular_velocity.len(), sensors),
            ("sensor_magnetic_field", self.sensor_magnetic_field.len(), sensors),
            ("contacts", self.contacts.len(), skeleton.contacts.len()),
        ];
        let wrong = lengths
            .into_iter()
            .find(|&(_, found, expected)| found != 0 && found != expected);
        wrong.map_or(Ok(()), |(section, found, expected)| {
            Err(Error::SectionLength {
                section,
                sample: self.sample,
                expected,
                found,
            })
        })
    }
}

/// The body's centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CenterOfMass {
    /// Where it is, m.
    pub position: DVec3,
    /// Its velocity, m/s, where known.
    pub velocity: Option<DVec3>,
    /// Its acceleration, m/s², where known.
    pub acceleration: Option<DVec3>,
}

/// A point that a source sends on its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    /// The source's number of it: MXTP 256 times the segment's id plus the point's.
    pub id: u32,
    /// Where it is, m; `None` when it was not seen.
    pub position: Option<DVec3>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Skeleton;

    #[test]
    fn a_section_of_the_wrong_length_is_named() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        assert_eq!(frame.check(), Ok(()));
        frame.position = vec![None; 22];
        let expected = Error::SectionLength {
            section: "position",
            sample: 0,
            expected: 23,
            found: 22,
        };
        assert_eq!(frame.check(), Err(expected));
    }

    #[test]
    fn a_cleared_frame_is_as_new() {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut frame = Frame::new(subject.clone());
        frame.sample = 7;
        frame.time = Duration::from_secs(1);
        (frame.received, frame.late) = (Some(Stamp(1)), true);
        frame.timecode = Some(Timecode::from_milliseconds(1));
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame.joint_angles_xzy = vec![None; 22];
        frame.contacts = vec![true; 4];
        frame.events = vec!["clap".to_owned()];
        frame.clear();
        assert_eq!(frame, Frame::new(subject));
        assert!(frame.orientation.capacity() >= 23);
    }

    #[test]
    fn a_pose_needs_position_and_orientation() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.position = vec![Some(DVec3::X); 23];
        assert_eq!(frame.pose(0), None);
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        assert_eq!(frame.pose(0), Some(Pose::new(DVec3::X, DQuat::IDENTITY)));
        assert_eq!(frame.pose(23), None);
    }
}
