//! IP packets that the network cut into pieces, put together again.

use posewire_motion::Stamp;
use std::collections::{BTreeMap, VecDeque};
use std::net::IpAddr;
use std::ops::Range;
use std::time::Duration;

/// The packet that a piece is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Identity {
    pub(super) from: IpAddr,
    pub(super) to: IpAddr,
    pub(super) protocol: u8,
    pub(super) number: u32,
}

/// Where a piece belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fragment {
    pub(super) of: Identity,
    /// Bytes before it.
    pub(super) at: usize,
    pub(super) is_last: bool,
}

/// Pieces that wait for the others of their packet.
///
/// Pieces may come in any order and more than once; of bytes that come twice, the first are kept. A packet that lacks a piece
/// is given up after [`PATIENCE`], as systems do, or when too many packets wait. A piece that comes again when its packet is
/// whole is no other packet.
#[derive(Debug, Default)]
pub(super) struct Fragments {
    waiting: BTreeMap<Identity, Waiting>,
    /// The last packets that were whole.
    whole: VecDeque<(Identity, Vec<u8>)>,
    given_up: u64,
}

#[derive(Debug)]
struct Waiting {
    since: Stamp,
    bytes: Vec<u8>,
    /// What of `bytes` is there, in order, none touching another.
    there: Vec<Range<usize>>,
    length: Option<usize>,
}

impl Fragments {
    /// Takes a piece that was captured at `now`. Gives the packet's content when it is the last one missing.
    pub(super) fn take(&mut self, now: Stamp, fragment: Fragment, bytes: &[u8]) -> Option<Vec<u8>> {
        self.give_up_old(now);
        if self.is_repeated(fragment, bytes) {
            return None;
        }
        let waiting = self.waiting.entry(fragment.of).or_insert_with(|| Waiting::new(now));
        if !waiting.add(fragment, bytes) {
            self.give_up(fragment.of);
            return None;
        }
        if !waiting.is_complete() {
            return None;
        }
        let whole = self.waiting.remove(&fragment.of)?.bytes;
        if self.whole.len() == MAX_WHOLE {
            self.whole.pop_front();
        }
        self.whole.push_back((fragment.of, whole.clone()));
        Some(whole)
    }

    /// Whether a packet that is whole has this piece. Another one may have its number, and then other bytes.
    fn is_repeated(&self, fragment: Fragment, piece: &[u8]) -> bool {
        let end = fragment.at.saturating_add(piece.len());
        let has_piece = |whole: &[u8]| {
            let is_last = end == whole.len();
            is_last == fragment.is_last && whole.get(fragment.at..end) == Some(piece)
        };
        let of_number = |(of, _): &&(Identity, Vec<u8>)| *of == fragment.of;
        !self.waiting.contains_key(&fragment.of)
            && self.whole.iter().filter(of_number).any(|(_, whole)| has_piece(whole))
    }

    /// Packets that were given up for want of a piece; at the end, what still waits is lost too.
    pub(super) fn given_up(&self) -> u64 {
        self.given_up
    }

    /// Packets that still lack a piece.
    pub(super) fn waiting(&self) -> u64 {
        self.waiting.len() as u64
    }

    fn give_up(&mut self, packet: Identity) {
        self.waiting.remove(&packet);
        self.given_up += 1;
    }

    fn give_up_old(&mut self, now: Stamp) {
        let before = self.waiting.len();
        self.waiting.retain(|_, packet| now.since(packet.since) < PATIENCE);
        self.given_up += (before - self.waiting.len()) as u64;
        if self.waiting.len() >= MAX_WAITING {
            let oldest = self.waiting.iter().min_by_key(|(_, packet)| packet.since);
            if let Some(oldest) = oldest.map(|(packet, _)| *packet) {
                self.give_up(oldest);
            }
        }
    }
}

impl Waiting {
    fn new(since: Stamp) -> Self {
        Self {
            since,
            bytes: Vec::new(),
            there: Vec::new(),
            length: None,
        }
    }

    /// Adds a piece; `false` when it cannot be of this packet.
    fn add(&mut self, fragment: Fragment, piece: &[u8]) -> bool {
        let end = fragment.at.saturating_add(piece.len());
        let ends_elsewhere = self
            .length
            .is_some_and(|length| end > length || fragment.is_last && end != length);
        if end > MAX_LENGTH || ends_elsewhere || fragment.is_last && self.bytes.len() > end {
            return false;
        }
        if fragment.is_last {
            self.length = Some(end);
        }
        if self.bytes.len() < end {
            self.bytes.resize(end, 0);
        }
        for gap in self.gaps(fragment.at..end) {
            let from = gap.start - fragment.at..gap.end - fragment.at;
            if let (Some(to), Some(from)) = (self.bytes.get_mut(gap), piece.get(from)) {
                to.copy_from_slice(from);
            }
        }
        self.note(fragment.at..end);
        true
    }

    /// What of a range is not there yet.
    fn gaps(&self, wanted: Range<usize>) -> Vec<Range<usize>> {
        let mut gaps = Vec::new();
        let mut at = wanted.start;
        for there in &self.there {
            if there.start > at && at < wanted.end {
                gaps.push(at..there.start.min(wanted.end));
            }
            at = at.max(there.end);
        }
        if at < wanted.end {
            gaps.push(at..wanted.end);
        }
        gaps
    }

