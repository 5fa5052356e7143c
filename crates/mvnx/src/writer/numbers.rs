//! The numbers of a frame as the sections of a file hold them.

use super::Version;
use crate::Error;
use crate::section::{Layout, Per, Section};
use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame};
use std::ops::Range;

/// Turns a frame's values into a file's numbers.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    pub(crate) layout: Layout,
    /// Per segment that needs it: what turns the canonical orientation to the file's.
    turns: Vec<(usize, DQuat)>,
    values: Vec<f64>,
}

/// How much of a section a frame holds.
#[derive(Debug, PartialEq)]
pub(crate) enum Found<'a> {
    /// Nothing.
    None,
    /// Some of it. A file has no word for what is not known.
    Part,
    /// All of it.
    All(&'a mut [f64]),
}

impl Numbers {
    pub(crate) fn new(layout: Layout, turns: Vec<(usize, DQuat)>) -> Self {
        Self {
            layout,
            turns,
            values: Vec::new(),
        }
    }

    /// The numbers of a section in the units and axes of the file.
    pub(crate) fn of(&mut self, frame: &Frame, section: Section) -> Found<'_> {
        self.values.clear();
        self.add(frame, section);
        if self.values.is_empty() {
            Found::None
        } else if self.values.iter().all(|number| number.is_finite()) {
            Found::All(&mut self.values)
        } else {
            Found::Part
        }
    }

    /// Adds the numbers of a section, nothing when the frame has none of it; what is not known is NaN.
    fn add(&mut self, frame: &Frame, section: Section) {
        let places = places(section, &self.layout);
        let vectors = |list| vectors(list, places.clone());
        match section {
            Section::Orientation | Section::OrientationFingersLeft | Section::OrientationFingersRight => {
                self.add_turned(&frame.orientation, places);
            }
            Section::SensorOrientation => add(&mut self.values, quaternions(&frame.sensor_orientation, places)),
            Section::Position | Section::PositionFingersLeft | Section::PositionFingersRight => {
                add(&mut self.values, vectors(&frame.position));
            }
            Section::Velocity => add(&mut self.values, vectors(&frame.velocity)),
            Section::Acceleration => add(&mut self.values, vectors(&frame.acceleration)),
            Section::AngularVelocity => add(&mut self.values, vectors(&frame.angular_velocity)),
            Section::AngularAcceleration => add(&mut self.values, vectors(&frame.angular_acceleration)),
            Section::SensorFreeAcceleration => add(&mut self.values, vectors(&frame.sensor_free_acceleration)),
            Section::SensorAcceleration => add(&mut self.values, vectors(&frame.sensor_acceleration)),
            Section::SensorAngularVelocity => add(&mut self.values, vectors(&frame.sensor_angular_velocity)),
            Section::SensorMagneticField => add(&mut self.values, vectors(&frame.sensor_magnetic_field)),
            Section::JointAngle | Section::JointAngleFingersLeft | Section::JointAngleFingersRight => {
                add(&mut self.values, degrees(&frame.joint_angles, places));
            }
            Section::JointAngleXzy | Section::JointAngleFingersLeftXzy | Section::JointAngleFingersRightXzy => {
                add(&mut self.values, degrees(&frame.joint_angles_xzy, places));
            }
            Section::JointAngleErgo => add(&mut self.values, degrees(&frame.ergonomic_angles, places)),
            Section::JointAngleErgoXzy => add(&mut self.values, degrees(&frame.ergonomic_angles_xzy, places)),
            Section::FootContacts => {
                let contacts = frame.contacts.iter().map(|&contact| f64::from(u8::from(contact)));
                self.values.extend(contacts);
            }
            Section::CenterOfMass => {
                self.values.extend(frame.center_of_mass.iter().flat_map(center_of_mass));
            }
        }
    }

    /// Adds orientations of segments in the axes of the file.
    fn add_turned(&mut self, list: &[Option<DQuat>], places: Range<usize>) {
        add(&mut self.values, quaternions(list, places.clone()));
        if self.values.is_empty() {
            return;
        }
        let inside = self.turns.iter().filter(|(place, _)| places.contains(place));
        for &(place, turn) in inside {
            let numbers = &mut self.values[4 * (place - places.start)..][..4];
            let turned = DQuat::from_xyzw(numbers[1], numbers[2], numbers[3], numbers[0]) * turn;
            numbers.copy_from_slice(&wxyz(turned).map(without_noise));
        }
    }
}

