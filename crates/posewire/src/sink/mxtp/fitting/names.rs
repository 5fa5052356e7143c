//! Which segment of MVN's body a name means.

use posewire_motion::standard::{BODY_SEGMENTS, FINGER_SEGMENTS};
use posewire_motion::{Segment, Subject};
use std::collections::HashMap;

/// Where the segments of MVN's body are in a skeleton.
#[derive(Debug)]
pub(super) struct BodyNames<'a> {
    places: HashMap<&'a str, usize>,
    /// Segments that hang on a hand of MVN's body and are no fingers.
    pub(super) props: Vec<usize>,
}

impl<'a> BodyNames<'a> {
    /// The names of a person's skeleton, as MVN or Motive has them; `None` when it is something else.
    pub(super) fn of(subject: &'a Subject) -> Option<Self> {
        let segments = &subject.skeleton.segments;
        let bare = |segment: &'a Segment| bare(&segment.name, &subject.name);
        let is_of_mvn = BODY_SEGMENTS
            .iter()
            .all(|entry| segments.iter().any(|segment| segment.name == entry.name));
        let meaning = |name: &'a str| if is_of_mvn { Some(name) } else { in_mvn(name) };
        let mut places = HashMap::new();
        for (place, segment) in segments.iter().enumerate() {
            if let Some(name) = meaning(bare(segment)) {
                places.entry(name).or_insert(place);
            }
        }
        let found = BODY_SEGMENTS
            .iter()
            .filter(|entry| places.contains_key(entry.name))
            .count();
        let props = if is_of_mvn { props(segments) } else { Vec::new() };
        (found >= FEWEST && places.contains_key("Pelvis")).then_some(Self { places, props })
    }

    pub(super) fn place(&self, name: &str) -> Option<usize> {
        self.places.get(name).copied()
    }

    /// Whether the fingers of both hands are there.
    pub(super) fn has_fingers(&self) -> bool {
        ["Left", "Right"].iter().all(|side| {
            let named = |entry: &posewire_motion::standard::FingerSegment| format!("{side}{}", entry.name);
            FINGER_SEGMENTS.iter().all(|entry| self.place(&named(entry)).is_some())
        })
    }
}

/// Older servers put the skeleton's name before each bone's.
fn bare<'a>(name: &'a str, subject: &str) -> &'a str {
    let rest = name.strip_prefix(subject).and_then(|rest| rest.strip_prefix('_'));
    rest.unwrap_or(name)
}

/// The segment of MVN that a bone of Motive's is.
fn in_mvn(name: &str) -> Option<&'static str> {
    let found = MOTIVE.iter().find(|(motive, _)| *motive == name);
    found.map(|(_, mvn)| *mvn)
}

/// What is neither of the body nor a finger.
fn props(segments: &[Segment]) -> Vec<usize> {
    let is_finger = |name: &str| {
        let rest = name.strip_prefix("Left").or_else(|| name.strip_prefix("Right"));
        rest.is_some_and(|rest| FINGER_SEGMENTS.iter().any(|entry| entry.name == rest))
    };
    let is_body = |name: &str| BODY_SEGMENTS.iter().any(|entry| entry.name == name);
    let is_prop = |place: &usize| !is_body(&segments[*place].name) && !is_finger(&segments[*place].name);
    (0..segments.len()).filter(is_prop).collect()
}

/// So many segments make a person: some skeletons of Motive lack toes or the neck.
const FEWEST: usize = 12;

/// The bones of Motive's skeletons of people. Its spine has two bones where MVN has four segments: they are taken for
/// those that begin where they begin.
const MOTIVE: [(&str, &str); 21] = [
    ("Hip", "Pelvis"),
    ("Ab", "L5"),
    ("Chest", "T8"),
    ("Neck", "Neck"),
    ("Head", "Head"),
    ("RShoulder", "RightShoulder"),
    ("RUArm", "RightUpperArm"),
    ("RFArm", "RightForeArm"),
    ("RHand", "RightHand"),
    ("LShoulder", "LeftShoulder"),
    ("LUArm", "LeftUpperArm"),
    ("LFArm", "LeftForeArm"),
    ("LHand", "LeftHand"),
    ("RThigh", "RightUpperLeg"),
    ("RShin", "RightLowerLeg"),
    ("RFoot", "RightFoot"),
    ("RToe", "RightToe"),
    ("LThigh", "LeftUpperLeg"),
    ("LShin", "LeftLowerLeg"),
    ("LFoot", "LeftFoot"),
    ("LToe", "LeftToe"),
];
