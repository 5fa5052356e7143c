//! One character: the samples that are open, and what was counted.

mod ahead;
mod sessions;

use super::aside::Aside;
use super::counters::{Counters, SampleCounts, Session, Stream};
use super::events::Events;
use super::sample::{OpenSample, Stored, added, segments};
use super::{Event, MAX_OPEN};
use crate::body::Body;
use crate::description::Description;
use crate::motion::MessageTypes;
use crate::sequence::Home;
use crate::{Datagram, DatagramCounter, Header, MessageType, Observation, Sequence};
use posewire_motion::{Frame, Stamp, Subject};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// One character: the samples that are open, and what was counted.
#[derive(Debug)]
pub(super) struct Character {
    id: u8,
    heard: Stamp,
    /// By message type.
    streams: Vec<Stream>,
    /// Tells new samples from those whose frame is done.
    samples: Sequence,
    session: Session,
    /// What may be the beginning of another session.
    aside: Aside,
    /// The oldest first.
    open: VecDeque<OpenSample>,
    /// The samples closed last.
    closed: VecDeque<ClosedSample>,
    /// Those that were closed last in the session before, until this one has as many.
    closed_before: VecDeque<ClosedSample>,
    done: u64,
    partial: u64,
    /// The types that the samples closed last had.
    expected: MessageTypes,
    description: Description,
    /// Frames handed out, to be used again when nobody else holds them any more.
    retired: VecDeque<Arc<Frame>>,
}

#[derive(Clone, Copy, Debug)]
struct ClosedSample {
    number: u32,
    /// The types that came, too late ones included.
    seen: MessageTypes,
    /// Those of which parts were missing.
    incomplete: MessageTypes,
    /// Those that were to come and did not, incomplete ones included.
    lacking: MessageTypes,
}

/// A datagram on its way through, and where what it does is told.
struct Arrival<'a> {
    now: Stamp,
    bytes: &'a [u8],
    datagram: &'a Datagram<'a>,
    /// The place of the datagram's stream.
    stream: usize,
    standing: Standing,
    events: &'a mut Events,
}

/// Whether a datagram comes for the first time, or from aside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Standing {
    Arriving,
    /// It was put aside, and the message told of or not.
    Held {
        told: bool,
    },
}

impl Character {
    pub(super) fn new(id: u8) -> Self {
        Self {
            id,
            heard: Stamp::default(),
            streams: Vec::new(),
            samples: Sequence::new(),
            session: Session::default(),
            aside: Aside::default(),
            open: VecDeque::new(),
            closed: VecDeque::new(),
            closed_before: VecDeque::new(),
            done: 0,
            partial: 0,
            expected: MessageTypes::NONE,
            description: Description::new(id),
            retired: VecDeque::new(),
        }
    }

    pub(super) const fn id(&self) -> u8 {
        self.id
    }

    /// When the latest datagram came.
    pub(super) const fn heard(&self) -> Stamp {
        self.heard
    }

    pub(super) fn subject(&self) -> &Arc<Subject> {
        self.description.subject()
    }

    pub(super) fn counters(&self) -> impl Iterator<Item = (u8, MessageType, &Counters)> {
        let streams = self.streams.iter();
        streams.map(|stream| (self.id, stream.message_type, &stream.counters))
    }

    pub(super) fn sample_counts(&self) -> SampleCounts {
        SampleCounts {
            done: self.done,
            partial: self.partial,
            gone: self.samples.tally().missing,
        }
    }

    /// Bytes of parts of split messages, and of what is put aside.
    pub(super) fn buffered(&self) -> usize {
        self.open.iter().map(OpenSample::buffered).sum::<usize>() + self.aside.buffered()
    }

    /// When the first of the open samples has waited long enough.
    pub(super) fn first_due(&self, close_after: Duration) -> Option<Stamp> {
        (0..self.open.len()).map(|place| self.due(place, close_after)).min()
    }

    pub(super) fn handle(&mut self, now: Stamp, bytes: &[u8], datagram: &Datagram<'_>, events: &mut Events) {
        self.heard = now;
        let stream = self.stream(datagram.header.message_type);
        self.streams[stream].note_datagram(&datagram.header, datagram.quirks);
        let mut arrival = Arrival {
            now,
            bytes,
            datagram,
            stream,
            standing: Standing::Arriving,
            events,
        };
        match datagram.body {
            Body::Meta(_) | Body::Scale(_) => self.describe(&mut arrival),
            Body::Opaque(payload) => self.pass_on(payload, &mut arrival),
            _ => self.assemble(&mut arrival),
        }
    }

