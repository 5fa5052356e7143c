//! From arrays of numpy to a frame.

use crate::error::usage;
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2};
use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Section};
use pyo3::prelude::*;

/// Gives a frame the numbers of a section.
pub(super) fn set(frame: &mut Frame, section: Section, numbers: &Bound<'_, PyAny>) -> PyResult<()> {
    let components = section.components();
    let entries = section.entries(&frame.subject.skeleton);
    let rows = rows(section, entries, components, numbers)?;
    let vectors = || rows.iter().map(|row| vector(row)).collect::<Vec<_>>();
    let quaternions = || rows.iter().map(|row| quaternion(row)).collect::<Vec<_>>();
    match section {
        Section::Position => frame.position = vectors(),
        Section::Orientation => frame.orientation = quaternions(),
        Section::Velocity => frame.velocity = vectors(),
        Section::Acceleration => frame.acceleration = vectors(),
        Section::AngularVelocity => frame.angular_velocity = vectors(),
        Section::AngularAcceleration => frame.angular_acceleration = vectors(),
        Section::JointAngles => frame.joint_angles = vectors(),
        Section::JointAnglesXzy => frame.joint_angles_xzy = vectors(),
        Section::ErgonomicAngles => frame.ergonomic_angles = vectors(),
        Section::ErgonomicAnglesXzy => frame.ergonomic_angles_xzy = vectors(),
        Section::SensorOrientation => frame.sensor_orientation = quaternions(),
        Section::SensorFreeAcceleration => frame.sensor_free_acceleration = vectors(),
        Section::SensorAcceleration => frame.sensor_acceleration = vectors(),
        Section::SensorAngularVelocity => frame.sensor_angular_velocity = vectors(),
        Section::SensorMagneticField => frame.sensor_magnetic_field = vectors(),
        section => set_center_of_mass(frame, section, rows.first().and_then(|row| vector(row)))?,
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
    let Some(whole) = &mut frame.center_of_mass else {
        let help = "give center_of_mass= before it";
        return Err(usage(
            format!("{section} needs the position of the centre of mass"),
            help,
        ));
    };
    match section {
        Section::CenterOfMassVelocity => whole.velocity = value,
        _ => whole.acceleration = value,
    }
    Ok(())
}

/// The numbers of each entry. Anything that numpy makes an array of will do.
fn rows(section: Section, entries: usize, components: usize, numbers: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<f64>>> {
    if entries == 1
        && let Ok(row) = numbers.extract::<PyArrayLike1<'_, f64, AllowTypeChange>>()
        && row.as_array().len() == components
    {
        return Ok(vec![row.as_array().to_vec()]);
    }
    let rows = numbers.extract::<PyArrayLike2<'_, f64, AllowTypeChange>>();
    let wrong = |found: String| {
        usage(
            format!("expected an array of ({entries}, {components}) as {section}, found {found}"),
            "streamer.skeleton says which entries there are",
        )
    };
    let rows = rows.map_err(|_| wrong(shape(numbers)))?;
    let array = rows.as_array();
    if array.dim() != (entries, components) {
        return Err(wrong(shape(numbers)));
    }
    Ok(array.outer_iter().map(|row| row.to_vec()).collect())
}

fn shape(numbers: &Bound<'_, PyAny>) -> String {
    let kind = || numbers.get_type().name().map(|name| name.to_string());
    let shape = numbers.getattr("shape").map(|shape| format!("one of {shape}"));
    shape.or_else(|_| kind()).unwrap_or_default()
}

fn vector(row: &[f64]) -> Option<DVec3> {
    let vector = DVec3::from_array(row.try_into().ok()?);
    (!vector.is_nan()).then_some(vector)
}

fn quaternion(row: &[f64]) -> Option<DQuat> {
    let [w, x, y, z] = row.try_into().ok()?;
    let turn = DQuat::from_xyzw(x, y, z, w);
    (!turn.is_nan()).then_some(turn)
}
