//! A sample whose messages are arriving.

use crate::body::Body;
use crate::motion::{Filler, MessageTypes};
use crate::{Datagram, DatagramCounter, Header, MessageType, Quirks};
use posewire_motion::{Frame, Stamp, Subject};
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

/// A sample whose messages are arriving: the frame made of those that are whole, and the parts of those that are not.
#[derive(Debug)]
pub(super) struct OpenSample {
    pub(super) number: u32,
    /// When its first datagram arrived.
    pub(super) opened: Stamp,
    /// Types of which something came.
    pub(super) seen: MessageTypes,
    /// Types that are whole.
    pub(super) whole: MessageTypes,
    /// Whether a newer sample is done already.
    pub(super) overtaken: bool,
    /// Whether a header has said how many segments there are.
    pub(super) layout_known: bool,
    /// The types that were whole when its frame was given ahead of older ones.
    given: MessageTypes,
    time: Duration,
    frame: Arc<Frame>,
    filler: Filler,
    parts: Parts,
}

/// What became of a part of a split message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    /// More parts are to come.
    Waiting,
    /// It was the last that was missing.
    Whole,
    /// It is there already.
    Again,
    /// There is no room for it.
    Full,
}

impl OpenSample {
    /// A sample without messages. `frame` is anybody's old one, or a new one.
    pub(super) fn new(header: &Header, now: Stamp, frame: Arc<Frame>, subject: &Arc<Subject>) -> Self {
        let mut sample = Self {
            number: header.sample,
            opened: now,
            seen: MessageTypes::NONE,
            whole: MessageTypes::NONE,
            overtaken: false,
            layout_known: false,
            given: MessageTypes::NONE,
            time: Duration::from_millis(header.time_ms.into()),
            frame,
            filler: Filler::new(),
            parts: Parts::default(),
        };
        sample.restart(subject);
        sample
    }

    /// Empties the frame for a subject with other segments; what filled it before has no place any more.
    pub(super) fn restart(&mut self, subject: &Arc<Subject>) {
        let (number, time, opened) = (self.number, self.time, self.opened);
        let frame = Arc::make_mut(&mut self.frame);
        frame.clear();
        self.filler = Filler::new();
        frame.sample = number;
        frame.time = time;
        frame.received = Some(opened);
        if !Arc::ptr_eq(&frame.subject, subject) {
            frame.subject = subject.clone();
        }
    }

    /// Writes a message of one datagram into the frame.
    pub(super) fn fill(&mut self, datagram: &Datagram<'_>) -> Quirks {
        let frame = Arc::make_mut(&mut self.frame);
        self.filler.fill(frame, &datagram.header, &datagram.body)
    }

    /// Keeps a part of a split message.
    pub(super) fn store(&mut self, bytes: &[u8], datagram: &Datagram<'_>) -> Stored {
        self.parts.push(bytes, datagram)
    }

    /// Writes the parts of a split message into the frame, as far as they are there, and calls `note` with what was
    /// unusual about each.
    pub(super) fn pour(&mut self, message_type: MessageType, mut note: impl FnMut(Quirks)) {
        let frame = Arc::make_mut(&mut self.frame);
        let (mut next, mut first) = (0, Some(0));
        for (index, datagram) in self.parts.of(message_type) {
            first = first.filter(|_| index == next);
            let quirks = self.filler.fill_part(frame, &datagram.header, &datagram.body, first);
            note(added(quirks, datagram.quirks));
            first = first.map(|first| first + datagram.body.items().unwrap_or(0));
            next = index + 1;
        }
    }

    /// How many segments the parts of a pose have together; `None` for what is no pose.
    pub(super) fn segments(&self, message_type: MessageType) -> Option<usize> {
        let parts = || self.parts.of(message_type).map(|(_, datagram)| datagram);
        let items = parts().filter_map(|datagram| datagram.body.items()).sum::<usize>();
        let last = parts().filter_map(|datagram| last_segment(&datagram)).max();
        is_pose(message_type).then(|| items.max(last.unwrap_or(0)))
    }

    /// The frame as it is.
    pub(super) fn into_frame(mut self, subject: &Arc<Subject>) -> Arc<Frame> {
        if self.overtaken {
            Arc::make_mut(&mut self.frame).late = true;
        }
        self.adopt(subject);
        self.frame
    }

    /// Whether its frame was given ahead of older ones.
    pub(super) const fn is_given(&self) -> bool {
        !self.given.is_empty()
    }

