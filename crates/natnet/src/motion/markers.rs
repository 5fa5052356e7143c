//! Markers and whether they were seen.

use super::Settings;
use crate::frame::{Frame, LabeledMarker, MarkerParams, RigidBody};
use posewire_motion::Marker;

/// Added to the place of a marker that has no ID on the wire (2.x: the "other markers"), so that its number is not that
/// of another marker.
pub const OTHER_MARKERS: u32 = 1 << 31;

/// A marker of an asset, under its number within the asset.
pub(super) fn member_marker(settings: &Settings, marker: &LabeledMarker) -> Marker {
    Marker {
        id: marker.member_id() as u32,
        ..labeled_marker(settings, marker)
    }
}

/// A marker under the whole of its ID.
pub(super) fn labeled_marker(settings: &Settings, marker: &LabeledMarker) -> Marker {
    let seen = !is_occluded(marker) && is_position(marker.position, marker.params.is_some());
    Marker {
        id: marker.id as u32,
        position: seen.then(|| settings.position_in(marker.position)),
    }
}

/// The markers of a body, for frames of versions that have no labeled markers.
pub(super) fn body_markers(settings: &Settings, body: &RigidBody) -> impl Iterator<Item = Marker> {
    body.markers.iter().enumerate().map(|(place, marker)| Marker {
        id: marker.id.map_or(place as u32 + 1, |id| (id & 0xFFFF) as u32),
        position: is_position(marker.position, false).then(|| settings.position_in(marker.position)),
    })
}

/// The markers without a label that the labeled markers do not hold as well.
pub(super) fn other_markers(settings: &Settings, frame: &Frame) -> impl Iterator<Item = Marker> {
    let superseded = frame.labeled_markers.iter().any(is_unlabeled);
    let positions = if superseded { &[] } else { &frame.other_markers[..] };
    positions.iter().enumerate().map(|(place, &position)| Marker {
        id: OTHER_MARKERS | place as u32,
        position: is_position(position, true).then(|| settings.position_in(position)),
    })
}

/// Whether the server says that the marker has no label: by a bit or, in older ones, by the number of a point without an
/// asset.
pub(super) fn is_unlabeled(marker: &LabeledMarker) -> bool {
    let loose = |params: MarkerParams| params.contains(MarkerParams::UNLABELED);
    marker.params.is_some_and(loose) || (marker.params.is_some() && marker.id >= POINT_CLOUD && marker.asset_id() == 0)
}

/// Whether position values are a place. A server that tells of lost tracking in no other way sends zeros.
pub(super) fn is_position(position: [f32; 3], zero_is_place: bool) -> bool {
    position.iter().all(|value| value.is_finite()) && (zero_is_place || position.iter().any(|&value| value != 0.0))
}

/// The bit alone cannot be trusted: a marker that was triangulated or filled in has a place all the same.
fn is_occluded(marker: &LabeledMarker) -> bool {
    let params = marker.params.unwrap_or_default();
    params.contains(MarkerParams::OCCLUDED)
        && !params.contains(MarkerParams::POINT_CLOUD_SOLVED)
        && !params.contains(MarkerParams::MODEL_FILLED)
}

/// Motive numbers markers without a label from here.
const POINT_CLOUD: i32 = 50_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_occluded_marker_has_a_place_only_when_it_was_filled_in() {
        let place = |params| {
            let marker = LabeledMarker {
                id: 5 << 16 | 3,
                position: [1.0, 2.0, 3.0],
                params,
                ..LabeledMarker::default()
            };
            let marker = member_marker(&Settings::default(), &marker);
            assert_eq!(marker.id, 3);
            marker.position.is_some()
        };
        assert!(place(None) && place(Some(MarkerParams::HAS_MODEL)));
        assert!(!place(Some(MarkerParams::OCCLUDED)));
        assert!(place(Some(MarkerParams(5))));
    }
}
