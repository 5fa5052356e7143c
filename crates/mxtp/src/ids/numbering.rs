//! What is unusual about the IDs of a datagram's records (MV0305 2.5.1, 2.5.9, 2.5.10).

use super::{
    ANATOMICAL_JOINTS, BODY_SEGMENTS, HAND_SEGMENTS, JOINTS, PointId, SegmentCounts, SegmentId, TRACKER_SEGMENTS,
};
use crate::{Quirk, Quirks};

/// What is unusual about the segment IDs of a whole sample, in the order they came; `None` when they
/// are 1, 2, 3 and so on, as they should be, or ascend with segments left out (MV0305 2.5.1).
///
/// With any of the four answers a segment is known by its position in the sample only. `counts` are
/// the header's, all 0 in Rev J.
#[inline]
pub(crate) fn numbering_quirk<I>(ids: &I, counts: SegmentCounts) -> Option<Quirk>
where
    I: ExactSizeIterator<Item = SegmentId> + Clone,
{
    if follows(ids.clone(), |position| position + 1) {
        return None;
    }
    unusual_numbering(ids, counts)
}

/// Like [`numbering_quirk`] for one part of a split sample, whose first ID is not known.
#[inline]
pub(crate) fn part_numbering_quirk<I>(ids: &I, counts: SegmentCounts) -> Option<Quirk>
where
    I: ExactSizeIterator<Item = SegmentId> + Clone,
{
    if ascends(ids.clone(), counts) {
        None
    } else if follows(ids.clone(), |position| position) {
        Some(Quirk::SegmentIdsFromZero)
    } else {
        Some(Quirk::SegmentIds)
    }
}

/// Quirks of the joint IDs of one type 20 datagram, which holds the whole message or a part of it.
pub(crate) fn joint_quirks<I>(pairs: I, whole: bool) -> Quirks
where
    I: ExactSizeIterator<Item = (PointId, PointId)>,
{
    let mut quirks = Quirks::NONE;
    quirks.insert_if(whole && pairs.len() == ANATOMICAL_JOINTS, Quirk::Joints22);
    for (position, pair) in pairs.enumerate() {
        let known = JOINTS.get(position) == Some(&pair) || JOINTS.contains(&pair);
        quirks.insert_if(!known, Quirk::JointId);
    }
    quirks
}

/// Whether a tracker can sit on this segment: one of the 17, or a prop.
pub(crate) fn carries_tracker(id: SegmentId) -> bool {
    TRACKER_SEGMENTS.contains(&id) || (24..=27).contains(&id.0)
}

#[inline]
fn follows(ids: impl Iterator<Item = SegmentId>, expected: impl Fn(u32) -> u32) -> bool {
    ids.zip(0..).all(|(id, position)| id.0 == expected(position))
}

/// Whether IDs that a character can have come in their order, with some left out perhaps.
#[inline]
fn ascends(ids: impl Iterator<Item = SegmentId>, counts: SegmentCounts) -> bool {
    let mut before = SegmentId(0);
    for id in ids {
        if id <= before {
            return false;
        }
        before = id;
    }
    before <= counts.last_id()
}

#[cold]
fn unusual_numbering<I>(ids: &I, counts: SegmentCounts) -> Option<Quirk>
where
    I: ExactSizeIterator<Item = SegmentId> + Clone,
{
    let body = u32::from(BODY_SEGMENTS);
    let fingers = finger_position(ids.len(), counts);
    let is = |expected: &dyn Fn(u32) -> u32| follows(ids.clone(), expected);
    let late_props = |p: u32| p + 1 + u32::from(p >= body);
    let late_props_only = |p: u32| p + 1 + u32::from(p >= body && p < fingers);
    let restart = |base: u32, period: u32| {
        move |p: u32| match p.checked_sub(fingers) {
            None => p + 1,
            Some(finger) => base + finger % period,
        }
    };
    let hand = u32::from(HAND_SEGMENTS);
    let known = counts.body > 0;
    if known && ascends(ids.clone(), counts) {
        None
    } else if is(&|p| p) {
        Some(Quirk::SegmentIdsFromZero)
    } else if is(&late_props) || is(&late_props_only) {
        Some(Quirk::PropIdsFrom25)
    } else if (0..2).any(|base| is(&restart(base, hand)) || is(&restart(base, 2 * hand))) {
        Some(Quirk::FingerIdsRestart)
    } else if !known && ascends(ids.clone(), counts) {
        None
    } else {
        Some(Quirk::SegmentIds)
    }
}

/// Where the first finger is in a sample of so many segments.
fn finger_position(items: usize, counts: SegmentCounts) -> u32 {
    let known = SegmentCounts::from_items(items).filter(|_| counts.body == 0);
    let props = known.unwrap_or(counts).props;
    u32::from(BODY_SEGMENTS) + u32::from(props)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quirk_of(ids: &[u32], counts: SegmentCounts) -> Option<Quirk> {
        numbering_quirk(&ids.iter().map(|id| SegmentId(*id)), counts)
    }

    #[test]
    fn usual_numbers_are_no_quirk() {
        let ids: Vec<u32> = (1..=23).collect();
        assert_eq!(quirk_of(&ids, SegmentCounts::BODY), None);
        let part = (12..=23).map(SegmentId).collect::<Vec<_>>();
        assert_eq!(part_numbering_quirk(&part.into_iter(), SegmentCounts::BODY), None);
    }

    #[test]
    fn segments_left_out_are_no_quirk() {
        let ids = [1, 2, 4, 23, 25];
        assert_eq!(quirk_of(&ids, SegmentCounts::new(2, false)), None);
        assert_eq!(quirk_of(&ids, SegmentCounts::default()), None);
        let backwards = [1, 4, 2];
        let unknown = Some(Quirk::SegmentIds);
        assert_eq!(quirk_of(&ids, SegmentCounts::BODY), unknown);
        assert_eq!(quirk_of(&backwards, SegmentCounts::BODY), unknown);
        assert_eq!(quirk_of(&[68], SegmentCounts::default()), unknown);
    }

    #[test]
    fn unusual_numbers_have_names() {
        let zero: Vec<u32> = (0..23).collect();
        let props: Vec<u32> = (1..=23).chain([25]).collect();
        let fingers: Vec<u32> = (1..=24).chain(0..20).chain(0..20).collect();
        let mixed: Vec<u32> = (1..=22).chain([90]).collect();
        let body = SegmentCounts::BODY;
        let with_props = SegmentCounts::new(1, false);
        assert_eq!(quirk_of(&zero, body), Some(Quirk::SegmentIdsFromZero));
        assert_eq!(quirk_of(&props, with_props), Some(Quirk::PropIdsFrom25));
        let restart = Some(Quirk::FingerIdsRestart);
        assert_eq!(quirk_of(&fingers, SegmentCounts::new(1, true)), restart);
        assert_eq!(quirk_of(&fingers, SegmentCounts::default()), restart);
        assert_eq!(quirk_of(&mixed, body), Some(Quirk::SegmentIds));
    }

    #[test]
    fn twenty_two_known_joints_are_one_quirk() {
        let all = joint_quirks(JOINTS.into_iter(), true);
        assert!(all.is_empty());
        let fewer = |whole| joint_quirks(JOINTS[..22].iter().copied(), whole);
        assert_eq!(fewer(true), Quirk::Joints22.into());
        assert_eq!(fewer(false), Quirks::NONE);
        let unknown = joint_quirks([(PointId(1), PointId(2))].into_iter(), true);
        assert_eq!(unknown, Quirk::JointId.into());
    }
}
