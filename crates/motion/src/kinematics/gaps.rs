//! How far apart the two ends of a joint are: segments that are tracked on their own are not rigidly linked.

use crate::{Connector, Frame};
use glam::DVec3;

/// The distance between the two ends of every joint in one sample, m.
///
/// `out` gets an entry for each joint of the frame's skeleton: `None` where a segment is not tracked or the skeleton does
/// not know the point.
pub fn joint_gaps(frame: &Frame, out: &mut Vec<Option<f64>>) {
    out.clear();
    let gaps = frame.subject.skeleton.joints.iter().map(|joint| {
        let parent = connector_position(frame, joint.parent)?;
        Some(parent.distance(connector_position(frame, joint.child)?))
    });
    out.extend(gaps);
}

fn connector_position(frame: &Frame, connector: Connector) -> Option<DVec3> {
    let segment = frame.subject.skeleton.segments.get(connector.segment)?;
    let point = segment.point(connector.point)?;
    Some(frame.pose(connector.segment)?.transform(point.offset))
}

/// The largest gap of every joint over the samples seen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LargestGaps {
    largest: Vec<Option<f64>>,
    gaps: Vec<Option<f64>>,
}

impl LargestGaps {
    /// Of no sample yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a sample into account. All samples must be of one skeleton.
    pub fn add(&mut self, frame: &Frame) {
        joint_gaps(frame, &mut self.gaps);
        self.largest.resize(self.gaps.len(), None);
        for (largest, gap) in self.largest.iter_mut().zip(&self.gaps) {
            *largest = match (*largest, *gap) {
                (Some(known), Some(new)) => Some(known.max(new)),
                (known, new) => known.or(new),
            };
        }
    }

    /// Per joint of the skeleton: the largest gap, m; `None` when no sample told.
    pub fn joints(&self) -> &[Option<f64>] {
        &self.largest
    }

    /// The joint with the largest gap of all, by its place in the skeleton, and that gap, m.
    pub fn worst(&self) -> Option<(usize, f64)> {
        let known = self.largest.iter().enumerate();
        known
            .filter_map(|(joint, gap)| Some((joint, (*gap)?)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, Skeleton, Subject};
    use std::sync::Arc;

    fn null_pose() -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        let segments = &frame.subject.skeleton.segments;
        frame.position = segments.iter().map(|segment| segment.origin).collect();
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame
    }

    #[test]
    fn a_hand_that_slips_off_opens_its_wrist_alone() {
        let mut frame = null_pose();
        frame.position[10] = frame.position[10].map(|wrist| wrist + DVec3::new(0.0, 0.03, 0.04));
        let mut gaps = Vec::new();
        joint_gaps(&frame, &mut gaps);
        assert!((gaps[9].unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(gaps.iter().flatten().filter(|&&gap| gap > 1e-9).count(), 1);
    }

    #[test]
    fn the_largest_gap_is_kept_and_unknown_ones_are_not_zero() {
        let mut largest = LargestGaps::new();
        let mut frame = null_pose();
        frame.position[20] = None;
        largest.add(&frame);
        assert_eq!(largest.joints()[19], None);
        frame.position[6] = frame.position[6].map(|head| head + DVec3::X * 0.02);
        largest.add(&frame);
        largest.add(&null_pose());
        assert!(largest.joints()[19].is_some());
        let (joint, gap) = largest.worst().unwrap();
        assert_eq!(joint, 5);
        assert!((gap - 0.02).abs() < 1e-12);
    }
}
