//! From the messages of a sample to its frame.

use super::convert::{EULER_SPACE, euler, quaternion, vector};
use super::place::{Places, places};
use super::{joints, sensors, unity};
use crate::body::{
    AngularSegment, Body, CenterOfMass, CenterOfMassPosition, EulerSegment, LinearSegment, PointPosition,
    QuaternionSegment, UnitySegment,
};
use crate::ids::{SegmentCounts, SegmentId};
use crate::{Header, Quirk, Quirks};
use posewire_motion::{CenterOfMass as BodyCenter, DVec3, Frame, Marker, Timecode};
use std::time::Duration;

/// Writes the messages of one sample into its frame.
///
/// Several types say where a segment is. Whatever the order of arrival, the frame's position and orientation come from
/// the best of them: type 02, then 21 and 22, then 01, then 05, whose poses suffer from being put together.
///
/// The frame's `subject.skeleton` says how many segments, joints and sensors there are; what lies outside is left out. No
/// memory is allocated when the frame's lists have room.
#[derive(Clone, Copy, Debug, Default)]
pub struct Filler {
    position: Source,
    orientation: Source,
}

/// The type of message that a section of the frame came from, the worst first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Source {
    #[default]
    Nothing,
    Unity,
    Euler,
    Kinematics,
    Quaternion,
}

/// Which datagram of which message is being written.
#[derive(Clone, Copy)]
pub(super) struct Part {
    /// Number of records in the parts before; `None` when some of these were lost.
    pub(super) first: Option<usize>,
    counts: SegmentCounts,
}

impl Filler {
    /// For a frame without data, as [`Frame::new`] makes it and [`Frame::clear`] leaves it.
    pub fn new() -> Self {
        Self::default()
    }

    /// Writes a whole message, in one datagram or with the records of its parts joined, into the frame.
    ///
    /// Returns what was unusual about where the records belong. Messages about the subject (12, 13) and those that are
    /// not understood change nothing.
    pub fn fill(&mut self, frame: &mut Frame, header: &Header, body: &Body<'_>) -> Quirks {
        self.fill_part(frame, header, body, Some(0))
    }

    /// As [`fill`](Self::fill), of one part of a split message.
    ///
    /// `first` is the number of records in the parts before. `None` says that some of these were lost: then records go
    /// where their IDs say, and those whose IDs say nothing are left out. The parts must be written in their order.
    pub fn fill_part(&mut self, frame: &mut Frame, header: &Header, body: &Body<'_>, first: Option<usize>) -> Quirks {
        if matches!(body, Body::Meta(_) | Body::Scale(_) | Body::Opaque(_)) {
            return Quirks::NONE;
        }
        frame.sample = header.sample;
        frame.time = Duration::from_millis(header.time_ms.into());
        let part = Part {
            first,
            counts: header.segment_counts(),
        };
        match *body {
            Body::Quaternion(items) => self.fill_quaternion(frame, items, part),
            Body::Euler(items) => self.fill_euler(frame, items, part),
            Body::Unity(items) => self.fill_unity(frame, items, part),
            Body::Linear(items) => self.fill_linear(frame, items, part),
            Body::Angular(items) => self.fill_angular(frame, items, part),
            _ => fill_other(frame, body, first),
        }
    }

    fn fill_quaternion(&mut self, frame: &mut Frame, items: &[QuaternionSegment], part: Part) -> Quirks {
        let (records, quirks) = Records::new(items, QuaternionSegment::id, frame, part);
        if let Some(held) = self.position.claim(Source::Quaternion) {
            records.write(held, &mut frame.position, |item| vector(item.position()));
        }
        if let Some(held) = self.orientation.claim(Source::Quaternion) {
            records.write(held, &mut frame.orientation, |item| quaternion(item.orientation()));
        }
        quirks
    }

    fn fill_euler(&mut self, frame: &mut Frame, items: &[EulerSegment], part: Part) -> Quirks {
        let (records, quirks) = Records::new(items, EulerSegment::id, frame, part);
        if let Some(held) = self.position.claim(Source::Euler) {
            let position = |item: &EulerSegment| EULER_SPACE.position_to_canonical(vector(item.position()));
            records.write(held, &mut frame.position, position);
        }
        if let Some(held) = self.orientation.claim(Source::Euler) {
            records.write(held, &mut frame.orientation, |item| euler(item.rotation()));
        }
        quirks
    }

    fn fill_linear(&mut self, frame: &mut Frame, items: &[LinearSegment], part: Part) -> Quirks {
        let (records, quirks) = Records::new(items, LinearSegment::id, frame, part);
        if let Some(held) = self.position.claim(Source::Kinematics) {
            records.write(held, &mut frame.position, |item| vector(item.position()));
        }
        records.write(Held::More, &mut frame.velocity, |item| vector(item.velocity()));
        records.write(Held::More, &mut frame.acceleration, |item| vector(item.acceleration()));
        quirks
    }

    fn fill_angular(&mut self, frame: &mut Frame, items: &[AngularSegment], part: Part) -> Quirks {
        let (records, quirks) = Records::new(items, AngularSegment::id, frame, part);
        if let Some(held) = self.orientation.claim(Source::Kinematics) {
            records.write(held, &mut frame.orientation, |item| quaternion(item.orientation()));
        }
        let (velocity, acceleration) = (&mut frame.angular_velocity, &mut frame.angular_acceleration);
        records.write(Held::More, velocity, |item| vector(item.angular_velocity()));
        records.write(Held::More, acceleration, |item| vector(item.angular_acceleration()));
        quirks
    }