    pub(super) fn handle_timeout(&mut self, now: Stamp, close_after: Duration, events: &mut Events) {
        let last = (0..self.open.len()).rfind(|place| self.due(*place, close_after) <= now);
        for _ in 0..last.map_or(0, |place| place + 1) {
            self.close_oldest(events);
        }
        self.close_complete(events);
    }

    /// When an open sample has waited long enough. The newest delays nothing, so it waits longer: a sender or a network
    /// that pauses in the middle of a sample does not break it.
    fn due(&self, place: usize, close_after: Duration) -> Stamp {
        let sample = &self.open[place];
        let is_newest = place + 1 == self.open.len() && !sample.overtaken;
        sample.opened.after(if is_newest {
            close_after * NEWEST_WAITS
        } else {
            close_after
        })
    }

    /// Closes what is open and drops what is aside.
    pub(super) fn finish(&mut self, events: &mut Events) {
        self.aside.retain(|_| false);
        self.close_all(events);
    }

    fn close_all(&mut self, events: &mut Events) {
        while !self.open.is_empty() {
            self.close_oldest(events);
        }
    }

    /// Counts a datagram that does not decode.
    pub(super) fn note_malformed(&mut self, now: Stamp, message_type: MessageType) {
        self.heard = now;
        let stream = self.stream(message_type);
        self.streams[stream].counters.malformed += 1;
    }

    /// Meta data and scale belong to no sample.
    fn describe(&mut self, arrival: &mut Arrival<'_>) {
        let header = &arrival.datagram.header;
        match &arrival.datagram.body {
            Body::Meta(meta) => self.description.note_meta(meta),
            Body::Scale(scale) => self.description.note_scale(header.counter, scale),
            _ => {}
        }
        // Until a sample has come, the header is all that says what the character consists of.
        if self.samples.newest().is_none() && header.body_segments != 0 {
            self.description.adopt_layout(header);
        }
        self.publish(arrival.events);
        // A scale is whole with the last datagram of its sequence.
        if header.counter.is_last() {
            self.receive(arrival);
        }
    }

    fn pass_on(&mut self, payload: &[u8], arrival: &mut Arrival<'_>) {
        let Header {
            message_type,
            sample,
            counter,
            ..
        } = arrival.datagram.header;
        self.receive(arrival);
        arrival.events.push(Event::Opaque {
            character: self.id,
            message_type,
            sample,
            counter,
            payload: payload.to_vec(),
        });
    }

    fn assemble(&mut self, arrival: &mut Arrival<'_>) {
        let header = &arrival.datagram.header;
        match self.place(header, arrival) {
            Ok(place) => self.add(place, arrival),
            Err(home) => self.add_too_late(home, arrival),
        }
        self.close_complete(arrival.events);
    }

    /// The place of the open sample that a datagram belongs to; where it belongs otherwise when its frame is done, or never
    /// will be.
    #[inline]
    fn place(&mut self, header: &Header, arrival: &mut Arrival<'_>) -> Result<usize, Home> {
        let known = self.open.iter().position(|sample| sample.number == header.sample);
        if let Some(place) = known {
            return Ok(place);
        }
        let (observation, home) = self.samples.judge(header.sample, arrival.now);
        if let Observation::Reset(kind) = observation {
            self.begin_session(kind, header.sample, arrival.events);
        } else {
            self.aside.retain(|sample| self.samples.suspects(sample));
        }
        match observation {
            Observation::Duplicate | Observation::Straggler | Observation::Stray => Err(home),
            _ => Ok(self.open_sample(header, arrival.now)),
        }
    }

    fn open_sample(&mut self, header: &Header, now: Stamp) -> usize {
        let frame = self.spare_frame();
        let mut sample = OpenSample::new(header, now, frame, self.description.subject());
        sample.overtaken = self.closed.iter().any(|closed| is_newer(closed.number, header.sample));
        let newer = |open: &OpenSample| is_newer(open.number, header.sample);
        let place = self.open.iter().position(newer).unwrap_or(self.open.len());
        self.open.insert(place, sample);
        place
    }

