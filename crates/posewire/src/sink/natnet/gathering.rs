//! The samples of several subjects that make one packet.

use posewire_motion::Frame;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// One subject's share of a packet.
#[derive(Clone, Debug)]
pub(super) struct Share {
    pub(super) frame: Arc<Frame>,
    /// When it was to leave the source, if the source is paced.
    pub(super) due: Option<Instant>,
}

/// The frames of one sample number, until all that are awaited have come.
///
/// A subject is awaited from its description on, and no longer when it was missing from so many packets in a row that it
/// has probably gone.
#[derive(Debug)]
pub(super) struct Gathering {
    /// How long the subjects of a sample may come after each other.
    limit: Duration,
    shares: Vec<Share>,
    begun: Option<Instant>,
    /// Packets taken so far.
    packets: u64,
    /// Packets in a row that lacked somebody who was awaited.
    partial: u64,
    /// For each subject, how many packets there were when it was last in one.
    seen: BTreeMap<u32, u64>,
}

impl Gathering {
    /// Of subjects of a sample that come within `limit` of each other.
    pub(super) fn new(limit: Duration) -> Self {
        Self {
            limit,
            shares: Vec::new(),
            begun: None,
            packets: 0,
            partial: 0,
            seen: BTreeMap::new(),
        }
    }

    /// Awaits a subject from now on.
    pub(super) fn expect(&mut self, subject: u32) {
        self.seen.insert(subject, self.packets);
    }

    /// How many subjects are known.
    pub(super) fn subjects(&self) -> usize {
        self.seen.len()
    }

    /// Whether what is gathered must go before `frame` can come: it is of another sample or of the same subject.
    pub(super) fn is_ended_by(&self, frame: &Frame) -> bool {
        self.shares
            .first()
            .is_some_and(|share| share.frame.sample != frame.sample)
            || self.holds(frame.subject.id)
    }

    pub(super) fn push(&mut self, now: Instant, share: Share) {
        self.begun.get_or_insert(now);
        self.expect(share.frame.subject.id);
        self.shares.push(share);
    }

    /// Whether nobody else is awaited.
    pub(super) fn is_complete(&self) -> bool {
        let is_awaited = |seen: u64| self.packets - seen < MISSING_LIMIT;
        let missing = |(subject, seen): (&u32, &u64)| is_awaited(*seen) && !self.holds(*subject);
        !self.shares.is_empty() && !self.seen.iter().any(missing)
    }

    /// Whether who is missing has had time enough.
    pub(super) fn is_overdue(&self, now: Instant) -> bool {
        let waited = |begun: Instant| now.saturating_duration_since(begun) >= self.limit;
        self.begun.is_some_and(waited)
    }

    /// Whether the packet taken last was one too many that lacked somebody who is there: those who come are numbered each
    /// for itself. True once.
    pub(super) fn comes_apart(&self) -> bool {
        self.partial == PARTIAL_LIMIT
    }

    /// Takes out what is gathered.
    pub(super) fn take(&mut self) -> Vec<Share> {
        if !self.shares.is_empty() {
            self.partial = if self.is_complete() { 0 } else { self.partial + 1 };
            self.packets += 1;
        }
        self.begun = None;
        std::mem::take(&mut self.shares)
    }

    fn holds(&self, subject: u32) -> bool {
        self.shares.iter().any(|share| share.frame.subject.id == subject)
    }
}

/// In so many packets a subject may be missing before nobody waits for it any more.
const MISSING_LIMIT: u64 = 8;
/// So many packets in a row in which somebody was missing are no accident.
const PARTIAL_LIMIT: u64 = 100;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};

    const LIMIT: Duration = Duration::from_millis(10);

    fn share(subject: u32, sample: u32) -> Share {
        let subject = Subject {
            id: subject,
            ..Subject::new("", Skeleton::default())
        };
        let mut frame = Frame::new(Arc::new(subject));
        frame.sample = sample;
        Share {
            frame: Arc::new(frame),
            due: None,
        }
    }

    /// Pushes shares as the sink does, and gives the packets as lists of subject and sample.
    fn packets(gathering: &mut Gathering, shares: &[(u32, u32)]) -> Vec<Vec<(u32, u32)>> {
        let mut packets = Vec::new();
        let number = |share: Share| (share.frame.subject.id, share.frame.sample);
        for (subject, sample) in shares {
            let share = share(*subject, *sample);
            if gathering.is_ended_by(&share.frame) {
                packets.push(gathering.take().into_iter().map(number).collect());
            }
            gathering.push(Instant::now(), share);
            if gathering.is_complete() {
                packets.push(gathering.take().into_iter().map(number).collect());
            }
        }
        packets
    }

    #[test]
    fn subjects_of_one_sample_share_a_packet() {
        let mut gathering = Gathering::new(LIMIT);
        (0..2).for_each(|subject| gathering.expect(subject));
        let found = packets(&mut gathering, &[(0, 5), (1, 5), (1, 6), (0, 6)]);
        assert_eq!(found, [[(0, 5), (1, 5)], [(1, 6), (0, 6)]]);
    }

    #[test]
    fn a_missing_subject_is_waited_for_until_the_next_sample_and_then_no_more() {
        let mut gathering = Gathering::new(LIMIT);
        (0..2).for_each(|subject| gathering.expect(subject));
        let alone: Vec<_> = (0..12).map(|sample| (0, sample)).collect();
        let found = packets(&mut gathering, &alone);
        assert_eq!(found.len(), 12);
        assert!(gathering.shares.is_empty());
        let again = packets(&mut gathering, &[(1, 12), (0, 12), (1, 13), (0, 13)]);
        assert_eq!(again, [[(1, 12), (0, 12)], [(1, 13), (0, 13)]]);
    }

    #[test]
    fn a_sample_number_that_repeats_is_another_packet() {
        let mut gathering = Gathering::new(LIMIT);
        let found = packets(&mut gathering, &[(0, 7), (0, 7)]);
        assert_eq!(found, [[(0, 7)], [(0, 7)]]);
    }

    #[test]
    fn subjects_that_are_numbered_apart_are_told_from_one_that_is_missing() {
        let mut gathering = Gathering::new(LIMIT);
        (0..2).for_each(|subject| gathering.expect(subject));
        let mut told = |shares: &[(u32, u32)]| {
            let told = |share| {
                packets(&mut gathering, &[share]);
                gathering.comes_apart()
            };
            shares.iter().copied().map(told).filter(|told| *told).count()
        };
        let alone: Vec<_> = (0..200).map(|sample| (0, sample)).collect();
        assert_eq!(told(&alone), 0);
        let together: Vec<_> = (0..400).map(|place| (place % 2, 1000 + place / 2)).collect();
        assert_eq!(told(&together), 0);
        let apart: Vec<_> = (0..400)
            .map(|place| (place % 2, 5000 + place / 2 + place % 2 * 700))
            .collect();
        assert_eq!(told(&apart), 1);
    }

    #[test]
    fn what_has_waited_long_enough_is_overdue() {
        let mut gathering = Gathering::new(LIMIT);
        gathering.expect(1);
        let begun = Instant::now();
        gathering.push(begun, share(0, 1));
        assert!(!gathering.is_complete() && !gathering.is_overdue(begun));
        assert!(gathering.is_overdue(begun + LIMIT));
        assert_eq!(gathering.take().len(), 1);
        assert!(!gathering.is_overdue(begun + LIMIT));
    }
}
