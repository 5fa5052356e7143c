//! Rows of numbers as the lists of a frame.

use crate::column::{quaternion, vector};
use crate::{CenterOfMass, Frame, Section};
use glam::DQuat;

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
