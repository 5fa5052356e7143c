//! Subjects of another system as MVN's characters.

mod names;

use crate::sink::LeftOut;
use names::BodyNames;
use posewire_motion::kinematics::complete;
use posewire_motion::standard::MAX_PROPS;
use posewire_motion::{DQuat, DVec3, Frame, Marker, Segment, SegmentKind, Skeleton, Subject};
use posewire_mxtp::MessageType;
use posewire_mxtp::motion::MessageTypes;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Fits the subjects of another system to MVN's skeleton.
///
/// A skeleton whose segments are named as MVN's or Motive's is a character; characters are numbered from 0 in the order
/// in which they come. What is not such a skeleton is left out, and said.
#[derive(Debug, Default)]
pub(super) struct Fitting {
    /// By the number that the source gives.
    seen: BTreeMap<u32, Seen>,
    /// The characters' numbers, by the number that the source gives. They are kept when it is no character any more.
    numbers: BTreeMap<u32, u32>,
    left_out: Vec<LeftOut>,
}

/// A subject as it came last, and the character that it is, if it is one.
#[derive(Debug)]
struct Seen {
    source: Arc<Subject>,
    fit: Option<Fit>,
}

/// A character and where its segments come from.
#[derive(Debug)]
struct Fit {
    character: Arc<Subject>,
    /// For each segment of the character its place in the source's skeleton.
    places: Vec<Option<usize>>,
}

impl Fitting {
    /// What fitted frames never hold.
    pub(super) const NEVER: MessageTypes = MessageTypes::NONE
        .with(MessageType::LINEAR)
        .with(MessageType::ANGULAR)
        .with(MessageType::TRACKERS)
        .with(MessageType::CENTER_OF_MASS);

    /// Takes the types that fitted frames never fill out of `types`, and tells of it.
    pub(super) fn leave_out_types(types: &mut MessageTypes) -> Vec<LeftOut> {
        let wanted = *types;
        let never = Self::NEVER.iter().filter(|never| wanted.contains(*never));
        let left_out = never.map(|message_type| {
            *types = types.without(message_type);
            LeftOut {
                what: format!("datagram type {message_type} ({})", message_type.name()),
                why: "the source does not carry what it holds",
            }
        });
        left_out.collect()
    }

    /// The character that a subject is; `None` for what is none.
    pub(super) fn character(&mut self, subject: &Arc<Subject>) -> Option<Arc<Subject>> {
        let is_same = |seen: &Seen| Arc::ptr_eq(&seen.source, subject) || seen.source == *subject;
        if !self.seen.get(&subject.id).is_some_and(is_same) {
            self.look_at(subject);
        }
        let fit = self.fit(subject.id)?;
        Some(Arc::clone(&fit.character))
    }

    /// A character's frame, with the angles that its poses tell.
    pub(super) fn frame(&mut self, frame: &Frame) -> Option<Frame> {
        self.character(&frame.subject)?;
        self.fit(frame.subject.id).map(|fit| fit.frame(frame))
    }

    /// What has been left out so far.
    pub(super) fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    fn fit(&self, subject: u32) -> Option<&Fit> {
        self.seen.get(&subject)?.fit.as_ref()
    }

    fn look_at(&mut self, subject: &Arc<Subject>) {
        let next = self.numbers.len() as u32;
        let number = self.numbers.get(&subject.id).copied().unwrap_or(next);
        let (fit, left_out) = Fit::of(subject, number);
        if fit.is_some() {
            self.numbers.insert(subject.id, number);
        }
        for entry in left_out {
            self.leave_out(entry);
        }
        let source = Arc::clone(subject);
        self.seen.insert(subject.id, Seen { source, fit });
    }

    /// Tells each thing once, and not without end of a source that always describes something else.
    fn leave_out(&mut self, entry: LeftOut) {
        if self.left_out.len() < MOST_TOLD && !self.left_out.contains(&entry) {
            self.left_out.push(entry);
        }
    }
}