    fn note(&mut self, mut new: Range<usize>) {
        self.there.retain(|there| {
            let touches = there.start <= new.end && new.start <= there.end;
            if touches {
                new = there.start.min(new.start)..there.end.max(new.end);
            }
            !touches
        });
        let place = self.there.partition_point(|there| there.start < new.start);
        self.there.insert(place, new);
    }

    fn is_complete(&self) -> bool {
        let whole = self.length.map(|length| 0..length);
        whole.is_some_and(|whole| self.there.first() == Some(&whole))
    }
}

/// What the length field of an IP packet can say.
const MAX_LENGTH: usize = 65_535;
/// As long as Linux waits.
const PATIENCE: Duration = Duration::from_secs(30);
/// With the longest packets, 16 MiB.
const MAX_WAITING: usize = 256;
/// With the longest packets, 4 MiB. A piece that comes again does so soon.
const MAX_WHOLE: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;

    fn fragment(at: usize, is_last: bool) -> Fragment {
        let of = Identity {
            from: [10, 0, 0, 1].into(),
            to: [10, 0, 0, 2].into(),
            protocol: 17,
            number: 7,
        };
        Fragment { of, at, is_last }
    }

    const PACKET: &[u8] = b"0123456789abcdefghijklmnopqrst";

    /// What comes out when these pieces come one after the other.
    fn taken(pieces: &[Range<usize>]) -> Option<Vec<u8>> {
        let mut fragments = Fragments::default();
        let mut whole = None;
        for piece in pieces {
            let fragment = fragment(piece.start, piece.end == PACKET.len());
            whole = whole.or(fragments.take(Stamp(0), fragment, &PACKET[piece.clone()]));
        }
        whole
    }

    #[test]
    fn pieces_are_put_together_in_whatever_order_they_come() {
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let pieces = order.map(|piece| [0..8, 8..16, 16..30][piece].clone());
            assert_eq!(taken(&pieces).as_deref(), Some(PACKET), "{order:?}");
        }
    }

    #[test]
    fn pieces_that_overlap_or_come_twice_do_no_harm() {
        assert_eq!(taken(&[8..24, 8..24, 0..16, 16..30]).as_deref(), Some(PACKET));
        assert_eq!(taken(&[0..8, 0..8, 16..30]), None);
    }

    #[test]
    fn a_piece_that_comes_again_when_its_packet_is_whole_is_no_other_packet() {
        let mut fragments = Fragments::default();
        let take = |fragments: &mut Fragments, at: usize, bytes: &[u8]| {
            fragments.take(Stamp(0), fragment(at, at == 8), bytes).is_some()
        };
        assert!(!take(&mut fragments, 0, b"AAAAAAAA") && take(&mut fragments, 8, b"B"));
        assert!(!take(&mut fragments, 8, b"B") && !take(&mut fragments, 0, b"AAAAAAAA"));
        assert_eq!((fragments.given_up(), fragments.waiting()), (0, 0));
        // Another packet may begin with other bytes, and end as the one before.
        assert!(!take(&mut fragments, 0, b"CCCCCCCC") && take(&mut fragments, 8, b"B"));
        assert_eq!((fragments.given_up(), fragments.waiting()), (0, 0));
    }

    #[test]
    fn of_bytes_that_come_twice_the_first_are_kept() {
        let mut fragments = Fragments::default();
        assert_eq!(fragments.take(Stamp(0), fragment(8, false), b"BBBBBBBB"), None);
        assert_eq!(fragments.take(Stamp(0), fragment(0, false), b"AAAAAAAAxxxxxxxx"), None);
        let whole = fragments.take(Stamp(0), fragment(16, true), b"C");
        assert_eq!(whole.as_deref(), Some(&b"AAAAAAAABBBBBBBBC"[..]));
    }

    #[test]
    fn a_packet_that_lacks_a_piece_is_given_up_in_time() {
        let mut fragments = Fragments::default();
        assert_eq!(fragments.take(Stamp(0), fragment(0, false), b"AAAAAAAA"), None);
        let later = Stamp(0).after(PATIENCE);
        assert_eq!(fragments.take(later, fragment(8, true), b"B"), None);
        assert_eq!((fragments.given_up(), fragments.waiting()), (1, 1));
    }

    #[test]
    fn what_cannot_be_a_packet_is_given_up() {
        let mut fragments = Fragments::default();
        assert_eq!(fragments.take(Stamp(0), fragment(65_528, false), &[0; 8]), None);
        assert_eq!(fragments.take(Stamp(0), fragment(8, true), b"B"), None);
        assert_eq!(fragments.take(Stamp(0), fragment(16, false), &[0; 8]), None);
        assert_eq!((fragments.given_up(), fragments.waiting()), (2, 0));
    }

    #[test]
    fn only_so_many_packets_wait() {
        let mut fragments = Fragments::default();
        for number in 0..1000 {
            let mut piece = fragment(0, false);
            piece.of.number = number;
            fragments.take(Stamp(number.into()), piece, b"AAAAAAAA");
        }
        assert_eq!(fragments.waiting(), MAX_WAITING as u64);
        assert_eq!(fragments.given_up(), 1000 - MAX_WAITING as u64);
    }
}
