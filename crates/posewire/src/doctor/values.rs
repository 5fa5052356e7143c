//! Numbers that are none, and bones that are relative to their parents.

use super::Check;
use super::axes::Sender;
use super::finding::{Finding, plural};
use super::landmarks::finite;
use posewire_motion::{DVec3, Frame};

/// Samples with numbers that are infinite or none.
#[derive(Clone, Debug, Default)]
pub(super) struct Finiteness {
    samples: u64,
    /// Where the first of them was.
    first: Option<String>,
}

impl Finiteness {
    pub(super) fn sample(&mut self, frame: &Frame) {
        let Some((section, place)) = first_not_finite(frame) else {
            return;
        };
        self.samples += 1;
        if self.first.is_none() {
            let segment = frame.subject.skeleton.segments.get(place);
            let of = segment.map_or_else(String::new, |segment| format!(" of {}", segment.name));
            self.first = Some(format!("the {section}{of} in sample {}", frame.sample));
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let first = self.first.as_ref()?;
        let what = format!(
            "{} with a number that is infinite or none, the first {first}.",
            plural(self.samples, "sample")
        );
        Some(Finding::new(Check::NotFinite, what))
    }
}

/// The first section with such a number, and its place in it.
fn first_not_finite(frame: &Frame) -> Option<(&'static str, usize)> {
    let vectors = [
        ("position", &frame.position),
        ("velocity", &frame.velocity),
        ("acceleration", &frame.acceleration),
        ("angular velocity", &frame.angular_velocity),
        ("angular acceleration", &frame.angular_acceleration),
    ];
    let is_none = |vector: &Option<DVec3>| vector.is_some_and(|vector| !vector.is_finite());
    let turned = frame.orientation.iter();
    let turned = turned
        .map(|q| q.is_some_and(|q| !q.is_finite()))
        .position(|is_none| is_none);
    let moved = || {
        let found = vectors
            .iter()
            .find_map(|(name, section)| Some((*name, section.iter().position(is_none)?)));
        found.or_else(|| {
            frame
                .joint_angles
                .iter()
                .any(is_none)
                .then_some(("joint angles", usize::MAX))
        })
    };
    turned.map(|place| ("orientation", place)).or_else(moved)
}

/// Whether bones are relative to what they were taken to be relative to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Relations {
    bones: u64,
    /// Those as far from the origin, in every direction, as from their parents in the null pose.
    relative: u64,
    /// Those whose distance from their parents is not that in the null pose.
    torn: u64,
}

impl Relations {
    pub(super) fn sample(&mut self, frame: &Frame) {
        let segments = &frame.subject.skeleton.segments;
        for (place, segment) in segments.iter().enumerate() {
            let Some(parent) = segment.parent else {
                continue;
            };
            let offset = segments
                .get(parent)
                .and_then(|parent| Some(segment.origin? - parent.origin?));
            let position = |place| finite(&frame.position, place);
            if let (Some(offset), Some(own), Some(of_parent)) = (offset, position(place), position(parent)) {
                self.bones += 1;
                self.relative += u64::from((own - offset).length() < CLOSE);
                let difference = (own - of_parent).length() - offset.length();
                self.torn += u64::from(difference.abs() > CLOSE + offset.length() / 2.0);
            }
        }
    }

    /// Only of NatNet, where it is a setting that no packet tells.
    pub(super) fn finding(&self, sender: Sender) -> Option<Finding> {
        let is_most = |count: u64| self.bones >= FEWEST_BONES && count * 10 > self.bones * 8;
        match sender {
            Sender::NatNet {
                bones_are_local: false, ..
            } => {
                let what = "Bones are as far from the origin as they are from their parents.";
                is_most(self.relative).then(|| Finding::new(Check::RelativeBones, what))
            }
            Sender::NatNet {
                bones_are_local: true, ..
            } => {
                let what = "Read as relative to their parents, bones are not as far from these as they are described.";
                let finding = || Finding::new(Check::RelativeBones, what);
                let remedy = "Leave ?skeleton=local out, or choose Local as Skeleton Coordinates in Motive.";
                is_most(self.torn).then(|| finding().with_remedy(remedy))
            }
            Sender::Mxtp => None,
        }
    }
}

/// A bone's length hardly changes, metres.
const CLOSE: f64 = 0.03;
const FEWEST_BONES: u64 = 10;

#[cfg(test)]
mod tests {
    use super::super::test::upright;
    use super::*;

    #[test]
    fn the_first_number_that_is_none_is_named() {
        let mut found = Finiteness::default();
        found.sample(&upright());
        assert_eq!(found.finding(), None);
        let mut frame = upright();
        frame.sample = 7;
        frame.position[6].as_mut().unwrap().y = f64::NAN;
        found.sample(&frame);
        let what = found.finding().unwrap().what;
        assert!(what.ends_with("the first the position of Head in sample 7."), "{what}");
    }

    const GLOBAL: Sender = Sender::NatNet {
        y_is_up: true,
        bones_are_local: false,
    };
    const LOCAL: Sender = Sender::NatNet {
        y_is_up: true,
        bones_are_local: true,
    };

    #[test]
    fn bones_in_the_world_that_were_put_on_their_parents_are_torn_off() {
        let mut frame = upright();
        let before = frame.position.clone();
        let segments = frame.subject.skeleton.segments.clone();
        for (place, segment) in segments.iter().enumerate() {
            if let Some(parent) = segment.parent {
                frame.position[place] = Some(frame.position[parent].unwrap() + before[place].unwrap());
            }
        }
        let mut relations = Relations::default();
        relations.sample(&frame);
        assert!(
            relations
                .finding(LOCAL)
                .unwrap()
                .remedy
                .starts_with("Leave ?skeleton=local out")
        );
    }

    #[test]
    fn bones_relative_to_their_parents_are_told_from_those_in_the_world() {
        let mut relations = Relations::default();
        relations.sample(&upright());
        assert_eq!(relations.finding(GLOBAL), None);
        assert_eq!(relations.finding(LOCAL), None);
        let mut frame = upright();
        let segments = frame.subject.skeleton.segments.clone();
        for (place, segment) in segments.iter().enumerate() {
            let parent = segment
                .parent
                .map_or(DVec3::ZERO, |parent| segments[parent].origin.unwrap());
            frame.position[place] = Some(segment.origin.unwrap() - parent);
        }
        let mut relations = Relations::default();
        relations.sample(&frame);
        assert_eq!(relations.finding(GLOBAL).unwrap().check, Check::RelativeBones);
    }
}