impl Fit {
    fn of(subject: &Arc<Subject>, number: u32) -> (Option<Self>, Vec<LeftOut>) {
        let segments = &subject.skeleton.segments;
        let Some(names) = BodyNames::of(subject) else {
            return (None, vec![no_place(what(subject))]);
        };
        let (skeleton, places) = standard(segments, &names);
        let mut left_out = Vec::new();
        let sent = |place: usize| places.contains(&Some(place));
        let others = (0..segments.len()).filter(|place| !sent(*place));
        left_out.extend(listed(others.map(|place| segments[place].name.as_str()), subject).map(no_place));
        let missing = skeleton
            .segments
            .iter()
            .zip(&places)
            .filter(|(_, place)| place.is_none());
        left_out.extend(listed(missing.map(|(segment, _)| segment.name.as_str()), subject).map(not_there));
        let character = Subject {
            id: number,
            skeleton,
            ..(**subject).clone()
        };
        let fit = Self {
            character: Arc::new(character),
            places,
        };
        (Some(fit), left_out)
    }

    fn frame(&self, frame: &Frame) -> Frame {
        let mut fitted = Frame::new(Arc::clone(&self.character));
        (fitted.sample, fitted.time) = (frame.sample, frame.time);
        (fitted.received, fitted.timecode) = (frame.received, frame.timecode);
        fitted.position = self.rearranged::<DVec3>(&frame.position);
        fitted.orientation = self.rearranged::<DQuat>(&frame.orientation);
        if self.has_points(&frame.markers) {
            fitted.markers.clone_from(&frame.markers);
        }
        complete(&mut fitted);
        // Without a velocity, which takes another sample, its datagram would be shorter than receivers know it.
        fitted.center_of_mass = None;
        fitted
    }

    fn rearranged<T: Copy>(&self, values: &[Option<T>]) -> Vec<Option<T>> {
        let value = |place: &Option<usize>| values.get((*place)?).copied().flatten();
        self.places.iter().map(value).collect()
    }

    /// Whether markers are numbered as MXTP does, by segment and point, in the order of the character.
    fn has_points(&self, markers: &[Marker]) -> bool {
        let in_order = || {
            self.places
                .iter()
                .enumerate()
                .all(|(index, place)| *place == Some(index))
        };
        let is_point = |marker: &Marker| (1..=self.places.len()).contains(&(marker.id as usize / 256));
        !markers.is_empty() && markers.iter().all(is_point) && in_order()
    }
}

/// MVN's skeleton of these segments, and the place of each in the source.
fn standard(segments: &[Segment], names: &BodyNames) -> (Skeleton, Vec<Option<usize>>) {
    let props: Vec<_> = names.props.iter().copied().take(MAX_PROPS).collect();
    let mut skeleton = Skeleton::standard(props.len(), names.has_fingers());
    let mut props = props.into_iter();
    let places: Vec<_> = skeleton
        .segments
        .iter()
        .map(|segment| match segment.kind {
            SegmentKind::Prop => props.next(),
            _ => names.place(&segment.name),
        })
        .collect();
    for (segment, place) in skeleton.segments.iter_mut().zip(&places) {
        let source = place.map(|place| &segments[place]);
        segment.origin = source.and_then(|source| source.origin);
        segment.points = source.map(|source| source.points.clone()).unwrap_or_default();
        if let (SegmentKind::Prop, Some(source)) = (segment.kind, source) {
            segment.name.clone_from(&source.name);
        }
    }
    skeleton.sensors.clear();
    skeleton.contacts.clear();
    (skeleton, places)
}

/// What a subject is that is no character.
fn what(subject: &Subject) -> String {
    match subject.skeleton.segments.len() {
        0 => "markers without a body".to_owned(),
        1 => format!("rigid body {}", subject.name),
        _ => format!("skeleton {}, whose bones are not named as a person's", subject.name),
    }
}

/// `L3, T12 of Ada`, and how many others when there are many.
fn listed<'a>(names: impl Iterator<Item = &'a str>, subject: &Subject) -> Option<String> {
    let names: Vec<_> = names.collect();
    let shown = names.get(..names.len().min(SHOWN))?.join(", ");
    match names.len() {
        0 => None,
        count if count > SHOWN => Some(format!("{shown} and {} others of {}", count - SHOWN, subject.name)),
        _ => Some(format!("{shown} of {}", subject.name)),
    }
}

fn no_place(what: String) -> LeftOut {
    let why = "MXTP has no place for it";
    LeftOut { what, why }
}

fn not_there(what: String) -> LeftOut {
    let why = "the source has no such segment";
    LeftOut { what, why }
}

const SHOWN: usize = 4;
const MOST_TOLD: usize = 256;

#[cfg(test)]
mod tests;