/// Checks that every list of a frame has as many entries as the file defines, or that the version has no place for it.
pub(crate) fn check(frame: &Frame, layout: &Layout, version: Version) -> Result<(), Error> {
    let (segments, joints) = (layout.all_segments(), layout.all_joints());
    let (sensors, angles) = (layout.sensors, layout.entries(Section::JointAngleErgo));
    let lengths = [
        (Section::Orientation, frame.orientation.len(), segments),
        (Section::Position, frame.position.len(), segments),
        (Section::Velocity, frame.velocity.len(), segments),
        (Section::Acceleration, frame.acceleration.len(), segments),
        (Section::AngularVelocity, frame.angular_velocity.len(), segments),
        (Section::AngularAcceleration, frame.angular_acceleration.len(), segments),
        (Section::JointAngle, frame.joint_angles.len(), joints),
        (Section::JointAngleXzy, frame.joint_angles_xzy.len(), joints),
        (Section::JointAngleErgo, frame.ergonomic_angles.len(), angles),
        (Section::JointAngleErgoXzy, frame.ergonomic_angles_xzy.len(), angles),
        (Section::SensorOrientation, frame.sensor_orientation.len(), sensors),
        (
            Section::SensorFreeAcceleration,
            frame.sensor_free_acceleration.len(),
            sensors,
        ),
        (Section::SensorAcceleration, frame.sensor_acceleration.len(), sensors),
        (
            Section::SensorAngularVelocity,
            frame.sensor_angular_velocity.len(),
            sensors,
        ),
        (Section::SensorMagneticField, frame.sensor_magnetic_field.len(), sensors),
        (
            Section::FootContacts,
            frame.contacts.len(),
            layout.entries(Section::FootContacts),
        ),
    ];
    let wrong = lengths
        .into_iter()
        .find(|&(section, found, expected)| found != 0 && found != expected && section.is_in(version));
    wrong.map_or(Ok(()), |(section, found, expected)| {
        Err(Error::Misfit {
            section: section.name(),
            sample: frame.sample,
            expected,
            found,
        })
    })
}

/// Which places of a frame's list are those of a section.
pub(crate) fn places(section: Section, layout: &Layout) -> Range<usize> {
    let begin = match section.per() {
        Per::LeftFinger => layout.segments,
        Per::RightFinger => layout.segments + layout.left_fingers,
        Per::LeftFingerJoint => layout.joints,
        Per::RightFingerJoint => layout.joints + layout.left_finger_joints,
        _ => 0,
    };
    begin..begin + layout.entries(section)
}

/// Adds numbers, NaN for those not known; nothing when none is.
fn add<const N: usize>(to: &mut Vec<f64>, entries: impl Iterator<Item = Option<[f64; N]>> + Clone) {
    if entries.clone().any(|entry| entry.is_some()) {
        entries.for_each(|entry| to.extend_from_slice(&entry.unwrap_or([f64::NAN; N])));
    }
}

fn vectors(list: &[Option<DVec3>], places: Range<usize>) -> impl Iterator<Item = Option<[f64; 3]>> + Clone {
    let part = list.get(places).unwrap_or_default();
    part.iter().map(|vector| vector.map(|vector| vector.to_array()))
}

fn degrees(list: &[Option<DVec3>], places: Range<usize>) -> impl Iterator<Item = Option<[f64; 3]>> + Clone {
    vectors(list, places).map(|angles| angles.map(|angles| angles.map(f64::to_degrees)))
}

fn quaternions(list: &[Option<DQuat>], places: Range<usize>) -> impl Iterator<Item = Option<[f64; 4]>> + Clone {
    let part = list.get(places).unwrap_or_default();
    part.iter().map(|q| q.map(wxyz))
}

/// The components as a file has them.
pub(crate) fn wxyz(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

fn center_of_mass(center: &CenterOfMass) -> impl Iterator<Item = f64> {
    let derived = center.velocity.zip(center.acceleration);
    let derived = derived
        .into_iter()
        .flat_map(|(velocity, acceleration)| [velocity, acceleration]);
    std::iter::once(center.position)
        .chain(derived)
        .flat_map(|vector| vector.to_array())
}

/// A turn and its inverse leave of a zero what `f64` rounds off, of either sign.
pub(super) fn without_noise(number: f64) -> f64 {
    if number.abs() < 1e-12 { 0.0 } else { number }
}
