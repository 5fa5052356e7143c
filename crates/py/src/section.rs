//! The kinds of numbers, by the names that Python has for them.

use crate::error::{exception, usage};
use posewire_motion::{DQuat, DVec3, Frame, Section};
use pyo3::PyResult;

/// The sequence of rotations by which joint angles are told.
pub(crate) fn joint_angles(sequence: &str) -> PyResult<Section> {
    of_sequence(sequence, Section::JointAngles, Section::JointAnglesXzy)
}

/// The same of ergonomic angles.
pub(crate) fn ergonomic_angles(sequence: &str) -> PyResult<Section> {
    of_sequence(sequence, Section::ErgonomicAngles, Section::ErgonomicAnglesXzy)
}

fn of_sequence(sequence: &str, zxy: Section, xzy: Section) -> PyResult<Section> {
    match sequence {
        "zxy" => Ok(zxy),
        "xzy" => Ok(xzy),
        found => Err(usage(
            format!("expected the sequence \"zxy\" or \"xzy\", found {found:?}"),
            "MVN's own joint angles are \"zxy\"; \"xzy\" is meant for shoulders",
        )),
    }
}

/// The sections of these names.
pub(crate) fn named(names: &[String]) -> PyResult<Vec<Section>> {
    let section = |name: &String| name.parse().map_err(|_| unknown(name));
    names.iter().map(section).collect()
}

fn unknown(name: &str) -> pyo3::PyErr {
    let all: Vec<_> = Section::ALL.iter().map(|section| section.name()).collect();
    usage(
        format!("there is no section {name:?}"),
        format!("the sections are {}", all.join(", ")),
    )
}

/// What is raised for a section that is not there.
pub(crate) fn missing(whose: &str, section: Section, there: impl Iterator<Item = Section>, help: &str) -> pyo3::PyErr {
    let there: Vec<_> = there.map(Section::name).collect();
    let has = if there.is_empty() {
        "nothing".to_owned()
    } else {
        there.join(", ")
    };
    exception(
        "MissingError",
        format!("{whose} has no {section}: it has {has}"),
        Some(help.to_owned()),
    )
}

/// The sections that a frame has.
pub(crate) fn of_frame(frame: &Frame) -> impl Iterator<Item = Section> {
    let has = |section: &Section| values(frame, *section).is_some();
    Section::ALL.iter().copied().filter(has)
}

/// The numbers of a section of a frame, those of an entry side by side, NaN where it is not tracked; `None` where the frame
/// lacks the section.
pub(crate) fn values(frame: &Frame, section: Section) -> Option<Vec<f64>> {
    let whole = frame.center_of_mass.as_ref();
    match section {
        Section::Position => vectors(&frame.position),
        Section::Orientation => quaternions(&frame.orientation),
        Section::Velocity => vectors(&frame.velocity),
        Section::Acceleration => vectors(&frame.acceleration),
        Section::AngularVelocity => vectors(&frame.angular_velocity),
        Section::AngularAcceleration => vectors(&frame.angular_acceleration),
        Section::JointAngles => vectors(&frame.joint_angles),
        Section::JointAnglesXzy => vectors(&frame.joint_angles_xzy),
        Section::ErgonomicAngles => vectors(&frame.ergonomic_angles),
        Section::ErgonomicAnglesXzy => vectors(&frame.ergonomic_angles_xzy),
        Section::SensorOrientation => quaternions(&frame.sensor_orientation),
        Section::SensorFreeAcceleration => vectors(&frame.sensor_free_acceleration),
        Section::SensorAcceleration => vectors(&frame.sensor_acceleration),
        Section::SensorAngularVelocity => vectors(&frame.sensor_angular_velocity),
        Section::SensorMagneticField => vectors(&frame.sensor_magnetic_field),
        Section::CenterOfMass => whole.map(|whole| whole.position.to_array().to_vec()),
        Section::CenterOfMassVelocity => whole.and_then(|whole| whole.velocity).map(|v| v.to_array().to_vec()),
        Section::CenterOfMassAcceleration => whole
            .and_then(|whole| whole.acceleration)
            .map(|a| a.to_array().to_vec()),
        _ => None,
    }
}

fn vectors(list: &[Option<DVec3>]) -> Option<Vec<f64>> {
    let lost = [f64::NAN; 3];
    let numbers = list.iter().flat_map(|entry| entry.map_or(lost, |v| v.to_array()));
    (!list.is_empty()).then(|| numbers.collect())
}

fn quaternions(list: &[Option<DQuat>]) -> Option<Vec<f64>> {
    let lost = [f64::NAN; 4];
    let numbers = list
        .iter()
        .flat_map(|entry| entry.map_or(lost, |q| [q.w, q.x, q.y, q.z]));
    (!list.is_empty()).then(|| numbers.collect())
}
