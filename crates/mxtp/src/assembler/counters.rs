//! What is counted of each message type of each character.

use crate::sequence::Home;
use crate::{Error, Header, MessageType, Observation, Quirk, Quirks, ResetKind, Sequence};
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
    /// Messages that came after a newer sample's, or when the frame of their sample was already done, and those of a
    /// sample that fits nowhere and that none followed.
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
    /// What the sequence does not know of.
    beyond: Fate,
    /// The session of the character that the sequence follows.
    session: u64,
}

/// By how much a datagram changes the counters of its stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Fate {
    missing: i64,
    duplicate: i64,
    late: i64,
    received: i64,
}

impl Fate {
    /// Whether it was told of as a message.
    pub(super) const fn is_received(&self) -> bool {
        self.received > 0
    }
}

/// Which session of a character goes on, and how it began.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Session {
    number: u64,
    kind: Option<ResetKind>,
}

impl Session {
    pub(super) const fn next(self, kind: ResetKind) -> Self {
        Self {
            number: self.number + 1,
            kind: Some(kind),
        }
    }
}

impl Stream {
    pub(super) fn new(message_type: MessageType, session: Session) -> Self {
        Self {
            message_type,
            counters: Counters::default(),
            sequence: Sequence::new(),
            beyond: Fate::default(),
            session: session.number,
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
    pub(super) fn observe(&mut self, sample: u32, now: Stamp, home: Home, session: Session) -> Observation {
        let begun = session.number - self.session;
        let observation = match (home, session.kind) {
            (Home::Session, Some(kind)) if begun > 0 => self.begin(sample, now, kind, session),
            // Of what has begun since, this stream has had nothing yet.
            (Home::Before, _) if begun > 0 => self.sequence.follow(sample, now, Home::Session),
            _ => self.sequence.follow(sample, now, home),
        };
        self.tally();
        observation
    }

    fn begin(&mut self, sample: u32, now: Stamp, kind: ResetKind, session: Session) -> Observation {
        self.session = session.number;
        if self.sequence.newest().is_none() {
            return self.sequence.follow(sample, now, Home::Session);
        }
        self.sequence.restart(kind, sample, now);
        Observation::Reset(kind)
    }

    /// The counters that a datagram changes, to tell by how much it did.
    pub(super) fn fate(&self) -> Fate {
        let counters = &self.counters;
        Fate {
            missing: counters.missing.cast_signed(),
            duplicate: counters.duplicate.cast_signed(),
            late: counters.late.cast_signed(),
            received: counters.received.cast_signed(),
        }
    }

    /// By how much the counters have changed.
    pub(super) fn fate_since(&self, before: Fate) -> Fate {
        let now = self.fate();
        Fate {
            missing: now.missing - before.missing,
            duplicate: now.duplicate - before.duplicate,
            late: now.late - before.late,
            received: now.received - before.received,
        }
    }

    /// Takes back what a datagram was counted as.
    pub(super) fn take_back(&mut self, fate: Fate) {
        self.beyond.missing -= fate.missing;
        self.beyond.duplicate -= fate.duplicate;
        self.beyond.late -= fate.late;
        self.counters.received = self.counters.received.saturating_add_signed(-fate.received);
        self.tally();
    }

    /// How many messages came in their order.
    pub(super) const fn in_order(&self) -> i64 {
        self.counters.received.cast_signed() - self.counters.late.cast_signed()
    }

    /// Counts the messages as late that came in their order since there were so many of them.
    pub(super) fn note_overtaken_since(&mut self, in_order: i64) {
        self.beyond.late += (self.in_order() - in_order).max(0);
        self.tally();
    }

    /// Takes note of a part, or of a datagram put aside, that came again.
    pub(super) fn note_again(&mut self) {
        self.beyond.duplicate += 1;
        self.tally();
    }

    /// Takes note of a message or part whose frame is already done.
    pub(super) fn note_too_late(&mut self) {
        self.beyond.late += 1;
        self.tally();
    }

    fn tally(&mut self) {
        let tally = self.sequence.tally();
        self.counters.missing = tally.missing.saturating_add_signed(self.beyond.missing);
        self.counters.duplicate = tally.duplicate.saturating_add_signed(self.beyond.duplicate);
        self.counters.late = tally.late.saturating_add_signed(self.beyond.late);
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
