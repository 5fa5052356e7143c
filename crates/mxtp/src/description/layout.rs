//! How many segments a character has, and the skeleton that follows from it.

use crate::ids::{BODY_SEGMENTS, HAND_SEGMENTS, SegmentCounts};
use crate::motion::MessageTypes;
use crate::{Header, MessageType};
use posewire_motion::standard::MAX_PROPS;
use posewire_motion::{Segment, SegmentKind, Skeleton};

/// Segment counts as the header has them, and the number of segments in all, which may be greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    counts: SegmentCounts,
    total: usize,
}

impl Layout {
    /// The header's counts, or in Rev J what a pose of `segments` consists of; a full body when both say nothing. Where a
    /// pose has more segments than the header counts, the pose is believed.
    #[inline]
    pub(super) fn new(header: SegmentCounts, segments: usize) -> Self {
        let counts = match (header.body, segments) {
            (0, 0) => SegmentCounts::BODY,
            (0, _) => SegmentCounts::from_items(segments).unwrap_or(SegmentCounts::BODY),
            _ => header,
        };
        Self {
            counts,
            total: counts.total().max(segments),
        }
    }

    /// The skeleton with the usual names. Sizes are left out: the nominal ones are not the person's.
    ///
    /// A character of less than 23 body segments is a tracked object, whose segments have no usual names and no joints.
    pub(super) fn skeleton(self) -> Skeleton {
        let mut skeleton = if self.counts.body < BODY_SEGMENTS {
            Skeleton::default()
        } else {
            let fingers = self.counts.fingers == 2 * HAND_SEGMENTS;
            Skeleton::standard(MAX_PROPS.min(self.counts.props.into()), fingers)
        };
        for segment in &mut skeleton.segments {
            segment.origin = None;
            segment.points.clear();
        }
        for number in skeleton.segments.len() + 1..=self.total {
            let name = format!("Segment{number}");
            skeleton.segments.push(Segment::new(name, SegmentKind::Body));
        }
        skeleton
    }
}

/// How many segments the poses of a stream have, by the best type of pose in it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PoseCount {
    best: Option<MessageType>,
    segments: usize,
    /// What the header of that pose counted.
    counts: SegmentCounts,
}

impl PoseCount {
    /// A worse type counts only when the best one is no longer `live`: Unity poses lack props and fingers.
    #[inline]
    pub(super) fn note(&mut self, header: &Header, segments: usize, live: MessageTypes) {
        let better = |best| rank(header.message_type) <= rank(best) || !live.contains(best);
        if segments > 0 && self.best.is_none_or(better) {
            self.best = Some(header.message_type);
            self.segments = segments.min(MAX_SEGMENTS);
            self.counts = header.segment_counts();
        }
    }

    /// 0 when no pose has come since headers count so.
    #[inline]
    pub(super) fn segments(&self, counts: SegmentCounts) -> usize {
        if self.counts == counts { self.segments } else { 0 }
    }
}

fn rank(message_type: MessageType) -> u8 {
    match message_type {
        MessageType::QUATERNION => 0,
        MessageType::LINEAR => 1,
        MessageType::ANGULAR => 2,
        MessageType::EULER => 3,
        _ => 4,
    }
}

/// More than any character has; a datagram could claim thousands.
const MAX_SEGMENTS: usize = 255;

#[cfg(test)]
mod tests {
    use super::*;

    fn names(header: SegmentCounts, segments: usize) -> Vec<String> {
        let skeleton = Layout::new(header, segments).skeleton();
        skeleton.segments.into_iter().map(|segment| segment.name).collect()
    }

    #[test]
    fn an_old_header_leaves_it_to_the_pose() {
        let old = SegmentCounts::default();
        assert_eq!(names(old, 0).len(), 23);
        assert_eq!(names(old, 2), ["Segment1", "Segment2"]);
        assert_eq!(names(old, 64)[23..25], ["Prop1Generic", "LeftCarpus"]);
        assert_eq!(names(old, 30)[29], "Segment30");
    }

    #[test]
    fn a_pose_with_more_segments_than_the_header_counts_is_believed() {
        assert_eq!(names(SegmentCounts::BODY, 24)[23], "Segment24");
        assert_eq!(names(SegmentCounts::BODY, 20).len(), 23);
    }

    #[test]
    fn no_counts_are_too_odd() {
        for counts in [[255; 3], [23, 9, 7], [23, 0, 39], [1, 0, 40], [0, 4, 40]] {
            let [body, props, fingers] = counts;
            let layout = Layout::new(SegmentCounts { body, props, fingers }, 0);
            assert_eq!(layout.skeleton().segments.len(), layout.total);
        }
    }

    #[test]
    fn a_worse_type_counts_only_when_the_better_is_gone() {
        let mut poses = PoseCount::default();
        let live = MessageTypes::NONE.with(MessageType::QUATERNION);
        let old = SegmentCounts::default();
        let mut note = |message_type, segments, live| {
            poses.note(&Header::rev_j(message_type, 0, 0), segments, live);
            poses.segments(old)
        };
        assert_eq!(note(MessageType::UNITY, 23, live), 23);
        assert_eq!(note(MessageType::QUATERNION, 63, live), 63);
        assert_eq!(note(MessageType::UNITY, 23, live), 63);
        assert_eq!(note(MessageType::UNITY, 23, MessageTypes::NONE), 23);
        assert_eq!(poses.segments(SegmentCounts::BODY), 0);
    }
}
