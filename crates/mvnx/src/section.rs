//! The sections of a frame: their names, what they have an entry for, and how many numbers an entry has.

use crate::Place;
use crate::error::Error;
use crate::header::Header;

/// A section of a frame that this crate knows: MVN User Manual MV0319, the frame element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Orientation,
    Position,
    Velocity,
    Acceleration,
    AngularVelocity,
    AngularAcceleration,
    FootContacts,
    SensorFreeAcceleration,
    SensorAcceleration,
    SensorAngularVelocity,
    SensorMagneticField,
    SensorOrientation,
    JointAngle,
    JointAngleXzy,
    JointAngleErgo,
    JointAngleErgoXzy,
    CenterOfMass,
    PositionFingersLeft,
    PositionFingersRight,
    OrientationFingersLeft,
    OrientationFingersRight,
    JointAngleFingersLeft,
    JointAngleFingersRight,
    JointAngleFingersLeftXzy,
    JointAngleFingersRightXzy,
}

/// What a section has an entry for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Per {
    Segment,
    Sensor,
    Joint,
    ErgonomicAngle,
    Contact,
    LeftFinger,
    RightFinger,
    LeftFingerJoint,
    RightFingerJoint,
    Body,
}

impl Section {
    /// The section with this element name.
    pub(crate) fn of(name: &str) -> Option<Self> {
        let row = TABLE.iter().find(|row| row.1 == name);
        row.map(|row| row.0)
    }

    /// All sections in the order in which MVN writes them.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.0)
    }

    /// Its element name.
    pub(crate) fn name(self) -> &'static str {
        self.row().1
    }

    /// What it has an entry for.
    pub(crate) fn per(self) -> Per {
        self.row().2
    }

    /// How many numbers an entry has.
    pub(crate) fn columns(self) -> usize {
        self.row().3
    }

    /// A bit of its own among all sections.
    pub(crate) fn bit(self) -> u32 {
        1 << self as u32
    }

    fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }
}

/// How many entries sections have: what the file defines of each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) segments: usize,
    pub(crate) left_fingers: usize,
    pub(crate) right_fingers: usize,
    pub(crate) sensors: usize,
    pub(crate) joints: usize,
    pub(crate) left_finger_joints: usize,
    pub(crate) right_finger_joints: usize,
    ergonomic_angles: usize,
    contacts: usize,
}

impl Layout {
    pub(crate) fn new(header: &Header) -> Self {
        Self {
            segments: header.segments.len(),
            left_fingers: header.finger_segments.left.len(),
            right_fingers: header.finger_segments.right.len(),
            sensors: header.sensors.len(),
            joints: header.joints.len(),
            left_finger_joints: header.finger_joints.left.len(),
            right_finger_joints: header.finger_joints.right.len(),
            ergonomic_angles: header.ergonomic_angles.len(),
            contacts: header.contacts.len(),
        }
    }

    /// Of a file that defines segments only: of body and props, of the left and of the right hand.
    pub(crate) fn of_segments([segments, left_fingers, right_fingers]: [usize; 3]) -> Self {
        Self {
            segments,
            left_fingers,
            right_fingers,
            ..Self::default()
        }
    }

    /// Segments of body, props and hands.
    pub(crate) fn all_segments(&self) -> usize {
        self.segments + self.left_fingers + self.right_fingers
    }

    /// Joints of body and hands.
    pub(crate) fn all_joints(&self) -> usize {
        self.joints + self.left_finger_joints + self.right_finger_joints
    }

    /// The section with this element name, when the file has what it has entries for.
    pub(crate) fn section(&self, name: &str) -> Option<Section> {
        Section::of(name).filter(|&section| self.entries(section) > 0)
    }

    /// How many entries a section has. None means that the file has it, if at all, without saying of what.
    pub(crate) fn entries(&self, section: Section) -> usize {
        match section.per() {
            Per::Segment => self.segments,
            Per::Sensor => self.sensors,
            Per::Joint => self.joints,
            Per::ErgonomicAngle => self.ergonomic_angles,
            Per::Contact => self.contacts,
            Per::LeftFinger => self.left_fingers,
            Per::RightFinger => self.right_fingers,
            Per::LeftFingerJoint => self.left_finger_joints,
            Per::RightFingerJoint => self.right_finger_joints,
            Per::Body => 1,
        }
    }

