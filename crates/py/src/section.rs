//! The kinds of numbers, by the names that Python has for them.

use crate::error::{exception, usage};
use posewire_motion::Section;
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
