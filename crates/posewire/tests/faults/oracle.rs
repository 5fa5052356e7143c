//! What must be counted, found by someone who knows which sample each datagram was.

use crate::stream::{Disturbed, PERIOD, TYPES, mark};
use posewire::faults::FaultPlan;
use posewire_mxtp::{Assembler, Datagram, Header, MessageType, SampleCounts};
use std::collections::{BTreeMap, BTreeSet};

/// The counts of one stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) received: u64,
    pub(crate) missing: u64,
    pub(crate) duplicate: u64,
    pub(crate) late: u64,
    pub(crate) reset: u64,
    pub(crate) malformed: u64,
}

/// All that is counted of the only character.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Everything {
    pub(crate) streams: BTreeMap<MessageType, Counts>,
    pub(crate) samples: SampleCounts,
    /// Datagrams that do not decode, whether their stream is known or not.
    pub(crate) malformed: u64,
    /// What is never to be counted: rewinds, jumps, incomplete messages and refused characters.
    pub(crate) strange: u64,
    /// Samples of each type that were lost at the end of a session or the beginning of the next, which nobody can count.
    pub(crate) unknowable: BTreeMap<MessageType, u64>,
}

impl Everything {
    /// What must be counted.
    pub(crate) fn expected(disturbed: &Disturbed, plan: &FaultPlan) -> Self {
        let mut all = Self::default();
        let mut seen: BTreeMap<MessageType, BTreeSet<u16>> = BTreeMap::new();
        for (_, bytes) in &disturbed.arrivals {
            let header = Header::decode(bytes).ok();
            if Datagram::decode(bytes).is_err() {
                all.malformed += 1;
                if let Some(header) = header {
                    all.streams.entry(header.message_type).or_default().malformed += 1;
                }
                continue;
            }
            let header = header.unwrap();
            let (counts, number) = (all.streams.entry(header.message_type).or_default(), mark(&header));
            let seen = seen.entry(header.message_type).or_default();
            let overtaken = seen.last().is_some_and(|newest| number < *newest);
            if seen.insert(number) {
                counts.received += 1;
                counts.late += u64::from(overtaken);
            } else {
                counts.duplicate += 1;
            }
        }
        for (message_type, seen) in &seen {
            let sessions = sessions(seen, plan);
            let counts = all.streams.get_mut(message_type).unwrap();
            counts.missing = sessions.iter().map(gaps).sum();
            counts.reset = sessions.len() as u64 - 1;
            let sent = u64::from(seen.last().unwrap() - seen.first().unwrap()) + 1;
            let unknowable = sent - seen.len() as u64 - counts.missing;
            all.unknowable.insert(*message_type, unknowable);
        }
        all.samples = samples(seen.values(), plan);
        all
    }

    /// What an assembler has counted.
    pub(crate) fn counted(assembler: &Assembler) -> Self {
        let mut all = Self {
            samples: assembler.samples().next().unwrap().1,
            malformed: assembler.malformed().map(|(_, count)| count).sum(),
            strange: assembler.refused() + assembler.events_dropped(),
            ..Self::default()
        };
        for (_, message_type, counters) in assembler.counters() {
            all.strange += counters.rewound + counters.jumped + counters.incomplete;
            assert_eq!(counters.datagrams, counters.received + counters.duplicate);
            let counts = Counts {
                received: counters.received,
                missing: counters.missing,
                duplicate: counters.duplicate,
                late: counters.late,
                reset: counters.reset,
                malformed: counters.malformed,
            };
            all.streams.insert(message_type, counts);
        }
        all
    }
}

/// The samples of each session of the sender.
fn sessions(numbers: &BTreeSet<u16>, plan: &FaultPlan) -> Vec<BTreeSet<u16>> {
    let mut sessions: BTreeMap<usize, BTreeSet<u16>> = BTreeMap::new();
    for number in numbers {
        let session = plan
            .resets
            .iter()
            .filter(|at| **at <= PERIOD * (*number).into())
            .count();
        sessions.entry(session).or_default().insert(*number);
    }
    sessions.into_values().collect()
}

/// How many numbers are missing between the first and the last.
fn gaps(numbers: &BTreeSet<u16>) -> u64 {
    let span = numbers.last().unwrap() - numbers.first().unwrap() + 1;
    u64::from(span) - numbers.len() as u64
}

fn samples<'a>(seen: impl Iterator<Item = &'a BTreeSet<u16>>, plan: &FaultPlan) -> SampleCounts {
    let mut types_of: BTreeMap<u16, usize> = BTreeMap::new();
    for number in seen.flatten() {
        *types_of.entry(*number).or_default() += 1;
    }
    let all = types_of.keys().copied().collect();
    SampleCounts {
        done: types_of.len() as u64,
        partial: types_of.values().filter(|count| **count < TYPES.len()).count() as u64,
        gone: sessions(&all, plan).iter().map(gaps).sum(),
    }
}
