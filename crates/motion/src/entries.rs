//! The sections of a frame as numbers, and back.

use crate::column::{quaternion, vector};
use crate::{CenterOfMass, Frame, Section};
use glam::{DQuat, DVec3};
use std::slice;

/// The entries of one [`Section`] of a frame, as [`Frame::entries`] gives them: none where the frame lacks the section.
///
/// ```
/// use posewire_motion::{DVec3, Frame, Section, Skeleton, Subject};
/// use std::sync::Arc;
///
/// let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// assert!(frame.entries(Section::Position).is_empty());
/// frame.position = vec![None; 23];
/// frame.position[6] = Some(DVec3::Z);
/// let position = frame.entries(Section::Position);
/// assert_eq!((position.len(), position.vector(6), position.vector(0)), (23, Some(DVec3::Z), None));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Entries<'a>(List<'a>);

#[derive(Clone, Copy, Debug)]
enum List<'a> {
    Vectors(&'a [Option<DVec3>]),
    Quaternions(&'a [Option<DQuat>]),
    /// A vector of the body as a whole; there is no entry where it is not known.
    Vector(Option<DVec3>),
}

impl Frame {
    /// What the frame has of a section.
    pub fn entries(&self, section: Section) -> Entries<'_> {
        let center = self.center_of_mass.as_ref();
        Entries(match section {
            Section::Position => List::Vectors(&self.position),
            Section::Orientation => List::Quaternions(&self.orientation),
            Section::Velocity => List::Vectors(&self.velocity),
            Section::Acceleration => List::Vectors(&self.acceleration),
            Section::AngularVelocity => List::Vectors(&self.angular_velocity),
            Section::AngularAcceleration => List::Vectors(&self.angular_acceleration),
            Section::JointAngles => List::Vectors(&self.joint_angles),
            Section::JointAnglesXzy => List::Vectors(&self.joint_angles_xzy),
            Section::ErgonomicAngles => List::Vectors(&self.ergonomic_angles),
            Section::ErgonomicAnglesXzy => List::Vectors(&self.ergonomic_angles_xzy),
            Section::SensorOrientation => List::Quaternions(&self.sensor_orientation),
            Section::SensorFreeAcceleration => List::Vectors(&self.sensor_free_acceleration),
            Section::SensorAcceleration => List::Vectors(&self.sensor_acceleration),
            Section::SensorAngularVelocity => List::Vectors(&self.sensor_angular_velocity),
            Section::SensorMagneticField => List::Vectors(&self.sensor_magnetic_field),
            Section::CenterOfMass => List::Vector(center.map(|center| center.position)),
            Section::CenterOfMassVelocity => List::Vector(center.and_then(|center| center.velocity)),
            Section::CenterOfMassAcceleration => List::Vector(center.and_then(|center| center.acceleration)),
        })
    }

    /// The sections that the frame has, in the order of [`Section::ALL`].
    pub fn sections(&self) -> impl Iterator<Item = Section> {
        let sections = Section::ALL.iter().copied();
        sections.filter(|section| !self.entries(*section).is_empty())
    }

    /// Gives the frame the entries of a section, in place of those that it has: their numbers as [`Entries::numbers`] has them, and
    /// none to take the section from it. An entry of which every number is NaN is not tracked.
    ///
    /// Without the position of the centre of mass its velocity and acceleration have no place and are left out.
    pub fn set_entries(&mut self, section: Section, numbers: &[f64]) {
        let vectors = match section {
            Section::Position => &mut self.position,
            Section::Velocity => &mut self.velocity,
            Section::Acceleration => &mut self.acceleration,
            Section::AngularVelocity => &mut self.angular_velocity,
            Section::AngularAcceleration => &mut self.angular_acceleration,
            Section::JointAngles => &mut self.joint_angles,
            Section::JointAnglesXzy => &mut self.joint_angles_xzy,
            Section::ErgonomicAngles => &mut self.ergonomic_angles,
            Section::ErgonomicAnglesXzy => &mut self.ergonomic_angles_xzy,
            Section::SensorFreeAcceleration => &mut self.sensor_free_acceleration,
            Section::SensorAcceleration => &mut self.sensor_acceleration,
            Section::SensorAngularVelocity => &mut self.sensor_angular_velocity,
            Section::SensorMagneticField => &mut self.sensor_magnetic_field,
            Section::Orientation => return set_quaternions(&mut self.orientation, numbers),
            Section::SensorOrientation => return set_quaternions(&mut self.sensor_orientation, numbers),
            Section::CenterOfMass | Section::CenterOfMassVelocity | Section::CenterOfMassAcceleration => {
                return set_center(&mut self.center_of_mass, section, vector(numbers));
            }
        };
        vectors.clear();
        vectors.extend(numbers.chunks_exact(3).map(vector));
    }
}

