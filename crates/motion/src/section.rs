//! The kinds of numbers that a frame can have.

use crate::{Error, Skeleton};
use std::fmt;
use std::str::FromStr;

/// One kind of number that a frame can have: a list of [`Frame`](crate::Frame), or a part of its centre of mass.
///
/// Units, axes and frames of reference are those of the fields of `Frame`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Section {
    /// Per segment: its origin, m.
    Position,
    /// Per segment: from its axes to the world's.
    Orientation,
    /// Per segment: velocity of its origin, m/s.
    Velocity,
    /// Per segment: acceleration of its origin, m/s².
    Acceleration,
    /// Per segment: angular velocity, rad/s.
    AngularVelocity,
    /// Per segment: angular acceleration, rad/s².
    AngularAcceleration,
    /// Per joint: abduction, internal rotation, flexion by the ZXY sequence, rad.
    JointAngles,
    /// Per joint: the same by the XZY sequence, rad.
    JointAnglesXzy,
    /// Per ergonomic angle, ZXY, rad.
    ErgonomicAngles,
    /// Per ergonomic angle, XZY, rad.
    ErgonomicAnglesXzy,
    /// Per sensor: from its axes to the world's.
    SensorOrientation,
    /// Per sensor: acceleration without gravity, in the world, m/s².
    SensorFreeAcceleration,
    /// Per sensor: acceleration with gravity, in the sensor's axes, m/s².
    SensorAcceleration,
    /// Per sensor: angular velocity in the sensor's axes, rad/s.
    SensorAngularVelocity,
    /// Per sensor: magnetic field in the sensor's axes, in units of the field at calibration.
    SensorMagneticField,
    /// Where the body's centre of mass is, m.
    CenterOfMass,
    /// The velocity of the centre of mass, m/s.
    CenterOfMassVelocity,
    /// The acceleration of the centre of mass, m/s².
    CenterOfMassAcceleration,
}

/// What a section has an entry for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Per {
    /// Each segment of the skeleton.
    Segment,
    /// Each joint.
    Joint,
    /// Each ergonomic angle.
    ErgonomicAngle,
    /// Each motion tracker.
    Sensor,
    /// The body as a whole: one entry.
    Body,
}

impl Section {
    /// Every section, in the order of the variants.
    pub const ALL: &[Self] = &[
        Self::Position,
        Self::Orientation,
        Self::Velocity,
        Self::Acceleration,
        Self::AngularVelocity,
        Self::AngularAcceleration,
        Self::JointAngles,
        Self::JointAnglesXzy,
        Self::ErgonomicAngles,
        Self::ErgonomicAnglesXzy,
        Self::SensorOrientation,
        Self::SensorFreeAcceleration,
        Self::SensorAcceleration,
        Self::SensorAngularVelocity,
        Self::SensorMagneticField,
        Self::CenterOfMass,
        Self::CenterOfMassVelocity,
        Self::CenterOfMassAcceleration,
    ];

