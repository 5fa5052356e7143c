//! Which segment of the skeleton a record is about.

use crate::Quirk;
use crate::ids::{SegmentCounts, SegmentId, numbering_quirk};

/// How the records of a datagram go to the places of a skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Places {
    /// One after the other from this place on.
    InOrder(usize),
    /// By segment ID less this number.
    ById(u32),
}

impl Places {
    /// The place of the record at `position` in the datagram.
    #[inline]
    pub(super) fn of(self, position: usize, id: SegmentId) -> Option<usize> {
        match self {
            Self::InOrder(first) => first.checked_add(position),
            Self::ById(less) => usize::try_from(id.0.checked_sub(less)?).ok(),
        }
    }
}

/// Where the records of a datagram belong in a skeleton of so many segments.
///
/// `first` is the number of records in the parts of the message that come before; `None` when some of these were lost.
/// IDs count as long as they can be right, so that a sender can leave out what it does not track; else the position does,
/// and the quirk says so.
#[inline]
pub(super) fn places<I>(
    ids: &I,
    first: Option<usize>,
    segments: usize,
    counts: SegmentCounts,
) -> (Places, Option<Quirk>)
where
    I: ExactSizeIterator<Item = SegmentId> + Clone,
{
    match first {
        Some(first) if follow(ids.clone(), first, 1) && first + ids.len() <= segments => (Places::InOrder(first), None),
        _ => unusual_places(ids, first, segments, counts),
    }
}

#[cold]
fn unusual_places<I>(ids: &I, first: Option<usize>, segments: usize, counts: SegmentCounts) -> (Places, Option<Quirk>)
where
    I: ExactSizeIterator<Item = SegmentId> + Clone,
{
    let from_zero = Some(Quirk::SegmentIdsFromZero);
    let later_part = first.is_some_and(|first| first > 0);
    if later_part && follow(ids.clone(), first.unwrap_or(0), 0) {
        return (Places::ById(0), from_zero);
    }
    if distinct(ids.clone(), 1, segments) {
        return (Places::ById(1), None);
    }
    if distinct(ids.clone(), 0, segments) {
        return (Places::ById(0), from_zero);
    }
    match (first, numbering_quirk(ids, counts)) {
        (Some(0), Some(quirk)) => (Places::InOrder(0), Some(quirk)),
        (Some(first), Some(_)) => (Places::InOrder(first), Some(Quirk::SegmentIds)),
        // They ascend as they should, but past the skeleton's end.
        (_, None) | (None, _) => (Places::ById(1), Some(Quirk::SegmentIds)),
    }
}

/// Whether the IDs go up one by one from `first + base`.
#[inline]
fn follow(mut ids: impl Iterator<Item = SegmentId>, first: usize, base: u32) -> bool {
    let Ok(first) = u32::try_from(first) else {
        return false;
    };
    let mut expected = first.wrapping_add(base);
    ids.all(|id| {
        let right = id.0 == expected;
        expected = expected.wrapping_add(1);
        right
    })
}

/// Whether no ID comes twice and all of them are among the `segments` from `base` on. 256 IDs are the most there can be.
fn distinct(mut ids: impl Iterator<Item = SegmentId>, base: u32, segments: usize) -> bool {
    let mut seen = [0_u64; 4];
    ids.all(|SegmentId(id)| {
        let place = id.checked_sub(base).map_or(usize::MAX, |place| place as usize);
        let Some(word) = seen.get_mut(place / 64).filter(|_| place < segments) else {
            return false;
        };
        let bit = 1 << (place % 64);
        let new = *word & bit == 0;
        *word |= bit;
        new
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place_all(ids: &[u32], first: Option<usize>, segments: usize) -> (Vec<Option<usize>>, Option<Quirk>) {
        let counts = SegmentCounts::from_items(segments).unwrap_or_default();
        let ids: Vec<_> = ids.iter().copied().map(SegmentId).collect();
        let (places, quirk) = places(&ids.iter().copied(), first, segments, counts);
        let found = ids.iter().enumerate().map(|(position, id)| places.of(position, *id));
        (found.collect(), quirk)
    }

    fn in_order(range: std::ops::Range<usize>) -> Vec<Option<usize>> {
        range.map(Some).collect()
    }

    #[test]
    fn usual_ids_go_in_order() {
        let ids: Vec<_> = (1..=23).collect();
        assert_eq!(place_all(&ids, Some(0), 23), (in_order(0..23), None));
        assert_eq!(place_all(&ids[12..], Some(12), 23), (in_order(12..23), None));
    }

    #[test]
    fn ids_tell_what_is_left_out() {
        let expected = vec![Some(0), Some(3), Some(22)];
        assert_eq!(place_all(&[1, 4, 23], Some(0), 23), (expected.clone(), None));
        assert_eq!(place_all(&[1, 4, 23], None, 23), (expected, None));
    }

    #[test]
    fn ids_from_zero_are_shifted() {
        let ids: Vec<_> = (0..23).collect();
        let quirk = Some(Quirk::SegmentIdsFromZero);
        assert_eq!(place_all(&ids, Some(0), 23), (in_order(0..23), quirk));
        assert_eq!(place_all(&ids[12..], Some(12), 23), (in_order(12..23), quirk));
    }

    #[test]
    fn ids_that_cannot_be_right_give_way_to_the_position() {
        let props: Vec<_> = (1..=23).chain([25, 26]).collect();
        let quirk = Some(Quirk::PropIdsFrom25);
        assert_eq!(place_all(&props, Some(0), 25), (in_order(0..25), quirk));
        let fingers: Vec<_> = (1..=23).chain(0..20).chain(0..20).collect();
        let quirk = Some(Quirk::FingerIdsRestart);
        assert_eq!(place_all(&fingers, Some(0), 63), (in_order(0..63), quirk));
        let quirk = Some(Quirk::SegmentIds);
        assert_eq!(place_all(&[7, 7, u32::MAX], Some(0), 23), (in_order(0..3), quirk));
    }

    #[test]
    fn a_lost_part_leaves_only_the_ids() {
        let (places, quirk) = place_all(&[22, 23, 900], None, 23);
        assert_eq!(places[..2], [Some(21), Some(22)]);
        assert_eq!(quirk, Some(Quirk::SegmentIds));
    }

    #[test]
    fn more_records_than_segments_are_a_quirk() {
        let ids: Vec<_> = (1..=24).collect();
        assert_eq!(place_all(&ids, Some(0), 23), (in_order(0..24), Some(Quirk::SegmentIds)));
        let with_a_prop = [1, 2, 24].map(SegmentId).into_iter();
        let found = places(&with_a_prop, Some(0), 23, SegmentCounts::new(1, false));
        assert_eq!(found, (Places::ById(1), Some(Quirk::SegmentIds)));
    }
}
