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
    let numbers = match List::of(frame, section) {
        List::Vectors(list) => vectors(list),
        List::Rotations(list) => rotations(list),
        List::Body(vector) => vector.map(|vector| vector.to_array().to_vec()).unwrap_or_default(),
    };
    (!numbers.is_empty()).then_some(numbers)
}

/// The entries of a section, as a frame has them.
pub(crate) enum List<'a> {
    Vectors(&'a [Option<DVec3>]),
    Rotations(&'a [Option<DQuat>]),
    /// The one vector of the body as a whole.
    Body(Option<DVec3>),
}

impl<'a> List<'a> {
    pub(crate) fn of(frame: &'a Frame, section: Section) -> Self {
        let whole = frame.center_of_mass.as_ref();
        match section {
            Section::Position => Self::Vectors(&frame.position),
            Section::Orientation => Self::Rotations(&frame.orientation),
            Section::Velocity => Self::Vectors(&frame.velocity),
            Section::Acceleration => Self::Vectors(&frame.acceleration),
            Section::AngularVelocity => Self::Vectors(&frame.angular_velocity),
            Section::AngularAcceleration => Self::Vectors(&frame.angular_acceleration),
            Section::JointAngles => Self::Vectors(&frame.joint_angles),
            Section::JointAnglesXzy => Self::Vectors(&frame.joint_angles_xzy),
            Section::ErgonomicAngles => Self::Vectors(&frame.ergonomic_angles),
            Section::ErgonomicAnglesXzy => Self::Vectors(&frame.ergonomic_angles_xzy),
            Section::SensorOrientation => Self::Rotations(&frame.sensor_orientation),
            Section::SensorFreeAcceleration => Self::Vectors(&frame.sensor_free_acceleration),
            Section::SensorAcceleration => Self::Vectors(&frame.sensor_acceleration),
            Section::SensorAngularVelocity => Self::Vectors(&frame.sensor_angular_velocity),
            Section::SensorMagneticField => Self::Vectors(&frame.sensor_magnetic_field),
            Section::CenterOfMass => Self::Body(whole.map(|whole| whole.position)),
            Section::CenterOfMassVelocity => Self::Body(whole.and_then(|whole| whole.velocity)),
            Section::CenterOfMassAcceleration => Self::Body(whole.and_then(|whole| whole.acceleration)),
            _ => Self::Body(None),
        }
    }

    /// How many entries there are; of the body one, or none where it is not known.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Vectors(list) => list.len(),
            Self::Rotations(list) => list.len(),
            Self::Body(vector) => usize::from(vector.is_some()),
        }
    }

    /// Whether the entry at a place is tracked.
    pub(crate) fn is_known(&self, place: usize) -> bool {
        match self {
            Self::Vectors(list) => list.get(place).is_some_and(Option::is_some),
            Self::Rotations(list) => list.get(place).is_some_and(Option::is_some),
            Self::Body(vector) => vector.is_some(),
        }
    }
}

fn vectors(list: &[Option<DVec3>]) -> Vec<f64> {
    let lost = [f64::NAN; 3];
    list.iter()
        .flat_map(|entry| entry.map_or(lost, |v| v.to_array()))
        .collect()
}

fn rotations(list: &[Option<DQuat>]) -> Vec<f64> {
    let lost = [f64::NAN; 4];
    list.iter()
        .flat_map(|entry| entry.map_or(lost, |q| [q.w, q.x, q.y, q.z]))
        .collect()
}