    /// Checks how many numbers a section holds.
    pub(crate) fn check(&self, section: Section, found: usize, at: Place) -> Result<(), Error> {
        let (entries, columns) = (self.entries(section), section.columns());
        // Newer releases of MVN write the centre of mass with its velocity and acceleration.
        if found == entries * columns || (section == Section::CenterOfMass && found == 9) {
            return Ok(());
        }
        let what = match section.per() {
            Per::Segment => "segments",
            Per::Sensor => "sensors",
            Per::Joint => "joints",
            Per::ErgonomicAngle => "ergonomic angles",
            Per::Contact => "contacts",
            Per::LeftFinger => "left finger segments",
            Per::RightFinger => "right finger segments",
            Per::LeftFingerJoint => "left finger joints",
            Per::RightFingerJoint => "right finger joints",
            Per::Body => "position",
        };
        Err(Error::Columns {
            at,
            section: section.name(),
            expected: entries * columns,
            entries: format!("{entries} {what} x {columns}"),
            found,
        })
    }
}

/// Name, what it is per, numbers per entry.
type Row = (Section, &'static str, Per, usize);

/// In the order of [`Section`].
const TABLE: [Row; 25] = [
    (Section::Orientation, "orientation", Per::Segment, 4),
    (Section::Position, "position", Per::Segment, 3),
    (Section::Velocity, "velocity", Per::Segment, 3),
    (Section::Acceleration, "acceleration", Per::Segment, 3),
    (Section::AngularVelocity, "angularVelocity", Per::Segment, 3),
    (Section::AngularAcceleration, "angularAcceleration", Per::Segment, 3),
    (Section::FootContacts, "footContacts", Per::Contact, 1),
    (
        Section::SensorFreeAcceleration,
        "sensorFreeAcceleration",
        Per::Sensor,
        3,
    ),
    (Section::SensorAcceleration, "sensorAcceleration", Per::Sensor, 3),
    (Section::SensorAngularVelocity, "sensorAngularVelocity", Per::Sensor, 3),
    (Section::SensorMagneticField, "sensorMagneticField", Per::Sensor, 3),
    (Section::SensorOrientation, "sensorOrientation", Per::Sensor, 4),
    (Section::JointAngle, "jointAngle", Per::Joint, 3),
    (Section::JointAngleXzy, "jointAngleXZY", Per::Joint, 3),
    (Section::JointAngleErgo, "jointAngleErgo", Per::ErgonomicAngle, 3),
    (Section::JointAngleErgoXzy, "jointAngleErgoXZY", Per::ErgonomicAngle, 3),
    (Section::CenterOfMass, "centerOfMass", Per::Body, 3),
    (Section::PositionFingersLeft, "positionFingersLeft", Per::LeftFinger, 3),
    (
        Section::PositionFingersRight,
        "positionFingersRight",
        Per::RightFinger,
        3,
    ),
    (
        Section::OrientationFingersLeft,
        "orientationFingersLeft",
        Per::LeftFinger,
        4,
    ),
    (
        Section::OrientationFingersRight,
        "orientationFingersRight",
        Per::RightFinger,
        4,
    ),
    (
        Section::JointAngleFingersLeft,
        "jointAngleFingersLeft",
        Per::LeftFingerJoint,
        3,
    ),
    (
        Section::JointAngleFingersRight,
        "jointAngleFingersRight",
        Per::RightFingerJoint,
        3,
    ),
    (
        Section::JointAngleFingersLeftXzy,
        "jointAngleFingersLeftXZY",
        Per::LeftFingerJoint,
        3,
    ),
    (
        Section::JointAngleFingersRightXzy,
        "jointAngleFingersRightXZY",
        Per::RightFingerJoint,
        3,
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_sections() {
        for (place, row) in TABLE.iter().enumerate() {
            assert_eq!(row.0 as usize, place);
            assert_eq!(Section::of(row.1), Some(row.0));
        }
        assert_eq!(Section::of("marker"), None);
    }

    #[test]
    fn wrong_columns_are_told_with_their_reason() {
        let layout = Layout {
            segments: 23,
            ..Layout::default()
        };
        let at = Place { line: 7, offset: 0 };
        assert_eq!(layout.check(Section::Orientation, 92, at), Ok(()));
        let error = layout.check(Section::Orientation, 91, at).unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 7 (byte 0): orientation: expected 92 numbers (23 segments x 4), found 91"
        );
        assert_eq!(layout.check(Section::CenterOfMass, 3, at), Ok(()));
        assert_eq!(layout.check(Section::CenterOfMass, 9, at), Ok(()));
        assert!(layout.check(Section::CenterOfMass, 6, at).is_err());
    }
}
