//! TCP streams, put together from their segments and cut into MXTP datagrams.

use posewire_motion::Stamp;
use posewire_mxtp::Framer;
use std::collections::BTreeMap;
use std::net::SocketAddr;

/// One direction of a connection.
pub(super) type Flow = (SocketAddr, SocketAddr);

/// A segment as it was captured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment<'a> {
    pub(super) flow: Flow,
    pub(super) sequence: u32,
    pub(super) begins: bool,
    pub(super) ends: bool,
    pub(super) bytes: &'a [u8],
}

/// The streams of a capture.
///
/// Segments may come twice or in any order. A segment that was not captured is waited for until [`MAX_HELD`] bytes behind it
/// have come; then the stream goes on behind the gap, where the framer finds the next datagram.
#[derive(Debug, Default)]
pub(super) struct Streams {
    open: BTreeMap<Flow, Stream>,
    /// Counts of streams that have ended.
    past: StreamCounts,
    ordinal: u64,
}

/// What could not be made whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct StreamCounts {
    /// Times that bytes of a stream are missing.
    pub(super) gaps: u64,
    /// Bytes of MXTP streams that are part of no datagram.
    pub(super) skipped: u64,
}

#[derive(Debug)]
struct Stream {
    framer: Framer,
    /// The number of its first byte.
    first: u32,
    /// The place of the byte that is wanted next; its lower half is the byte's number.
    next: u64,
    /// Segments that are ahead, by place.
    held: BTreeMap<u64, Vec<u8>>,
    held_bytes: usize,
    latest: Stamp,
    used: u64,
    counts: StreamCounts,
    datagrams: u64,
}

impl Streams {
    /// Takes a segment that was captured at `now`, and gives each datagram that it completes to `each`.
    pub(super) fn take(&mut self, now: Stamp, segment: Segment<'_>, each: &mut impl FnMut(Flow, Stamp, &[u8])) {
        self.ordinal += 1;
        let first = segment.sequence.wrapping_add(segment.begins.into());
        let known = self.open.get(&segment.flow);
        if known.is_none() && !segment.begins && segment.bytes.is_empty() {
            return;
        }
        // A connection may follow another between the same ports.
        if known.is_none_or(|stream| segment.begins && stream.first != first) {
            self.end(segment.flow, each);
            self.end_the_oldest(each);
            self.open.insert(segment.flow, Stream::new(first));
        }
        let Some(stream) = self.open.get_mut(&segment.flow) else {
            return;
        };
        (stream.used, stream.latest) = (self.ordinal, now);
        let mut each_of_flow = |at: Stamp, bytes: &[u8]| each(segment.flow, at, bytes);
        stream.take(first, segment.bytes, &mut each_of_flow);
        if segment.ends && stream.position(first) + segment.bytes.len() as u64 == stream.next {
            // The stream is kept to know its bytes should they be sent again.
            stream.cut(&mut each_of_flow);
        }
    }

    /// The end of the capture: what the streams still hold.
    pub(super) fn finish(&mut self, each: &mut impl FnMut(Flow, Stamp, &[u8])) {
        for flow in self.open.keys().copied().collect::<Vec<_>>() {
            self.end(flow, each);
        }
    }

    pub(super) fn counts(&self) -> StreamCounts {
        let open = self.open.values().map(Stream::counts);
        open.fold(self.past, StreamCounts::and)
    }

    fn end(&mut self, flow: Flow, each: &mut impl FnMut(Flow, Stamp, &[u8])) {
        if let Some(mut stream) = self.open.remove(&flow) {
            stream.finish(&mut |at, bytes| each(flow, at, bytes));
            self.past = self.past.and(stream.counts());
        }
    }

    fn end_the_oldest(&mut self, each: &mut impl FnMut(Flow, Stamp, &[u8])) {
        if self.open.len() >= MAX_STREAMS {
            let oldest = self.open.iter().min_by_key(|(_, stream)| stream.used);
            if let Some(flow) = oldest.map(|(flow, _)| *flow) {
                self.end(flow, each);
            }
        }
    }
}

