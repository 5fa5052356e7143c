//! A subject as JSON.

use posewire_motion::{SegmentKind, Subject};
use serde::Serialize;

#[derive(Serialize)]
struct Description<'a> {
    id: u32,
    name: &'a str,
    color: Option<String>,
    rate_hz: Option<f64>,
    tags: &'a [(String, String)],
    segments: Vec<Segment<'a>>,
    joints: Vec<&'a str>,
    sensors: &'a [usize],
    contacts: &'a [String],
}

#[derive(Serialize)]
struct Segment<'a> {
    name: &'a str,
    kind: &'static str,
    parent: Option<usize>,
    origin: Option<[f64; 3]>,
    points: Vec<Point<'a>>,
}

#[derive(Serialize)]
struct Point<'a> {
    id: u16,
    name: &'a str,
    offset: [f64; 3],
}

/// The description of a subject: its segments in order with the place of their parents, their origins in the T-pose and
/// the points on them, in metres.
pub(super) fn describe(subject: &Subject) -> String {
    let skeleton = &subject.skeleton;
    let description = Description {
        id: subject.id,
        name: &subject.name,
        color: subject.color.map(|color| color.to_string()),
        rate_hz: subject.rate,
        tags: &subject.tags,
        segments: skeleton.segments.iter().map(segment).collect(),
        joints: skeleton.joints.iter().map(|joint| joint.name.as_str()).collect(),
        sensors: &skeleton.sensors,
        contacts: &skeleton.contacts,
    };
    // Nothing in it can fail: the keys are text, and numbers that are none become null.
    serde_json::to_string(&description).unwrap_or_default()
}

fn segment(segment: &posewire_motion::Segment) -> Segment<'_> {
    Segment {
        name: &segment.name,
        kind: match segment.kind {
            SegmentKind::Body => "body",
            SegmentKind::Prop => "prop",
            SegmentKind::LeftFinger => "left finger",
            SegmentKind::RightFinger => "right finger",
        },
        parent: segment.parent,
        origin: segment.origin.map(|origin| origin.to_array()),
        points: segment.points.iter().map(point).collect(),
    }
}

fn point(point: &posewire_motion::Point) -> Point<'_> {
    Point {
        id: point.id,
        name: &point.name,
        offset: point.offset.to_array(),
    }
}
