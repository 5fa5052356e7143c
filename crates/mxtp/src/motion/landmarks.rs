//! Type 03: points on the body that stand for optical markers (MV0305 2.5.4).

use super::convert::{EULER_SPACE, vector_to_wire};
use crate::body::PointPosition;
use crate::ids::{PointId, SegmentId};
use posewire_motion::{DVec3, Frame, Marker, Skeleton};

/// The points that are sent as markers when a frame has none of its own: the segment's name and the point's.
///
/// The vendor's marker sets are not public; these are the landmarks on which a marker is usually worn. They are fewer
/// where a skeleton lacks some.
pub const LANDMARKS: [(&str, &str); 44] = [
    ("Pelvis", "pRightASI"),
    ("Pelvis", "pLeftASI"),
    ("Pelvis", "pRightSIPS"),
    ("Pelvis", "pLeftSIPS"),
    ("T8", "pC7SpinalProcess"),
    ("T8", "pPX"),
    ("T8", "pIJ"),
    ("T8", "pT8SpinalProcess"),
    ("Head", "pTopOfHead"),
    ("Head", "pRightAuricularis"),
    ("Head", "pLeftAuricularis"),
    ("Head", "pBackOfHead"),
    ("RightShoulder", "pRightAcromion"),
    ("RightUpperArm", "pRightArmLatEpicondyle"),
    ("RightUpperArm", "pRightArmMedEpicondyle"),
    ("RightForeArm", "pRightUlnarStyloid"),
    ("RightForeArm", "pRightRadialStyloid"),
    ("RightHand", "pRightPinky"),
    ("RightHand", "pRightBallHand"),
    ("LeftShoulder", "pLeftAcromion"),
    ("LeftUpperArm", "pLeftArmLatEpicondyle"),
    ("LeftUpperArm", "pLeftArmMedEpicondyle"),
    ("LeftForeArm", "pLeftUlnarStyloid"),
    ("LeftForeArm", "pLeftRadialStyloid"),
    ("LeftHand", "pLeftPinky"),
    ("LeftHand", "pLeftBallHand"),
    ("RightUpperLeg", "pRightGreaterTrochanter"),
    ("RightUpperLeg", "pRightKneeLatEpicondyle"),
    ("RightUpperLeg", "pRightKneeMedEpicondyle"),
    ("RightLowerLeg", "pRightTibialTub"),
    ("RightLowerLeg", "pRightLatMalleolus"),
    ("RightLowerLeg", "pRightMedMalleolus"),
    ("RightFoot", "pRightHeelFoot"),
    ("RightFoot", "pRightFifthMetatarsal"),
    ("RightToe", "pRightToe"),
    ("LeftUpperLeg", "pLeftGreaterTrochanter"),
    ("LeftUpperLeg", "pLeftKneeLatEpicondyle"),
    ("LeftUpperLeg", "pLeftKneeMedEpicondyle"),
    ("LeftLowerLeg", "pLeftTibialTub"),
    ("LeftLowerLeg", "pLeftLatMalleolus"),
    ("LeftLowerLeg", "pLeftMedMalleolus"),
    ("LeftFoot", "pLeftHeelFoot"),
    ("LeftFoot", "pLeftFifthMetatarsal"),
    ("LeftToe", "pLeftToe"),
];

/// A landmark of a skeleton.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landmark {
    segment: usize,
    id: PointId,
    offset: DVec3,
}

/// The landmarks that a skeleton has, in the order of [`LANDMARKS`].
pub(super) fn landmarks(skeleton: &Skeleton) -> impl Iterator<Item = Landmark> {
    LANDMARKS.into_iter().filter_map(|(segment, name)| {
        let segment = skeleton.segment(segment)?;
        let point = skeleton.segments[segment]
            .points
            .iter()
            .find(|point| point.name == name)?;
        let local = u8::try_from(point.id).ok()?;
        Some(Landmark {
            segment,
            id: PointId::new(SegmentId(segment as u32 + 1), local),
            offset: point.offset,
        })
    })
}

/// The landmarks whose segments are tracked.
pub(super) fn landmark_records(frame: &Frame, landmarks: &[Landmark]) -> impl Iterator<Item = PointPosition> {
    landmarks.iter().filter_map(|landmark| {
        let position = frame.pose(landmark.segment)?.transform(landmark.offset);
        Some(record(landmark.id, position))
    })
}

/// The markers of a frame that were seen.
pub(super) fn marker_records(markers: &[Marker]) -> impl Iterator<Item = PointPosition> {
    let seen = |marker: &Marker| Some(record(PointId(marker.id), marker.position?));
    markers.iter().filter_map(seen)
}

fn record(id: PointId, position: DVec3) -> PointPosition {
    PointPosition::new(id, vector_to_wire(EULER_SPACE.position_from_canonical(position)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nominal_skeleton_has_every_landmark() {
        let skeleton = Skeleton::standard(0, false);
        assert_eq!(landmarks(&skeleton).count(), LANDMARKS.len());
    }
}
