//! Statistics of MXTP.

use std::collections::BTreeMap;
use std::sync::Arc;

use posewire_motion::{Frame, Stamp, Subject, Timecode};
use posewire_mxtp::{Assembler, MessageType};

use super::arrivals::Arrivals;
use super::transit::Transits;
use super::{Counters, Statistics, SubjectStatistics};

/// Counts what arrives on a live stream, besides what the assembler counts.
#[derive(Debug)]
pub(crate) struct Tally {
    started: Stamp,
    datagrams: u64,
    bytes: u64,
    last_malformed: Option<String>,
    /// Whether the newest datagram is of a sender on this machine.
    is_here: bool,
    subjects: BTreeMap<u8, Heard>,
}

#[derive(Debug)]
struct Heard {
    subject: Arc<Subject>,
    timecode: Option<Timecode>,
    transits: Transits,
    arrivals: BTreeMap<MessageType, Arrivals>,
}

impl Tally {
    pub(crate) fn new(started: Stamp) -> Self {
        Self {
            started,
            datagrams: 0,
            bytes: 0,
            last_malformed: None,
            is_here: false,
            subjects: BTreeMap::new(),
        }
    }

    /// A datagram; `is_here` when its sender is on this machine.
    pub(crate) fn datagram(&mut self, bytes: usize, is_here: bool) {
        self.is_here = is_here;
        self.datagrams += 1;
        self.bytes += bytes as u64;
    }

    pub(crate) fn malformed(&mut self, problem: String) {
        self.last_malformed = Some(problem);
    }

    pub(crate) fn subject(&mut self, subject: &Arc<Subject>) {
        let heard = self.subjects.entry(subject.id as u8);
        let fresh = || Heard {
            subject: Arc::clone(subject),
            timecode: None,
            transits: Transits::default(),
            arrivals: BTreeMap::new(),
        };
        heard
            .and_modify(|heard| heard.subject = Arc::clone(subject))
            .or_insert_with(fresh);
    }

    pub(crate) fn message(&mut self, character: u8, message_type: MessageType, at: Stamp) {
        if let Some(heard) = self.subjects.get_mut(&character) {
            heard.transits.is_here = self.is_here;
            heard.arrivals.entry(message_type).or_default().arrived(at);
        }
    }

    pub(crate) fn sample(&mut self, frame: &Frame) {
        if let Some(heard) = self.subjects.get_mut(&(frame.subject.id as u8)) {
            heard.timecode = frame.timecode.or(heard.timecode);
            heard.transits.sample(frame);
        }
    }

    /// The numbers so far. Rates are those since the last report.
    pub(crate) fn report(&mut self, assembler: &Assembler, edge: &Edge, ended: bool) -> Statistics {
        let mut counted: BTreeMap<u8, Counted<'_>> = BTreeMap::new();
        for (character, message_type, counters) in assembler.counters() {
            counted.entry(character).or_default().push((message_type, counters));
        }
        let mut counted = |character| counted.remove(&character).unwrap_or_default();
        let samples: BTreeMap<_, _> = assembler.samples().collect();
        let subjects = self.subjects.iter_mut().map(|(character, heard)| SubjectStatistics {
            samples: samples.get(character).copied(),
            ..heard.report(counted(*character), ended)
        });
        Statistics {
            at: edge.now,
            elapsed: edge.now.since(self.started),
            ended,
            datagrams: self.datagrams,
            bytes: self.bytes,
            malformed: assembler.malformed().map(|(_, count)| count).sum(),
            last_malformed: self.last_malformed.clone(),
            skipped_bytes: edge.skipped_bytes,
            kernel_dropped: edge.kernel_dropped,
            characters_refused: assembler.refused(),
            subjects: subjects.collect(),
            server: None,
        }
    }
}

/// What the socket knows and the assembler does not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) now: Stamp,
    pub(crate) kernel_dropped: u64,
    pub(crate) skipped_bytes: u64,
}

/// What the assembler counted of one character, by type.
type Counted<'a> = Vec<(MessageType, &'a posewire_mxtp::Counters)>;

impl Heard {
    fn report(&mut self, mut counted: Counted<'_>, ended: bool) -> SubjectStatistics {
        counted.sort_unstable_by_key(|(message_type, _)| *message_type);
        let streams = counted.into_iter().map(|(message_type, counters)| {
            let arrivals = self.arrivals.entry(message_type).or_default();
            arrivals.report(message_type.into(), counters.into(), ended)
        });
        let streams = streams.collect();
        SubjectStatistics {
            subject: Arc::clone(&self.subject),
            timecode: self.timecode,
            streams,
            samples: None,
            transit: Some(self.transits.report()),
            tracking: None,
        }
    }
}

impl From<&posewire_mxtp::Counters> for Counters {
    fn from(counted: &posewire_mxtp::Counters) -> Self {
        let quirks = counted.quirks.iter();
        Self {
            datagrams: counted.datagrams,
            received: counted.received,
            missing: counted.missing,
            duplicate: counted.duplicate,
            late: counted.late,
            reset: counted.reset,
            rewound: counted.rewound,
            jumped: counted.jumped,
            malformed: counted.malformed,
            incomplete: counted.incomplete,
            stride: counted.stride,
            quirks: quirks.map(|(quirk, count)| (quirk.into(), count)).collect(),
        }
    }
}
