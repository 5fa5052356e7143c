//! What was done to a stream.

use super::FaultKind;
use crate::stats::DatagramKind;
use std::collections::BTreeMap;

/// Which datagrams share one numbering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct FaultedStream {
    /// The character's number on the wire, from 0; `None` where frames hold everybody.
    pub character: Option<u8>,
    /// What kind they are; `None` of those that have no numbering known here.
    pub kind: Option<DatagramKind>,
}

/// How often each fault was made, in all and in each stream.
///
/// Loss, burst, dup, reorder, jitter, drift, truncate, flip, nan and silence count datagrams. A reset or rewind of the
/// sender is counted once in each stream that shows it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaultCounts {
    /// Datagrams that were to leave.
    pub taken: u64,
    /// Datagrams that left, duplicates included.
    pub sent: u64,
    streams: BTreeMap<FaultedStream, Counts>,
}

type Counts = [u64; FaultKind::ALL.len()];

impl FaultCounts {
    /// How often this fault was made.
    pub fn of(&self, kind: FaultKind) -> u64 {
        self.streams.values().map(|counts| counts[kind as usize]).sum()
    }

    /// How often this fault was made in one stream.
    pub fn in_stream(&self, stream: FaultedStream, kind: FaultKind) -> u64 {
        self.streams.get(&stream).map_or(0, |counts| counts[kind as usize])
    }

    /// The streams in which faults were made, in order.
    pub fn streams(&self) -> impl Iterator<Item = FaultedStream> {
        self.streams.keys().copied()
    }

    /// The faults that were made: kinds and counts.
    pub fn iter(&self) -> impl Iterator<Item = (FaultKind, u64)> {
        let all = FaultKind::ALL.into_iter().map(|kind| (kind, self.of(kind)));
        all.filter(|(_, count)| *count > 0)
    }

    /// These and others together.
    #[must_use]
    pub fn and(mut self, others: &Self) -> Self {
        self.taken += others.taken;
        self.sent += others.sent;
        for (stream, counts) in &others.streams {
            let sums = self.streams.entry(*stream).or_default();
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        self
    }

    pub(super) fn add(&mut self, stream: FaultedStream, kind: FaultKind) {
        self.streams.entry(stream).or_default()[kind as usize] += 1;
    }
}
