//! The lists of a frame as rows of numbers, and back.

use crate::column::{quaternion, vector};
use crate::{CenterOfMass, Frame, Section};
use glam::{DQuat, DVec3};
use std::slice;

/// What a frame has of one section.
pub(super) enum List<'a> {
    Vectors(&'a [Option<DVec3>]),
    Quaternions(&'a [Option<DQuat>]),
    /// A vector of the body as a whole.
    Vector(Option<DVec3>),
}

impl<'a> List<'a> {
    /// The section's list of a frame.
    pub(super) fn of(frame: &'a Frame, section: Section) -> Self {
        let center = frame.center_of_mass.as_ref();
        match section {
            Section::Position => Self::Vectors(&frame.position),
            Section::Orientation => Self::Quaternions(&frame.orientation),
            Section::Velocity => Self::Vectors(&frame.velocity),
            Section::Acceleration => Self::Vectors(&frame.acceleration),
            Section::AngularVelocity => Self::Vectors(&frame.angular_velocity),
            Section::AngularAcceleration => Self::Vectors(&frame.angular_acceleration),
            Section::JointAngles => Self::Vectors(&frame.joint_angles),
            Section::JointAnglesXzy => Self::Vectors(&frame.joint_angles_xzy),
            Section::ErgonomicAngles => Self::Vectors(&frame.ergonomic_angles),
            Section::ErgonomicAnglesXzy => Self::Vectors(&frame.ergonomic_angles_xzy),
            Section::SensorOrientation => Self::Quaternions(&frame.sensor_orientation),
            Section::SensorFreeAcceleration => Self::Vectors(&frame.sensor_free_acceleration),
            Section::SensorAcceleration => Self::Vectors(&frame.sensor_acceleration),
            Section::SensorAngularVelocity => Self::Vectors(&frame.sensor_angular_velocity),
            Section::SensorMagneticField => Self::Vectors(&frame.sensor_magnetic_field),
            Section::CenterOfMass => Self::Vector(center.map(|center| center.position)),
            Section::CenterOfMassVelocity => Self::Vector(center.and_then(|center| center.velocity)),
            Section::CenterOfMassAcceleration => Self::Vector(center.and_then(|center| center.acceleration)),
        }
    }

    /// How many entries there are; none when the frame lacks the section.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Vectors(list) => list.len(),
            Self::Quaternions(list) => list.len(),
            Self::Vector(vector) => usize::from(vector.is_some()),
        }
    }

    /// Adds the entries' numbers to a column.
    pub(super) fn write(&self, to: &mut Vec<f64>) {
        match self {
            Self::Vectors(list) => write_vectors(list, to),
            Self::Quaternions(list) => write_quaternions(list, to),
            Self::Vector(vector) => write_vectors(slice::from_ref(vector), to),
        }
    }
}

fn write_vectors(list: &[Option<DVec3>], to: &mut Vec<f64>) {
    to.reserve(list.len() * 3);
    for vector in list {
        to.extend_from_slice(&vector.map_or([f64::NAN; 3], |vector| vector.to_array()));
    }
}

fn write_quaternions(list: &[Option<DQuat>], to: &mut Vec<f64>) {
    to.reserve(list.len() * 4);
    for quaternion in list {
        to.extend_from_slice(&quaternion.map_or([f64::NAN; 4], |q| [q.w, q.x, q.y, q.z]));
    }
}

/// Gives a frame that lacks the section the entries of a row.
pub(super) fn read_row(section: Section, row: &[f64], frame: &mut Frame) {
    let vectors = match section {
        Section::Position => &mut frame.position,
        Section::Velocity => &mut frame.velocity,
        Section::Acceleration => &mut frame.acceleration,
        Section::AngularVelocity => &mut frame.angular_velocity,
        Section::AngularAcceleration => &mut frame.angular_acceleration,
        Section::JointAngles => &mut frame.joint_angles,
        Section::JointAnglesXzy => &mut frame.joint_angles_xzy,
        Section::ErgonomicAngles => &mut frame.ergonomic_angles,
        Section::ErgonomicAnglesXzy => &mut frame.ergonomic_angles_xzy,
        Section::SensorFreeAcceleration => &mut frame.sensor_free_acceleration,
        Section::SensorAcceleration => &mut frame.sensor_acceleration,
        Section::SensorAngularVelocity => &mut frame.sensor_angular_velocity,
        Section::SensorMagneticField => &mut frame.sensor_magnetic_field,
        Section::Orientation => return read_quaternions(row, &mut frame.orientation),
        Section::SensorOrientation => return read_quaternions(row, &mut frame.sensor_orientation),
        Section::CenterOfMass | Section::CenterOfMassVelocity | Section::CenterOfMassAcceleration => {
            return read_center(section, row, &mut frame.center_of_mass);
        }
    };
    vectors.extend(row.chunks_exact(3).map(vector));
}

fn read_quaternions(row: &[f64], to: &mut Vec<Option<DQuat>>) {
    to.extend(row.chunks_exact(4).map(quaternion));
}

/// A centre of mass whose position is not known has no velocity either.
fn read_center(section: Section, row: &[f64], to: &mut Option<CenterOfMass>) {
    let vector = vector(row);
    match (section, vector, to) {
        (Section::CenterOfMass, Some(position), to) => {
            *to = Some(CenterOfMass {
                position,
                velocity: None,
                acceleration: None,
            });
        }
        (Section::CenterOfMassVelocity, velocity, Some(center)) => center.velocity = velocity,
        (Section::CenterOfMassAcceleration, acceleration, Some(center)) => center.acceleration = acceleration,
        _ => {}
    }
}
