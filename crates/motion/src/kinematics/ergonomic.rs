//! All six ergonomic angles for a source that gives fewer.

use super::ergonomic_angles;
use crate::rotation::Sequence;
use crate::{DVec3, Frame, Skeleton, Subject};
use std::sync::Arc;

/// Gives frames the six ergonomic angles of MXTP type 20, of which MVNX files hold four or none.
///
/// The angles that a frame has keep their values, the others are worked out from its orientations.
#[derive(Clone, Debug)]
pub struct AllErgonomicAngles {
    subject: Arc<Subject>,
    /// Where each of the six stands in the frames that come in.
    places: Vec<Option<usize>>,
    computed: Vec<Option<DVec3>>,
}

impl AllErgonomicAngles {
    /// For frames of a subject. One without MVN's body, or that has all six already, stays as it is.
    pub fn of(subject: &Arc<Subject>) -> Self {
        let standard = Skeleton::standard(0, false);
        let (all, given) = (standard.ergonomic_angles, &subject.skeleton.ergonomic_angles);
        let body = subject.skeleton.segments.iter().zip(&standard.segments);
        let is_body = subject.skeleton.segments.len() >= standard.segments.len();
        let is_body = is_body
            && body
                .into_iter()
                .all(|(segment, standard)| segment.name == standard.name);
        if !is_body || given.len() >= all.len() {
            return Self {
                subject: Arc::clone(subject),
                places: Vec::new(),
                computed: Vec::new(),
            };
        }
        let place = |name: &str| given.iter().position(|angle| angle.name == name);
        let places = all.iter().map(|angle| place(&angle.name)).collect();
        let mut described = Subject::clone(subject);
        described.skeleton.ergonomic_angles = all;
        Self {
            subject: Arc::new(described),
            places,
            computed: Vec::new(),
        }
    }

    /// The subject of the frames that come out.
    pub fn subject(&self) -> &Arc<Subject> {
        &self.subject
    }

    /// Completes one frame of the subject.
    pub fn complete(&mut self, frame: &mut Frame) {
        frame.subject = Arc::clone(&self.subject);
        if self.places.is_empty() || frame.orientation.is_empty() {
            return;
        }
        for sequence in [Sequence::Zxy, Sequence::Xzy] {
            ergonomic_angles(
                &frame.subject.skeleton,
                &frame.orientation,
                sequence,
                &mut self.computed,
            );
            let section = match sequence {
                Sequence::Xzy => &mut frame.ergonomic_angles_xzy,
                _ => &mut frame.ergonomic_angles,
            };
            let given = std::mem::take(section);
            let given = |place: &Option<usize>| place.and_then(|place| given.get(place).copied().flatten());
            section.extend(
                self.places
                    .iter()
                    .zip(&self.computed)
                    .map(|(place, computed)| given(place).or(*computed)),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DQuat;

    #[test]
    fn the_angles_of_the_file_keep_their_values_and_places() {
        let mut subject = Subject::new("Ada", Skeleton::standard(0, false));
        subject.skeleton.ergonomic_angles.swap(0, 3);
        subject.skeleton.ergonomic_angles.truncate(4);
        let subject = Arc::new(subject);
        let mut frame = Frame::new(Arc::clone(&subject));
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame.ergonomic_angles = (1..=4).map(|value| Some(DVec3::splat(f64::from(value)))).collect();

        let mut all = AllErgonomicAngles::of(&subject);
        all.complete(&mut frame);
        assert_eq!(frame.check(), Ok(()));
        let x: Vec<_> = frame
            .ergonomic_angles
            .iter()
            .map(|angle| angle.unwrap().x.round() as i64)
            .collect();
        assert_eq!(x, [4, 2, 3, 1, 0, 0]);
        assert_eq!(frame.ergonomic_angles_xzy.len(), 6);
    }

    #[test]
    fn a_subject_without_a_body_stays_as_it_is() {
        let subject = Arc::new(Subject::new("Box", Skeleton::default()));
        assert!(Arc::ptr_eq(AllErgonomicAngles::of(&subject).subject(), &subject));
    }
}
