//! Numbers that are none, and bones that are relative to their parents.

use super::Check;
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

/// Whether bones are where they are in the null pose relative to their parents, and not in the world.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Relations {
    bones: u64,
    relative: u64,
}

impl Relations {
    pub(super) fn sample(&mut self, frame: &Frame) {
        let segments = &frame.subject.skeleton.segments;
        for (place, segment) in segments.iter().enumerate() {
            let parent = segment.parent.and_then(|parent| segments.get(parent));
            let offset = parent.and_then(|parent| Some(segment.origin? - parent.origin?));
            let (Some(offset), Some(position)) = (offset, finite(&frame.position, place)) else {
                continue;
            };
            self.bones += 1;
            self.relative += u64::from((position - offset).length() < CLOSE);
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let what = "Bones are as far from the origin as they are from their parents.";
        let is_relative = self.bones >= FEWEST_BONES && self.relative * 10 > self.bones * 8;
        is_relative.then(|| Finding::new(Check::RelativeBones, what))
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

    #[test]
    fn bones_relative_to_their_parents_are_told_from_those_in_the_world() {
        let mut relations = Relations::default();
        relations.sample(&upright());
        assert_eq!(relations.finding(), None);
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
        assert_eq!(relations.finding().unwrap().check, Check::RelativeBones);
    }
}
