//! Type 20: joint and ergonomic angles (MV0305 2.7.1).

use super::convert::{angles, angles_to_wire};
use super::decode::slots;
use crate::body::JointAngles;
use crate::ids::{PointId, SegmentId};
use crate::{Quirk, Quirks};
use posewire_motion::{Connector, DVec3, Frame, Skeleton};

/// The two point IDs by which a joint is named.
pub(super) type Pair = (PointId, PointId);

/// The IDs of a skeleton's joints, then of its ergonomic angles: the order of the datagram.
pub(super) fn pairs(skeleton: &Skeleton) -> impl Iterator<Item = Pair> {
    let joints = skeleton
        .joints
        .iter()
        .map(|joint| (point(joint.parent), point(joint.child)));
    // An angle to the vertical is named as one to the pelvis.
    let ergonomic = skeleton.ergonomic_angles.iter();
    joints.chain(ergonomic.map(|angle| (segment(angle.parent.unwrap_or(0)), segment(angle.child))))
}

/// The records of a frame: the joints whose angles are known, and the ergonomic angles when all of them are.
///
/// Two ergonomic angles share their IDs, so they can be told apart only when none is left out.
pub(super) fn records(frame: &Frame, pairs: &[Pair]) -> impl Iterator<Item = JointAngles> {
    let (joints, ergonomic) = pairs.split_at(frame.joint_angles.len().min(pairs.len()));
    let complete =
        frame.ergonomic_angles.len() == ergonomic.len() && frame.ergonomic_angles.iter().all(Option::is_some);
    let ergonomic = if complete { ergonomic } else { &[] };
    let joints = joints.iter().zip(&frame.joint_angles);
    let all = joints.chain(ergonomic.iter().zip(&frame.ergonomic_angles));
    all.filter_map(|(pair, angles)| Some(record(*pair, (*angles)?)))
}

/// Writes the records into the frame: by position when all joints are there, else by their IDs.
pub(super) fn fill(frame: &mut Frame, items: &[JointAngles], first: Option<usize>) -> Quirks {
    let subject = frame.subject.clone();
    let skeleton = &subject.skeleton;
    let joints = skeleton.joints.len();
    let all = joints + skeleton.ergonomic_angles.len();
    let whole = first == Some(0) && (items.len() == joints || items.len() == all);
    let mut quirks = Quirks::NONE;
    let mut next = first.unwrap_or(0);
    for (position, item) in items.iter().enumerate() {
        let expected = first.map(|first| first + position);
        let place = if whole {
            expected
        } else {
            find(skeleton, item, next).or(expected)
        };
        let written = place.is_some_and(|place| write(frame, skeleton, place, angles(item.angles())));
        quirks.insert_if(!written, Quirk::JointId);
        next = place.map_or(next, |place| place + 1);
    }
    quirks
}

/// The place of the joint with the record's IDs, looked for from `from` on and then from the beginning.
fn find(skeleton: &Skeleton, item: &JointAngles, from: usize) -> Option<usize> {
    let matches = |(place, pair): (usize, Pair)| (pair == (item.parent(), item.child())).then_some(place);
    let mut later = pairs(skeleton).enumerate().skip(from).filter_map(matches);
    later.next().or_else(|| pairs(skeleton).enumerate().find_map(matches))
}

/// Whether the skeleton has the joint.
fn write(frame: &mut Frame, skeleton: &Skeleton, place: usize, value: DVec3) -> bool {
    let (joints, ergonomic) = (skeleton.joints.len(), skeleton.ergonomic_angles.len());
    let slot = match place.checked_sub(joints) {
        None => slots(&mut frame.joint_angles, joints).get_mut(place),
        Some(place) if place < ergonomic => slots(&mut frame.ergonomic_angles, ergonomic).get_mut(place),
        Some(_) => None,
    };
    slot.map(|slot| *slot = Some(value)).is_some()
}

fn record(pair: Pair, value: DVec3) -> JointAngles {
    JointAngles::new(pair.0, pair.1, angles_to_wire(value))
}

fn point(end: Connector) -> PointId {
    PointId(segment(end.segment).0.wrapping_add(end.point.into()))
}

/// The ID of a segment as a whole: local ID 0.
fn segment(place: usize) -> PointId {
    PointId::new(SegmentId(place as u32 + 1), 0)
}
