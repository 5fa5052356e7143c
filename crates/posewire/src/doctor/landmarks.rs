//! Where the parts of a body are that tell its size and its axes.

use posewire_motion::{DVec3, Frame, Subject};

/// The places of a person's head, pelvis and feet in a skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Landmarks {
    head: usize,
    pelvis: usize,
    feet: [usize; 2],
}

/// Where they are in one sample, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    /// From the middle of the feet to the head.
    pub(super) upward: DVec3,
    /// The middle of the feet.
    pub(super) feet: DVec3,
    /// The vertical axis of the pelvis in the world, where its orientation is known.
    pub(super) pelvis_up: Option<DVec3>,
}

impl Landmarks {
    /// `None` for what is not a person, by the names that MVN and Motive give the parts of one.
    pub(super) fn of(subject: &Subject) -> Option<Self> {
        let find = |names: &[&str]| {
            let segments = subject.skeleton.segments.iter();
            let is_named = |name: &str| names.iter().any(|wanted| bare(name, &subject.name) == *wanted);
            segments.map(|segment| segment.name.as_str()).position(is_named)
        };
        Some(Self {
            head: find(&["Head"])?,
            pelvis: find(&["Pelvis", "Hip", "Hips"])?,
            feet: [find(&["LeftFoot", "LFoot"])?, find(&["RightFoot", "RFoot"])?],
        })
    }

    /// Where they are, when all are known and none is at the same place.
    pub(super) fn placed(self, frame: &Frame) -> Option<Placed> {
        let position = |place| finite(&frame.position, place);
        let [left, right] = self.feet.map(position);
        let feet = (left? + right?) / 2.0;
        let upward = position(self.head)? - feet;
        let pelvis = frame.orientation.get(self.pelvis).copied().flatten();
        let pelvis = pelvis.filter(|q| q.is_finite() && (q.length() - 1.0).abs() < 0.1);
        (upward.length() > 1e-6).then_some(Placed {
            upward,
            feet,
            pelvis_up: pelvis.map(|q| q.normalize() * DVec3::Z),
        })
    }
}

/// A position that is known and finite.
pub(super) fn finite(positions: &[Option<DVec3>], place: usize) -> Option<DVec3> {
    positions.get(place).copied().flatten().filter(|one| one.is_finite())
}

/// Older servers put the skeleton's name before each bone's.
fn bare<'a>(name: &'a str, subject: &str) -> &'a str {
    let rest = name.strip_prefix(subject).and_then(|rest| rest.strip_prefix('_'));
    rest.unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::super::test::{subject, upright};
    use super::*;
    use posewire_motion::{Segment, SegmentKind, Skeleton};

    #[test]
    fn a_person_is_known_by_the_names_of_either_vendor() {
        assert!(Landmarks::of(&subject()).is_some());
        let mut skeleton = Skeleton::default();
        for name in ["Eve_Hip", "Eve_Head", "Eve_LFoot", "Eve_RFoot"] {
            skeleton.segments.push(Segment::new(name, SegmentKind::Body));
        }
        assert!(Landmarks::of(&Subject::new("Eve", skeleton)).is_some());
        assert_eq!(Landmarks::of(&Subject::new("Box", Skeleton::default())), None);
    }

    #[test]
    fn the_head_is_above_the_feet() {
        let frame = upright();
        let placed = Landmarks::of(&frame.subject).unwrap().placed(&frame).unwrap();
        assert!(placed.upward.z > 1.0 && placed.upward.truncate().length() < 1e-9);
        assert!(placed.pelvis_up.unwrap().z > 0.999);
    }
}
