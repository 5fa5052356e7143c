//! Type 05: poses relative to the parent, in the order and axes of Unity (MV0305 2.5.5).

use super::convert::{UNITY_SPACE, quaternion, quaternion_to_wire, vector, vector_to_wire};
use super::place::Places;
use crate::body::UnitySegment;
use crate::ids::SegmentId;
use posewire_motion::standard::{BODY_SEGMENTS, MAX_PROPS, UNITY_ORDER};
use posewire_motion::{Frame, Pose};

/// Segments that a datagram of type 05 can hold: the body's, and the props that Rev N speaks of.
const MOST: usize = BODY_SEGMENTS.len() + MAX_PROPS;

/// Poses by the place of the segment in the usual order; `None` for those not told.
pub(super) type Poses = [Option<Pose>; MOST];

/// The poses of a datagram in the world.
///
/// A parent that the datagram does not hold is looked for in the frame, where an earlier part has put it.
pub(super) fn global_poses(frame: &Frame, items: &[UnitySegment], places: Places) -> Poses {
    let mut local = Poses::default();
    for (position, item) in items.iter().enumerate() {
        let place = places.of(position, item.id()).and_then(usual_place);
        if let Some(slot) = place.and_then(|place| local.get_mut(place)) {
            *slot = Some(canonical(item));
        }
    }
    compose(frame, &local)
}

/// Writes one value of each pose that is known.
pub(super) fn write<V>(slots: &mut [Option<V>], poses: &Poses, value: impl Fn(&Pose) -> V) {
    for (slot, pose) in slots.iter_mut().zip(poses) {
        if let Some(pose) = pose {
            *slot = Some(value(pose));
        }
    }
}

/// The records of a frame. A segment that is not tracked, or whose parent is not, is left out.
pub(super) fn records(frame: &Frame) -> impl Iterator<Item = UnitySegment> {
    UNITY_ORDER.into_iter().zip(1..).filter_map(|(place, id)| {
        let pose = frame.pose(place)?;
        let local = match BODY_SEGMENTS[place].parent {
            Some(parent) => pose.relative_to(frame.pose(parent)?),
            None => pose,
        };
        Some(record(SegmentId(id), local))
    })
}

/// Parents come before their children in the usual order.
fn compose(frame: &Frame, local: &Poses) -> Poses {
    let mut poses = *local;
    for (place, segment) in BODY_SEGMENTS.iter().enumerate() {
        if let (Some(pose), Some(parent)) = (local[place], segment.parent) {
            let parent = poses[parent].or_else(|| frame.pose(parent));
            poses[place] = parent.map(|parent| parent.compose(pose));
        }
    }
    poses
}

/// The place of the segment that stands at `index` in the order of Unity; props keep theirs.
fn usual_place(index: usize) -> Option<usize> {
    match UNITY_ORDER.get(index) {
        Some(place) => Some(*place),
        None => (index < MOST).then_some(index),
    }
}

fn canonical(item: &UnitySegment) -> Pose {
    Pose::new(
        UNITY_SPACE.position_to_canonical(vector(item.position())),
        UNITY_SPACE.orientation_to_canonical(quaternion(item.orientation())),
    )
}

fn record(id: SegmentId, pose: Pose) -> UnitySegment {
    UnitySegment::new(
        id,
        vector_to_wire(UNITY_SPACE.position_from_canonical(pose.position)),
        quaternion_to_wire(UNITY_SPACE.orientation_from_canonical(pose.orientation)),
    )
}