    /// Adds a datagram to an open sample.
    fn add(&mut self, place: usize, arrival: &mut Arrival<'_>) {
        let (header, stream) = (&arrival.datagram.header, &mut self.streams[arrival.stream]);
        let (message_type, sample) = (header.message_type, &mut self.open[place]);
        if sample.whole.contains(message_type) {
            stream.observe(header.sample, arrival.now, Home::Session, self.session);
            return;
        }
        if !sample.seen.contains(message_type) {
            sample.seen = sample.seen.with(message_type);
            stream.observe(header.sample, arrival.now, Home::Session, self.session);
        }
        if header.counter == DatagramCounter::SINGLE {
            self.add_whole(place, arrival);
        } else {
            self.add_part(place, arrival);
        }
    }

    fn add_whole(&mut self, place: usize, arrival: &mut Arrival<'_>) {
        let datagram = arrival.datagram;
        let place = self.adopt_layout(place, segments(datagram), arrival);
        let sample = &mut self.open[place];
        let quirks = sample.fill(datagram);
        self.streams[arrival.stream].note_quirks(added(quirks, datagram.quirks));
        sample.whole = sample.whole.with(datagram.header.message_type);
        self.receive(arrival);
    }

    fn add_part(&mut self, place: usize, arrival: &mut Arrival<'_>) {
        let message_type = arrival.datagram.header.message_type;
        let stored = self.open[place].store(arrival.bytes, arrival.datagram);
        match stored {
            Stored::Again => self.streams[arrival.stream].note_again(),
            Stored::Full => {}
            Stored::Waiting => {
                self.adopt_layout(place, None, arrival);
            }
            Stored::Whole => {
                let segments = self.open[place].segments(message_type);
                let place = self.adopt_layout(place, segments, arrival);
                let (sample, stream) = (&mut self.open[place], &mut self.streams[arrival.stream]);
                sample.pour(message_type, |quirks| stream.note_quirks(quirks));
                sample.whole = sample.whole.with(message_type);
                self.receive(arrival);
            }
        }
    }

    fn count_too_late(&mut self, home: Home, arrival: &mut Arrival<'_>) {
        let header = &arrival.datagram.header;
        let single = header.counter == DatagramCounter::SINGLE;
        let part_lost = home != Home::Nowhere && self.note_closed(header);
        let stream = &mut self.streams[arrival.stream];
        if part_lost {
            stream.note_too_late();
            return;
        }
        let observation = stream.observe(header.sample, arrival.now, home, self.session);
        if matches!(observation, Observation::New { .. }) {
            stream.note_too_late();
        }
        if single && observation != Observation::Duplicate {
            self.receive(arrival);
        }
    }

    /// Takes note of a type that came too late: the samples that follow wait for it. True when parts of it were missing.
    fn note_closed(&mut self, header: &Header) -> bool {
        let mut all = self.closed.iter_mut().chain(&mut self.closed_before);
        let Some(closed) = all.find(|closed| closed.number == header.sample) else {
            return false;
        };
        let message_type = header.message_type;
        closed.seen = closed.seen.with(message_type);
        self.expected = self.expected.with(message_type);
        if closed.incomplete.contains(message_type) {
            return true;
        }
        let lacked = !closed.lacking.is_empty();
        closed.lacking = closed.lacking.difference(MessageTypes::NONE.with(message_type));
        self.partial -= u64::from(lacked && closed.lacking.is_empty());
        false
    }

    /// Follows a change of the number of segments in the newest sample. What is older is closed as it is, what was
    /// written into the sample before is dropped. Returns where the sample is then.
    #[inline]
    fn adopt_layout(&mut self, place: usize, segments: Option<usize>, arrival: &mut Arrival<'_>) -> usize {
        let header = &arrival.datagram.header;
        let is_newest = match arrival.standing {
            Standing::Arriving => self.samples.newest() == Some(header.sample),
            // They come in the order of their samples.
            Standing::Held { .. } => true,
        };
        if !is_newest {
            return place;
        }
        // Headers of one sample that contradict each other must not undo it again and again.
        let decided = self.open[place].layout_known && header.body_segments != 0;
        self.open[place].layout_known = true;
        if let Some(segments) = segments {
            let live = self.expected.union(self.open[place].seen);
            self.description.note_pose(header, segments, live);
        }
        if decided || !self.description.adopt_layout(header) {
            return place;
        }
        for _ in 0..place {
            self.close_oldest(arrival.events);
        }
        self.publish(arrival.events);
        for sample in &mut self.open {
            sample.restart(self.description.subject());
        }
        0
    }

    fn publish(&mut self, events: &mut Events) {
        if let Some(subject) = self.description.publish() {
            events.push(Event::Subject(subject));
        }
    }

