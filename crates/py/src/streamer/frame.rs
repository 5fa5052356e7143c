//! From arrays of numpy to a frame.

use super::numbers::{quaternions, vectors};
use crate::error::usage;
use posewire_motion::{CenterOfMass, DVec3, Frame, Section};
use pyo3::prelude::*;

/// Gives a frame the numbers of a section.
pub(super) fn set(frame: &mut Frame, section: Section, numbers: &Bound<'_, PyAny>) -> PyResult<()> {
    let subject = frame.subject.clone();
    if matches!(section, Section::Orientation | Section::SensorOrientation) {
        let rotations = quaternions(&subject.skeleton, section, numbers)?;
        match section {
            Section::Orientation => frame.orientation = rotations,
            _ => frame.sensor_orientation = rotations,
        }
        return Ok(());
    }
    let vectors = vectors(&subject.skeleton, section, numbers)?;
    match section {
        Section::Position => frame.position = vectors,
        Section::Velocity => frame.velocity = vectors,
        Section::Acceleration => frame.acceleration = vectors,
        Section::AngularVelocity => frame.angular_velocity = vectors,
        Section::AngularAcceleration => frame.angular_acceleration = vectors,
        Section::JointAngles => frame.joint_angles = vectors,
        Section::JointAnglesXzy => frame.joint_angles_xzy = vectors,
        Section::ErgonomicAngles => frame.ergonomic_angles = vectors,
        Section::ErgonomicAnglesXzy => frame.ergonomic_angles_xzy = vectors,
        Section::SensorFreeAcceleration => frame.sensor_free_acceleration = vectors,
        Section::SensorAcceleration => frame.sensor_acceleration = vectors,
        Section::SensorAngularVelocity => frame.sensor_angular_velocity = vectors,
        Section::SensorMagneticField => frame.sensor_magnetic_field = vectors,
        section => set_center_of_mass(frame, section, vectors.first().copied().flatten())?,
    }
    Ok(())
}

/// Velocity and acceleration follow the position, which is what makes a centre of mass.
fn set_center_of_mass(frame: &mut Frame, section: Section, value: Option<DVec3>) -> PyResult<()> {
    if section == Section::CenterOfMass {
        frame.center_of_mass = value.map(|position| CenterOfMass {
            position,
            velocity: None,
            acceleration: None,
        });
        return Ok(());
    }
    match (&mut frame.center_of_mass, section) {
        (Some(whole), Section::CenterOfMassVelocity) => whole.velocity = value,
        (Some(whole), _) => whole.acceleration = value,
        (None, _) if value.is_none() => {}
        (None, _) => {
            return Err(usage(
                format!("expected the position of the centre of mass beside {section}, found none"),
                "give center_of_mass= as well",
            ));
        }
    }
    Ok(())
}