impl Stream {
    fn new(first: u32) -> Self {
        Self {
            framer: Framer::new(),
            first,
            next: (1 << 32) + u64::from(first),
            held: BTreeMap::new(),
            held_bytes: 0,
            latest: Stamp(0),
            used: 0,
            counts: StreamCounts::default(),
            datagrams: 0,
        }
    }

    fn counts(&self) -> StreamCounts {
        // A stream of another protocol has neither gaps nor bytes that we miss.
        if self.datagrams == 0 {
            return StreamCounts::default();
        }
        StreamCounts {
            skipped: self.counts.skipped + self.framer.skipped(),
            ..self.counts
        }
    }

    /// The place of the byte of this number that is nearest to the one that is wanted next.
    fn position(&self, number: u32) -> u64 {
        let ahead = number.wrapping_sub(self.next as u32) as i32;
        self.next.saturating_add_signed(ahead.into())
    }

    fn take(&mut self, number: u32, bytes: &[u8], each: &mut impl FnMut(Stamp, &[u8])) {
        let at = self.position(number);
        if at > self.next {
            self.hold(at, bytes);
            if self.held_bytes > MAX_HELD {
                self.leap(each);
            }
        } else {
            self.push(at, bytes, each);
            self.push_held(each);
        }
    }

    /// Takes what is new of the bytes from `at`; what was sent again is known.
    fn push(&mut self, at: u64, bytes: &[u8], each: &mut impl FnMut(Stamp, &[u8])) {
        let known = usize::try_from(self.next - at).unwrap_or(usize::MAX);
        let new = bytes.get(known..).unwrap_or_default();
        self.next += new.len() as u64;
        self.framer.push(new);
        self.give(each);
    }

    /// Takes the segments that have waited for what came now.
    fn push_held(&mut self, each: &mut impl FnMut(Stamp, &[u8])) {
        while let Some(held) = self.held.first_entry().filter(|held| *held.key() <= self.next) {
            let (at, bytes) = held.remove_entry();
            self.held_bytes -= HELD_COST + bytes.len();
            self.push(at, &bytes, each);
        }
    }

    fn give(&mut self, each: &mut impl FnMut(Stamp, &[u8])) {
        while let Some(datagram) = self.framer.next_datagram() {
            self.datagrams += 1;
            each(self.latest, datagram);
        }
    }

    fn hold(&mut self, at: u64, bytes: &[u8]) {
        let is_longer = |held: &Vec<u8>| bytes.len() > held.len();
        if !bytes.is_empty() && self.held.get(&at).is_none_or(is_longer) {
            self.held_bytes += HELD_COST + bytes.len();
            let before = self.held.insert(at, bytes.to_vec());
            self.held_bytes -= before.map_or(0, |held| HELD_COST + held.len());
        }
    }

    /// Goes on behind a gap.
    fn leap(&mut self, each: &mut impl FnMut(Stamp, &[u8])) {
        if let Some(at) = self.held.first_key_value().map(|(at, _)| *at) {
            self.counts.gaps += 1;
            self.cut(each);
            self.next = at;
            self.push_held(each);
        }
    }

    /// Gives what is whole, and forgets the rest.
    fn cut(&mut self, each: &mut impl FnMut(Stamp, &[u8])) {
        self.framer.finish();
        self.give(each);
        self.counts.skipped += self.framer.skipped();
        self.framer = Framer::new();
    }

    fn finish(&mut self, each: &mut impl FnMut(Stamp, &[u8])) {
        while !self.held.is_empty() {
            self.leap(each);
        }
        self.cut(each);
    }
}

impl StreamCounts {
    fn and(self, other: Self) -> Self {
        Self {
            gaps: self.gaps + other.gaps,
            skipped: self.skipped + other.skipped,
        }
    }
}

/// Bytes that may wait for one that is missing; no window of a stream is larger.
const MAX_HELD: usize = 1 << 20;
/// What a held segment costs besides its bytes.
const HELD_COST: usize = 64;
const MAX_STREAMS: usize = 256;