    /// Counts a whole message.
    fn receive(&mut self, arrival: &mut Arrival<'_>) {
        let stream = &mut self.streams[arrival.stream];
        stream.counters.received += 1;
        if arrival.standing == (Standing::Held { told: true }) {
            return;
        }
        arrival.events.push(Event::Message {
            character: self.id,
            message_type: stream.message_type,
            sample: arrival.datagram.header.sample,
        });
    }

    /// Closes samples from the oldest on, as long as they are complete or too many.
    fn close_complete(&mut self, events: &mut Events) {
        while let Some(place) = self.closable() {
            self.close(place, events);
        }
    }

    /// The place of the sample to close next. A sample waits for those before it, except for one that is too late for
    /// the order anyway.
    #[inline]
    fn closable(&self) -> Option<usize> {
        if self.open.len() > MAX_OPEN {
            return Some(0);
        }
        let place = self
            .open
            .iter()
            .position(|sample| self.is_complete(sample) || !sample.overtaken)?;
        self.is_complete(&self.open[place]).then_some(place)
    }

    /// Whether all has come that can be expected. What the first sample is to have shows when the second one begins.
    #[inline]
    fn is_complete(&self, sample: &OpenSample) -> bool {
        let known = !self.expected.is_empty() || self.open.len() > 1;
        let expected = self.expected.union(sample.seen);
        known && expected.difference(sample.whole).is_empty()
    }

    fn close_oldest(&mut self, events: &mut Events) {
        self.close(0, events);
    }

    fn close(&mut self, place: usize, events: &mut Events) {
        let Some(mut sample) = self.open.remove(place) else {
            return;
        };
        let incomplete = sample.seen.difference(sample.whole);
        for message_type in incomplete.iter() {
            let place = self.stream(message_type);
            let stream = &mut self.streams[place];
            stream.counters.incomplete += 1;
            sample.pour(message_type, |quirks| stream.note_quirks(quirks));
        }
        let closed = ClosedSample {
            number: sample.number,
            seen: sample.seen,
            incomplete,
            lacking: self.usual().union(sample.seen).difference(sample.whole),
        };
        self.done += 1;
        self.partial += u64::from(!closed.lacking.is_empty());
        self.remember(closed);
        let frame = sample.into_frame(self.description.subject());
        self.retire(&frame);
        events.push(Event::Frame(frame));
    }

    fn remember(&mut self, sample: ClosedSample) {
        if self.closed.len() == MAX_CLOSED {
            self.closed.pop_front();
            self.closed_before.clear();
        }
        self.closed.push_back(sample);
        let seen = self.closed.iter().rev().take(EXPECTED_OF).map(|closed| closed.seen);
        self.expected = seen.fold(MessageTypes::NONE, MessageTypes::union);
    }

    /// The types that samples have had of late.
    fn usual(&self) -> MessageTypes {
        let before = self.closed_before.iter().skip(self.closed.len());
        let seen = self.closed.iter().chain(before).map(|closed| closed.seen);
        seen.fold(MessageTypes::NONE, MessageTypes::union)
    }

    fn retire(&mut self, frame: &Arc<Frame>) {
        if self.retired.len() == MAX_RETIRED {
            self.retired.pop_front();
        }
        self.retired.push_back(frame.clone());
    }

    /// A frame that is nobody else's.
    fn spare_frame(&mut self) -> Arc<Frame> {
        let free = self.retired.front().is_some_and(|frame| Arc::strong_count(frame) == 1);
        let spare = if free { self.retired.pop_front() } else { None };
        spare.unwrap_or_else(|| Arc::new(Frame::new(self.description.subject().clone())))
    }

    /// The place of the stream of a message type, which may be new.
    #[inline]
    fn stream(&mut self, message_type: MessageType) -> usize {
        let place = self
            .streams
            .binary_search_by_key(&message_type, |stream| stream.message_type);
        place.unwrap_or_else(|place| {
            self.streams.insert(place, Stream::new(message_type, self.session));
            place
        })
    }
}

/// Whether a sample comes after another; the counter wraps around.
pub(super) fn is_newer(sample: u32, than: u32) -> bool {
    matches!(sample.wrapping_sub(than), 1..0x8000_0000)
}

/// How many closed samples are remembered.
const MAX_CLOSED: usize = 16;
/// How many of them tell what the next one waits for.
const EXPECTED_OF: usize = 4;
const MAX_RETIRED: usize = 4;
/// How many times as long as others the newest sample waits for what it lacks.
const NEWEST_WAITS: u32 = 10;
