//! What is counted of each message type of each character.

use crate::{Error, Header, MessageType, Observation, Quirk, Quirks, Sequence};
use posewire_motion::Stamp;

/// What was counted of one message type of one character.
///
/// Meta data, scale and types that are not understood have no sample counter to go by: of them `datagrams`, `received`,
/// `malformed` and `quirks` are counted only.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Datagrams that decode.
    pub datagrams: u64,
    /// Whole messages, duplicates left out; of the scale, whole sequences.
    pub received: u64,
    /// Samples of which nothing came, in strides.
    pub missing: u64,
    /// Messages that came again, and parts of split messages that did.
    pub duplicate: u64,
    /// Messages that came after a newer sample's, or when the frame of their sample was already done.
    pub late: u64,
    /// How often the sample counter started anew: [`ResetKind::Restart`](crate::ResetKind::Restart).
    pub reset: u64,
    /// How often the sample counter was wound back: [`ResetKind::Rewind`](crate::ResetKind::Rewind).
    pub rewound: u64,
    /// How often the sample counter jumped ahead: [`ResetKind::Jump`](crate::ResetKind::Jump).
    pub jumped: u64,
    /// Datagrams that do not decode.
    pub malformed: u64,
    /// Split messages that were not whole when their sample was closed.
    pub incomplete: u64,
    /// Datagrams that deviate from the specification.
    pub quirks: QuirkCounts,
    /// By how much the sample counter goes up; `None` before the second sample.
    pub stride: Option<u32>,
    /// The newest sample.
    pub last_sample: Option<u32>,
    /// The source's clock at the latest datagram, milliseconds.
    pub last_time_ms: Option<u32>,
}

/// What became of the samples of one character: where something of them is missing.
///
/// A type that is missing in a sample is so either because nothing of the sample came or because only this part of it
/// did not. The first says that a whole sample was lost or never sent, which cannot be told apart; the second that a
/// datagram of a sample that was sent did not arrive, or arrived unreadable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleCounts {
    /// Samples of which something came and that are done.
    pub done: u64,
    /// Of these, the ones that lack a type which one of the sixteen samples before them had.
    pub partial: u64,
    /// Samples of which nothing came, in strides.
    pub gone: u64,
}

impl SampleCounts {
    /// Whether all of them came and lack nothing.
    pub const fn are_whole(&self) -> bool {
        self.partial == 0 && self.gone == 0
    }
}

/// How often each quirk was found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct QuirkCounts([u64; Quirk::ALL.len()]);

impl QuirkCounts {
    /// How often this one was found.
    pub const fn count(&self, quirk: Quirk) -> u64 {
        self.0[quirk as usize]
    }

    /// Those that were found.
    pub fn iter(&self) -> impl Iterator<Item = (Quirk, u64)> {
        let all = Quirk::ALL.into_iter().map(|quirk| (quirk, self.count(quirk)));
        all.filter(|(_, count)| *count > 0)
    }

    fn add(&mut self, quirks: Quirks) {
        if !quirks.is_empty() {
            quirks.iter().for_each(|quirk| self.0[quirk as usize] += 1);
        }
    }
}

/// One message type of one character: its counters, and the sequence that some of them come from.
#[derive(Debug)]
pub(super) struct Stream {
    pub(super) message_type: MessageType,
    pub(super) counters: Counters,
    sequence: Sequence,
    /// Duplicates and late ones that the sequence does not know of.
    parts_again: u64,
    too_late: u64,
}

impl Stream {
    pub(super) fn new(message_type: MessageType) -> Self {
        Self {
            message_type,
            counters: Counters::default(),
            sequence: Sequence::new(),
            parts_again: 0,
            too_late: 0,
        }
    }

    pub(super) fn note_datagram(&mut self, header: &Header, quirks: Quirks) {
        self.counters.datagrams += 1;
        self.counters.last_time_ms = Some(header.time_ms);
        self.counters.quirks.add(quirks);
    }

    /// Quirks that became known after the datagram was counted.
    pub(super) fn note_quirks(&mut self, quirks: Quirks) {
        self.counters.quirks.add(quirks);
    }

    /// Takes note of the first datagram of a message, or of a message that came again.
    pub(super) fn observe(&mut self, sample: u32, now: Stamp) -> Observation {
        let duplicate = self.sequence.tally().duplicate;
        let observation = self.sequence.observe(sample, now);
        // Messages that looked like duplicates until it showed that the counter had gone back.
        self.counters.received += duplicate.saturating_sub(self.sequence.tally().duplicate);
        self.tally();
        observation
    }

    /// Takes note of a part that came again.
    pub(super) fn note_part_again(&mut self) {
        self.parts_again += 1;
        self.tally();
    }

    /// Takes note of a message or part whose frame is already done.
    pub(super) fn note_too_late(&mut self) {
        self.too_late += 1;
        self.tally();
    }

    fn tally(&mut self) {
        let tally = self.sequence.tally();
        self.counters.missing = tally.missing;
        self.counters.duplicate = tally.duplicate + self.parts_again;
        self.counters.late = tally.late + self.too_late;
        self.counters.reset = tally.reset;
        self.counters.rewound = tally.rewound;
        self.counters.jumped = tally.jumped;
        self.counters.stride = self.sequence.stride();
        self.counters.last_sample = self.sequence.newest();
    }
}

/// The name of a kind of error, in kebab case.
pub(super) fn kind(error: &Error) -> &'static str {
    match error {
        Error::ShortHeader { .. } => "short-header",
        Error::Magic { .. } => "magic",
        Error::TypeDigits { .. } => "type-digits",
        Error::PayloadSize { .. } => "payload-size",
        Error::Truncated { .. } => "truncated",
        Error::Count { .. } => "count",
        _ => "other",
    }
}