fn set_quaternions(list: &mut Vec<Option<DQuat>>, numbers: &[f64]) {
    list.clear();
    list.extend(numbers.chunks_exact(4).map(quaternion));
}

fn set_center(center: &mut Option<CenterOfMass>, section: Section, vector: Option<DVec3>) {
    match (section, center) {
        (Section::CenterOfMassVelocity, Some(center)) => center.velocity = vector,
        (Section::CenterOfMassAcceleration, Some(center)) => center.acceleration = vector,
        (Section::CenterOfMass, center) => {
            *center = vector.map(|position| CenterOfMass {
                position,
                velocity: None,
                acceleration: None,
            });
        }
        _ => {}
    }
}

impl Entries<'_> {
    /// How many there are, tracked or not.
    pub fn len(&self) -> usize {
        match self.0 {
            List::Vectors(list) => list.len(),
            List::Quaternions(list) => list.len(),
            List::Vector(vector) => usize::from(vector.is_some()),
        }
    }

    /// Whether the frame lacks the section.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The vector of an entry; `None` when it is not tracked or not there, and of quaternions.
    pub fn vector(&self, entry: usize) -> Option<DVec3> {
        match self.0 {
            List::Vectors(list) => list.get(entry).copied().flatten(),
            List::Vector(vector) => vector.filter(|_| entry == 0),
            List::Quaternions(_) => None,
        }
    }

    /// The quaternion of an entry; `None` when it is not tracked or not there, and of vectors.
    pub fn quaternion(&self, entry: usize) -> Option<DQuat> {
        match self.0 {
            List::Quaternions(list) => list.get(entry).copied().flatten(),
            List::Vectors(_) | List::Vector(_) => None,
        }
    }

    /// Whether an entry is there and tracked.
    pub fn is_tracked(&self, entry: usize) -> bool {
        self.vector(entry).is_some() || self.quaternion(entry).is_some()
    }

    /// Their numbers, those of an entry side by side as [`Section::axes`] names them, NaN where it is not tracked.
    pub fn numbers(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        self.write(&mut numbers);
        numbers
    }

    /// Adds their numbers to a column.
    pub(crate) fn write(&self, to: &mut Vec<f64>) {
        match &self.0 {
            List::Vectors(list) => write_vectors(list, to),
            List::Quaternions(list) => write_quaternions(list, to),
            List::Vector(None) => {}
            List::Vector(vector) => write_vectors(slice::from_ref(vector), to),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Skeleton, Subject};
    use std::sync::Arc;

    fn frame() -> Frame {
        Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))))
    }

    #[test]
    fn what_is_not_tracked_is_an_entry_of_nan() {
        let mut frame = frame();
        frame.orientation = vec![Some(DQuat::from_xyzw(0.0, 0.0, 0.6, 0.8)), None];
        let entries = frame.entries(Section::Orientation);
        assert_eq!(
            (entries.len(), entries.is_tracked(0), entries.is_tracked(1)),
            (2, true, false)
        );
        assert_eq!(entries.numbers()[..4], [0.8, 0.0, 0.0, 0.6]);
        assert!(entries.numbers()[4..].iter().all(|number| number.is_nan()) && entries.numbers().len() == 8);
        assert_eq!((entries.vector(0), entries.quaternion(2)), (None, None));
    }

    #[test]
    fn what_is_read_is_what_was_set() {
        let mut frame = frame();
        for &section in Section::ALL {
            let numbers = [0.8, 0.0, 0.6, 0.0][..section.components()].to_vec();
            frame.set_entries(section, &numbers);
            assert_eq!(frame.entries(section).numbers(), numbers, "{section}");
        }
        assert_eq!(frame.sections().collect::<Vec<_>>(), Section::ALL);
        for section in [Section::Position, Section::Orientation, Section::CenterOfMass] {
            frame.set_entries(section, &[]);
            assert!(frame.entries(section).is_empty(), "{section}");
        }
        frame.set_entries(Section::CenterOfMassVelocity, &[1.0; 3]);
        assert_eq!(frame.center_of_mass, None);
    }

    #[test]
    fn a_body_has_one_entry_or_none() {
        let mut frame = frame();
        frame.center_of_mass = Some(CenterOfMass {
            position: DVec3::X,
            velocity: None,
            acceleration: Some(DVec3::Y),
        });
        assert_eq!(frame.entries(Section::CenterOfMass).vector(0), Some(DVec3::X));
        assert_eq!(
            frame.entries(Section::CenterOfMassAcceleration).numbers(),
            [0.0, 1.0, 0.0]
        );
        assert!(frame.entries(Section::CenterOfMassVelocity).numbers().is_empty());
        let sections: Vec<_> = frame.sections().collect();
        assert_eq!(sections, [Section::CenterOfMass, Section::CenterOfMassAcceleration]);
    }
}
