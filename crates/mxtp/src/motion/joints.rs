//! Type 20: joint and ergonomic angles (MV0305 2.7.1).

use super::convert::{angles, angles_to_wire};
use super::decode::slots;
use crate::body::JointAngles;
use crate::ids::{PointId, SegmentId};
use crate::{Quirk, Quirks};
use posewire_motion::{Connector, DVec3, Frame, SegmentKind, Skeleton};

/// The two point IDs by which a joint is named.
pub(super) type Pair = (PointId, PointId);

/// Which angle of a frame is sent, and the IDs that it is sent with.
#[derive(Clone, Copy, Debug)]
pub(super) struct SentAngle {
    place: Place,
    ids: Pair,
}

/// Where an angle stands in a frame.
#[derive(Clone, Copy, Debug)]
enum Place {
    Joint(usize),
    Ergonomic(usize),
}

/// The angles of a skeleton in the order of the datagram: the joints, then the ergonomic angles. Joints of the fingers
/// have none there.
pub(super) fn sent_angles(skeleton: &Skeleton) -> impl Iterator<Item = SentAngle> {
    let joints = skeleton.joints.iter().enumerate();
    let joints = joints.filter(|(_, joint)| !is_finger(skeleton, joint.child.segment));
    let joints = joints.map(|(place, joint)| SentAngle {
        place: Place::Joint(place),
        ids: (point(joint.parent), point(joint.child)),
    });
    let ergonomic = skeleton.ergonomic_angles.iter().enumerate();
    joints.chain(ergonomic.map(|(place, angle)| SentAngle {
        place: Place::Ergonomic(place),
        // An angle to the vertical is named as one to the pelvis.
        ids: (segment(angle.parent.unwrap_or(0)), segment(angle.child)),
    }))
}

/// The records of a frame: the joints whose angles are known, and the ergonomic angles when all of them are.
///
/// Two ergonomic angles share their IDs, so they can be told apart only when none is left out.
pub(super) fn records(frame: &Frame, sent: &[SentAngle]) -> impl Iterator<Item = JointAngles> {
    let ergonomic = &frame.ergonomic_angles;
    let all = ergonomic.len() == frame.subject.skeleton.ergonomic_angles.len();
    let complete = all && ergonomic.iter().all(Option::is_some);
    sent.iter().filter_map(move |sent| {
        let angles = match sent.place {
            Place::Joint(place) => frame.joint_angles.get(place),
            Place::Ergonomic(place) => ergonomic.get(place).filter(|_| complete),
        };
        Some(record(sent.ids, (*angles?)?))
    })
}

/// Writes the records into the frame: by position when all joints are there, else by their IDs.
pub(super) fn fill(frame: &mut Frame, items: &[JointAngles], first: Option<usize>) -> Quirks {
    let subject = frame.subject.clone();
    let skeleton = &subject.skeleton;
    let all = sent_angles(skeleton).count();
    let joints = all - skeleton.ergonomic_angles.len();
    let whole = first == Some(0) && (items.len() == joints || items.len() == all);
    if whole {
        for (sent, item) in sent_angles(skeleton).zip(items) {
            write(frame, skeleton, sent.place, angles(item.angles()));
        }
        return Quirks::NONE;
    }
    fill_by_ids(frame, skeleton, items, first)
}

/// Writes records of which some are missing: where their IDs say, or at their position when the IDs say nothing.
fn fill_by_ids(frame: &mut Frame, skeleton: &Skeleton, items: &[JointAngles], first: Option<usize>) -> Quirks {
    let mut quirks = Quirks::NONE;
    let mut next = first.unwrap_or(0);
    for (position, item) in items.iter().enumerate() {
        let expected = first.map(|first| first + position);
        let index = find(skeleton, item, next).or(expected);
        let sent = index.and_then(|index| sent_angles(skeleton).nth(index));
        if let Some(sent) = sent {
            write(frame, skeleton, sent.place, angles(item.angles()));
        }
        quirks.insert_if(sent.is_none(), Quirk::JointId);
        next = index.map_or(next, |index| index + 1);
    }
    quirks
}

/// The index of the angle with the record's IDs, looked for from `from` on and then from the beginning.
fn find(skeleton: &Skeleton, item: &JointAngles, from: usize) -> Option<usize> {
    let ids = (item.parent(), item.child());
    let matches = |(index, sent): (usize, SentAngle)| (sent.ids == ids).then_some(index);
    let mut later = sent_angles(skeleton).enumerate().skip(from).filter_map(matches);
    later
        .next()
        .or_else(|| sent_angles(skeleton).enumerate().find_map(matches))
}

fn write(frame: &mut Frame, skeleton: &Skeleton, place: Place, value: DVec3) {
    let slot = match place {
        Place::Joint(place) => slots(&mut frame.joint_angles, skeleton.joints.len()).get_mut(place),
        Place::Ergonomic(place) => slots(&mut frame.ergonomic_angles, skeleton.ergonomic_angles.len()).get_mut(place),
    };
    if let Some(slot) = slot {
        *slot = Some(value);
    }
}

pub(super) fn is_finger(skeleton: &Skeleton, place: usize) -> bool {
    let kind = skeleton.segments.get(place).map(|segment| segment.kind);
    matches!(kind, Some(SegmentKind::LeftFinger | SegmentKind::RightFinger))
}

fn record((parent, child): Pair, value: DVec3) -> JointAngles {
    JointAngles::new(parent, child, angles_to_wire(value))
}

fn point(end: Connector) -> PointId {
    PointId(segment(end.segment).0.wrapping_add(end.point.into()))
}

/// The ID of a segment as a whole: local ID 0.
fn segment(place: usize) -> PointId {
    PointId::new(SegmentId(place as u32 + 1), 0)
}