    /// Its name in snake case, which [`FromStr`] reads: `angular_velocity`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Orientation => "orientation",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::AngularVelocity => "angular_velocity",
            Self::AngularAcceleration => "angular_acceleration",
            Self::JointAngles => "joint_angles",
            Self::JointAnglesXzy => "joint_angles_xzy",
            Self::ErgonomicAngles => "ergonomic_angles",
            Self::ErgonomicAnglesXzy => "ergonomic_angles_xzy",
            Self::SensorOrientation => "sensor_orientation",
            Self::SensorFreeAcceleration => "sensor_free_acceleration",
            Self::SensorAcceleration => "sensor_acceleration",
            Self::SensorAngularVelocity => "sensor_angular_velocity",
            Self::SensorMagneticField => "sensor_magnetic_field",
            Self::CenterOfMass => "center_of_mass",
            Self::CenterOfMassVelocity => "center_of_mass_velocity",
            Self::CenterOfMassAcceleration => "center_of_mass_acceleration",
        }
    }

    /// What it has an entry for.
    pub const fn per(self) -> Per {
        match self {
            Self::Position
            | Self::Orientation
            | Self::Velocity
            | Self::Acceleration
            | Self::AngularVelocity
            | Self::AngularAcceleration => Per::Segment,
            Self::JointAngles | Self::JointAnglesXzy => Per::Joint,
            Self::ErgonomicAngles | Self::ErgonomicAnglesXzy => Per::ErgonomicAngle,
            Self::SensorOrientation
            | Self::SensorFreeAcceleration
            | Self::SensorAcceleration
            | Self::SensorAngularVelocity
            | Self::SensorMagneticField => Per::Sensor,
            Self::CenterOfMass | Self::CenterOfMassVelocity | Self::CenterOfMassAcceleration => Per::Body,
        }
    }

    /// The names of the numbers of an entry: x, y, z of a vector, or w, x, y, z of a quaternion.
    pub const fn axes(self) -> &'static [&'static str] {
        match self {
            Self::Orientation | Self::SensorOrientation => &["w", "x", "y", "z"],
            _ => &["x", "y", "z"],
        }
    }

    /// How many numbers an entry has: 3, or 4 of a quaternion.
    pub const fn components(self) -> usize {
        self.axes().len()
    }

    /// The unit of its numbers as text: `m/s2`; empty where they have none.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Position | Self::CenterOfMass => "m",
            Self::Velocity | Self::CenterOfMassVelocity => "m/s",
            Self::Acceleration
            | Self::SensorFreeAcceleration
            | Self::SensorAcceleration
            | Self::CenterOfMassAcceleration => "m/s2",
            Self::AngularVelocity | Self::SensorAngularVelocity => "rad/s",
            Self::AngularAcceleration => "rad/s2",
            Self::JointAngles | Self::JointAnglesXzy | Self::ErgonomicAngles | Self::ErgonomicAnglesXzy => "rad",
            Self::Orientation | Self::SensorOrientation | Self::SensorMagneticField => "",
        }
    }

    /// How many entries it has for a skeleton.
    pub fn entries(self, skeleton: &Skeleton) -> usize {
        match self.per() {
            Per::Segment => skeleton.segments.len(),
            Per::Joint => skeleton.joints.len(),
            Per::ErgonomicAngle => skeleton.ergonomic_angles.len(),
            Per::Sensor => skeleton.sensors.len(),
            Per::Body => 1,
        }
    }

    /// The names of its entries: of segments, joints or angles; of a sensor the segment that wears it; `CoM` for the
    /// centre of mass.
    pub fn labels(self, skeleton: &Skeleton) -> impl ExactSizeIterator<Item = &str> {
        (0..self.entries(skeleton)).map(move |entry| match self.per() {
            Per::Segment => skeleton.segments[entry].name.as_str(),
            Per::Joint => skeleton.joints[entry].name.as_str(),
            Per::ErgonomicAngle => skeleton.ergonomic_angles[entry].name.as_str(),
            Per::Sensor => {
                let segment = skeleton.segments.get(skeleton.sensors[entry]);
                segment.map_or("", |segment| segment.name.as_str())
            }
            Per::Body => "CoM",
        })
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Section {
    type Err = Error;

    /// Reads the [`name`](Section::name).
    fn from_str(text: &str) -> Result<Self, Error> {
        let section = Self::ALL.iter().copied().find(|section| section.name() == text);
        section.ok_or_else(|| Error::Section { found: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_section_is_listed_at_its_own_place_and_reads_its_name() {
        for (place, &section) in Section::ALL.iter().enumerate() {
            assert_eq!(section as usize, place);
            assert_eq!(section.to_string().parse(), Ok(section));
        }
        let found = "Position".to_owned();
        assert_eq!("Position".parse::<Section>(), Err(Error::Section { found }));
    }

    #[test]
    fn entries_and_labels_are_those_of_the_skeleton() {
        let mut skeleton = Skeleton::standard(0, false);
        skeleton.sensors = vec![0, 6, 99];
        for &section in Section::ALL {
            assert_eq!(section.labels(&skeleton).len(), section.entries(&skeleton));
        }
        assert_eq!(Section::Orientation.labels(&skeleton).nth(6), Some("Head"));
        let sensors: Vec<_> = Section::SensorAcceleration.labels(&skeleton).collect();
        assert_eq!(sensors, ["Pelvis", "Head", ""]);
        assert_eq!(Section::CenterOfMass.labels(&skeleton).next(), Some("CoM"));
        assert_eq!(Section::SensorOrientation.components(), 4);
    }
}
