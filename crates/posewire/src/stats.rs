//! How a stream is doing: counted in one place, shown by everything.

use crate::histogram::{DurationHistogram, Summary};
use posewire_motion::{Stamp, Subject, Timecode};
use posewire_mxtp::{Assembler, Counters, MessageType};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// How a live stream is doing, since it was opened.
#[derive(Clone, Debug)]
pub struct Statistics {
    /// When this was counted.
    pub at: Stamp,
    /// Since when it is counted.
    pub elapsed: Duration,
    /// Whether the stream has ended and these are the last numbers, with rates over its whole time.
    pub ended: bool,
    /// Datagrams that arrived, of whatever kind.
    pub datagrams: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Datagrams that could not be read at all.
    pub malformed: u64,
    /// What was wrong with the last one of these.
    pub last_malformed: Option<String>,
    /// Bytes of a TCP stream that belonged to no datagram.
    pub skipped_bytes: u64,
    /// Datagrams that the kernel dropped because this program took them too slowly.
    pub kernel_dropped: u64,
    /// Datagrams of characters beyond the 64 that are followed.
    pub characters_refused: u64,
    /// Each subject that was heard of, by its number.
    pub subjects: Vec<SubjectStatistics>,
}

/// How one subject of a live stream is doing.
#[derive(Clone, Debug)]
pub struct SubjectStatistics {
    /// Who it is.
    pub subject: Arc<Subject>,
    /// The time of day of its newest sample, where the source says.
    pub timecode: Option<Timecode>,
    /// Its datagram types, by number.
    pub types: Vec<TypeStatistics>,
}

/// How one datagram type of one subject is doing.
#[derive(Clone, Debug)]
pub struct TypeStatistics {
    /// The type.
    pub message_type: MessageType,
    /// Whole messages a second: since the statistics before these, or over all the time when the stream has ended.
    pub rate_hz: f64,
    /// What arrived and what did not.
    pub counters: Counters,
    /// The time between a message and the next.
    pub interval: Summary,
}

/// Counts what arrives on a live stream, besides what the assembler counts.
#[derive(Debug)]
pub(crate) struct Tally {
    started: Stamp,
    datagrams: u64,
    bytes: u64,
    last_malformed: Option<String>,
    subjects: BTreeMap<u8, Heard>,
}

#[derive(Debug)]
struct Heard {
    subject: Arc<Subject>,
    timecode: Option<Timecode>,
    arrivals: BTreeMap<MessageType, Arrivals>,
}

impl Tally {
    pub(crate) fn new(started: Stamp) -> Self {
        Self {
            started,
            datagrams: 0,
            bytes: 0,
            last_malformed: None,
            subjects: BTreeMap::new(),
        }
    }

    pub(crate) fn datagram(&mut self, bytes: usize) {
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
            arrivals: BTreeMap::new(),
        };
        heard
            .and_modify(|heard| heard.subject = Arc::clone(subject))
            .or_insert_with(fresh);
    }

    pub(crate) fn message(&mut self, character: u8, message_type: MessageType, at: Stamp) {
        if let Some(heard) = self.subjects.get_mut(&character) {
            heard.arrivals.entry(message_type).or_default().arrived(at);
        }
    }

    pub(crate) fn timecode(&mut self, subject: &Subject, timecode: Option<Timecode>) {
        if let (Some(heard), Some(_)) = (self.subjects.get_mut(&(subject.id as u8)), timecode) {
            heard.timecode = timecode;
        }
    }

    /// The numbers so far. Rates are those since the last report.
    pub(crate) fn report(&mut self, assembler: &Assembler, edge: &Edge, ended: bool) -> Statistics {
        let mut counted: BTreeMap<u8, Counted<'_>> = BTreeMap::new();
        for (character, message_type, counters) in assembler.counters() {
            counted.entry(character).or_default().push((message_type, counters));
        }
        let mut counted = |character| counted.remove(&character).unwrap_or_default();
        let subjects = self
            .subjects
            .iter_mut()
            .map(|(character, heard)| heard.report(counted(*character), ended));
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
type Counted<'a> = Vec<(MessageType, &'a Counters)>;

impl Heard {
    fn report(&mut self, mut counted: Counted<'_>, ended: bool) -> SubjectStatistics {
        counted.sort_unstable_by_key(|(message_type, _)| *message_type);
        let types = counted.into_iter().map(|(message_type, counters)| {
            let arrivals = self.arrivals.entry(message_type).or_default();
            TypeStatistics {
                message_type,
                rate_hz: if ended {
                    arrivals.overall_rate()
                } else {
                    arrivals.recent_rate()
                },
                counters: counters.clone(),
                interval: arrivals.interval.summary(),
            }
        });
        let types = types.collect();
        SubjectStatistics {
            subject: Arc::clone(&self.subject),
            timecode: self.timecode,
            types,
        }
    }
}

/// When the messages of one type of one subject arrived.
#[derive(Debug, Default)]
struct Arrivals {
    interval: DurationHistogram,
    count: u64,
    first: Option<Stamp>,
    last: Option<Stamp>,
    /// The last arrival, and how many there were, at the report before.
    before: Option<(Stamp, u64)>,
}

impl Arrivals {
    fn arrived(&mut self, at: Stamp) {
        if let Some(last) = self.last {
            self.interval.record(at.since(last));
        }
        self.first.get_or_insert(at);
        self.last = Some(at);
        self.count += 1;
    }

    /// Messages a second between the last arrival of the report before and the last one of this.
    fn recent_rate(&mut self) -> f64 {
        let (Some(first), Some(last)) = (self.first, self.last) else {
            return 0.0;
        };
        let (since, count) = self.before.unwrap_or((first, 1));
        self.before = Some((last, self.count));
        per_second(self.count - count, last.since(since))
    }

    fn overall_rate(&self) -> f64 {
        let (Some(first), Some(last)) = (self.first, self.last) else {
            return 0.0;
        };
        per_second(self.count.saturating_sub(1), last.since(first))
    }
}

fn per_second(count: u64, time: Duration) -> f64 {
    if time.is_zero() {
        0.0
    } else {
        count as f64 / time.as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_measured_from_arrival_to_arrival() {
        let mut arrivals = Arrivals::default();
        let period = Duration::from_micros(16_667);
        let at = |count: u32| Stamp(1_000_000_000).after(period * count);
        assert!(arrivals.recent_rate().abs() < f64::EPSILON);
        (0..61).for_each(|count| arrivals.arrived(at(count)));
        assert!((arrivals.recent_rate() - 60.0).abs() < 0.01);
        (61..100).for_each(|count| arrivals.arrived(at(count)));
        assert!((arrivals.recent_rate() - 60.0).abs() < 0.01);
        assert!(arrivals.recent_rate().abs() < f64::EPSILON, "nothing has arrived since");
        assert!((arrivals.overall_rate() - 60.0).abs() < 0.01);
        assert_eq!(arrivals.interval.summary().count, 99);
    }
}