    /// The frame as it is, ahead of older ones; `None` when it was given with all that is whole now.
    pub(super) fn give(&mut self, subject: &Arc<Subject>) -> Option<Arc<Frame>> {
        if self.overtaken || self.given == self.whole {
            return None;
        }
        self.given = self.whole;
        self.adopt(subject);
        Some(self.frame.clone())
    }

    fn adopt(&mut self, subject: &Arc<Subject>) {
        if !Arc::ptr_eq(&self.frame.subject, subject) {
            Arc::make_mut(&mut self.frame).subject = subject.clone();
        }
    }

    /// Bytes of parts.
    pub(super) fn buffered(&self) -> usize {
        self.parts.bytes.len()
    }
}

/// The quirks that are not among `known`.
pub(super) fn added(quirks: Quirks, known: Quirks) -> Quirks {
    if quirks.is_empty() {
        return quirks;
    }
    quirks.iter().filter(|quirk| !known.contains(*quirk)).collect()
}

/// How many segments a pose in one datagram has; `None` for what is no pose.
#[inline]
pub(super) fn segments(datagram: &Datagram<'_>) -> Option<usize> {
    if !is_pose(datagram.header.message_type) {
        return None;
    }
    let items = datagram.body.items()?;
    Some(items.max(last_segment(datagram).unwrap_or(0)))
}

#[inline]
fn is_pose(message_type: MessageType) -> bool {
    matches!(
        message_type,
        MessageType::EULER | MessageType::QUATERNION | MessageType::UNITY | MessageType::LINEAR | MessageType::ANGULAR
    )
}

/// The number of segments that an old header leaves to the IDs: a sender may leave out what it does not track.
#[inline]
fn last_segment(datagram: &Datagram<'_>) -> Option<usize> {
    if datagram.header.body_segments != 0 || datagram.quirks.ids_by_position() {
        return None;
    }
    let id = match datagram.body {
        Body::Euler(items) => items.last()?.id(),
        Body::Quaternion(items) => items.last()?.id(),
        Body::Unity(items) => items.last()?.id(),
        Body::Linear(items) => items.last()?.id(),
        Body::Angular(items) => items.last()?.id(),
        _ => return None,
    };
    usize::try_from(id.0).ok()
}

/// The parts of split messages, each a datagram.
#[derive(Debug, Default)]
struct Parts {
    bytes: Vec<u8>,
    parts: Vec<Part>,
}

#[derive(Clone, Debug)]
struct Part {
    message_type: MessageType,
    counter: DatagramCounter,
    bytes: Range<usize>,
}

impl Parts {
    fn push(&mut self, bytes: &[u8], datagram: &Datagram<'_>) -> Stored {
        let Header {
            message_type, counter, ..
        } = datagram.header;
        if self
            .with_type(message_type)
            .any(|part| part.counter.index() == counter.index())
        {
            return Stored::Again;
        }
        let start = self.bytes.len();
        if start + bytes.len() > MAX_BYTES {
            return Stored::Full;
        }
        self.bytes.extend_from_slice(bytes);
        self.parts.push(Part {
            message_type,
            counter,
            bytes: start..start + bytes.len(),
        });
        if self.is_whole(message_type) {
            Stored::Whole
        } else {
            Stored::Waiting
        }
    }

    fn is_whole(&self, message_type: MessageType) -> bool {
        let last = self.last(message_type);
        last.is_some_and(|last| self.before(message_type, last).count() == usize::from(last) + 1)
    }

    /// The index of the part that says that it is the last one.
    fn last(&self, message_type: MessageType) -> Option<u8> {
        let last = self.with_type(message_type).find(|part| part.counter.is_last());
        last.map(|part| part.counter.index())
    }

    /// The parts of a message in their order, with their indices.
    fn of(&self, message_type: MessageType) -> impl Iterator<Item = (u8, Datagram<'_>)> {
        let last = self.last(message_type).unwrap_or(u8::MAX);
        let mut parts: Vec<_> = self.before(message_type, last).collect();
        parts.sort_by_key(|part| part.counter.index());
        parts.into_iter().filter_map(|part| {
            let datagram = Datagram::decode(self.bytes.get(part.bytes.clone())?).ok()?;
            Some((part.counter.index(), datagram))
        })
    }

    fn before(&self, message_type: MessageType, last: u8) -> impl Iterator<Item = &Part> {
        self.with_type(message_type)
            .filter(move |part| part.counter.index() <= last)
    }

    fn with_type(&self, message_type: MessageType) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(move |part| part.message_type == message_type)
    }
}

const MAX_BYTES: usize = 256 << 10;