    fn fill_unity(&mut self, frame: &mut Frame, items: &[UnitySegment], part: Part) -> Quirks {
        let (records, quirks) = Records::new(items, UnitySegment::id, frame, part);
        let (position, orientation) = (
            self.position.claim(Source::Unity),
            self.orientation.claim(Source::Unity),
        );
        if position.is_none() && orientation.is_none() {
            return quirks;
        }
        let poses = unity::global_poses(frame, items, records.places);
        let segments = frame.subject.skeleton.segments.len();
        if let Some(held) = position {
            let slots = held.slots(&mut frame.position, segments);
            unity::write(slots, &poses, |pose| pose.position);
        }
        if let Some(held) = orientation {
            let slots = held.slots(&mut frame.orientation, segments);
            unity::write(slots, &poses, |pose| pose.orientation);
        }
        quirks
    }
}

impl Source {
    /// Takes a section for messages of this source, unless a better one has it.
    fn claim(&mut self, by: Self) -> Option<Held> {
        let held = match by.cmp(self) {
            std::cmp::Ordering::Less => return None,
            std::cmp::Ordering::Equal => Held::More,
            std::cmp::Ordering::Greater => Held::New,
        };
        *self = by;
        Some(held)
    }
}

/// Whether a section begins or goes on.
#[derive(Clone, Copy)]
enum Held {
    /// What is in it came from a worse type, or is not there yet.
    New,
    /// Earlier parts of the message may be in it.
    More,
}

impl Held {
    /// The section with an entry for each of `count` things, unknown where nothing has been written.
    fn slots<V: Copy>(self, section: &mut Vec<Option<V>>, count: usize) -> &mut [Option<V>] {
        if matches!(self, Self::New) {
            section.clear();
        }
        slots(section, count)
    }
}

/// The section with an entry for each of `count` things, unknown where nothing has been written.
pub(super) fn slots<V: Copy>(section: &mut Vec<Option<V>>, count: usize) -> &mut [Option<V>] {
    section.resize(count, None);
    section
}

/// The records of a datagram about segments, and where they belong.
struct Records<'a, T> {
    items: &'a [T],
    id: fn(&T) -> SegmentId,
    places: Places,
    segments: usize,
}

impl<'a, T> Records<'a, T> {
    fn new(items: &'a [T], id: fn(&T) -> SegmentId, frame: &Frame, part: Part) -> (Self, Quirks) {
        let segments = frame.subject.skeleton.segments.len();
        let (places, quirk) = places(&items.iter().map(id), part.first, segments, part.counts);
        let records = Self {
            items,
            id,
            places,
            segments,
        };
        (records, quirk.into_iter().collect())
    }

    #[inline]
    fn write<V: Copy>(&self, held: Held, section: &mut Vec<Option<V>>, value: impl Fn(&T) -> V) {
        let slots = held.slots(section, self.segments);
        if let Places::InOrder(first) = self.places {
            let slots = slots.get_mut(first..).unwrap_or_default();
            for (slot, item) in slots.iter_mut().zip(self.items) {
                *slot = Some(value(item));
            }
            return;
        }
        for (position, item) in self.items.iter().enumerate() {
            let place = self.places.of(position, (self.id)(item));
            if let Some(slot) = place.and_then(|place| slots.get_mut(place)) {
                *slot = Some(value(item));
            }
        }
    }
}

/// The types that are not poses of segments.
fn fill_other(frame: &mut Frame, body: &Body<'_>, first: Option<usize>) -> Quirks {
    match *body {
        Body::JointAngles(items) => return joints::fill(frame, items, first),
        Body::Trackers(items) => return sensors::fill(frame, items, first),
        Body::TrackersShort(items) => return sensors::fill_short(frame, items, first),
        Body::Points(items) => fill_markers(frame, items, first),
        Body::CenterOfMass(center) => frame.center_of_mass = Some(moving_center(center)),
        Body::CenterOfMassShort(center) => frame.center_of_mass = Some(still_center(center)),
        Body::TimeCode(code) => {
            frame.timecode = code
                .millis_of_day()
                .map(|millis| Timecode::from_milliseconds(millis.into()));
            return match frame.timecode {
                Some(_) => Quirks::NONE,
                None => Quirk::TimeCodeText.into(),
            };
        }
        _ => {}
    }
    Quirks::NONE
}

fn fill_markers(frame: &mut Frame, items: &[PointPosition], first: Option<usize>) {
    if first == Some(0) {
        frame.markers.clear();
    }
    frame.markers.extend(items.iter().map(|item| Marker {
        id: item.id().0,
        position: Some(EULER_SPACE.position_to_canonical(vector(item.position()))),
    }));
}

fn moving_center(center: &CenterOfMass) -> BodyCenter {
    BodyCenter {
        position: vector(center.position()),
        velocity: Some(vector(center.velocity())),
        acceleration: Some(vector(center.acceleration())),
    }
}

fn still_center(center: &CenterOfMassPosition) -> BodyCenter {
    BodyCenter {
        position: vector(center.position()),
        velocity: None::<DVec3>,
        acceleration: None,
    }
}
