//! Where the points on a subject's segments are.

use posewire_motion::{DVec3, Frame, Marker};

/// A point on a segment, in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlacedPoint {
    /// 256 times the segment's place, from 1, plus the point's number on the segment.
    pub(super) number: u32,
    /// Where it is, m; `None` when neither a marker nor the segment's pose tells.
    pub(super) position: Option<DVec3>,
}

/// The points on all segments, in the order of the skeleton.
pub(super) fn placed_points(frame: &Frame) -> Vec<PlacedPoint> {
    let mut points = Vec::new();
    for (place, segment) in frame.subject.skeleton.segments.iter().enumerate() {
        let pose = frame.pose(place);
        for point in &segment.points {
            let number = (place as u32 + 1) * 256 + u32::from(point.id);
            let marker = marker(frame, points.len(), [number, own_number(frame, number)]);
            let position = marker.or_else(|| pose.map(|pose| pose.transform(point.offset)));
            points.push(PlacedPoint { number, position });
        }
    }
    points
}

/// Markers of a body of its own are numbered without the segment when they come from NatNet.
fn own_number(frame: &Frame, number: u32) -> u32 {
    match frame.subject.skeleton.segments.len() {
        1 => number & 0xFF,
        _ => number,
    }
}

/// Where the frame's marker of one of these numbers is; usually it stands at the `index` of the point.
fn marker(frame: &Frame, index: usize, numbers: [u32; 2]) -> Option<DVec3> {
    let is_it = |marker: &&Marker| numbers.contains(&marker.id);
    let at_index = frame.markers.get(index).filter(is_it);
    at_index.or_else(|| frame.markers.iter().find(is_it))?.position
}
