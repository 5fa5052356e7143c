//! Who is streamed.

use super::Vector;
use posewire_motion::{Point, Subject};
use serde::Serialize;
use std::collections::BTreeMap;

/// Who a character is: what the meta data and the scale say of it, types 12 and 13.
#[derive(Serialize)]
pub(crate) struct SubjectRecord<'a> {
    kind: &'static str,
    character: u32,
    name: &'a str,
    color: Option<String>,
    tags: BTreeMap<&'a str, &'a str>,
    segments: Vec<SegmentRecord<'a>>,
}

#[derive(Serialize)]
struct SegmentRecord<'a> {
    id: usize,
    name: &'a str,
    parent: Option<&'a str>,
    origin: Option<Vector>,
    points: Vec<PointRecord<'a>>,
}

#[derive(Serialize)]
struct PointRecord<'a> {
    id: u16,
    name: &'a str,
    flags: u32,
    offset: Vector,
}

impl<'a> SubjectRecord<'a> {
    pub(crate) fn new(subject: &'a Subject) -> Self {
        let segments = &subject.skeleton.segments;
        let name = |place: usize| segments.get(place).map(|segment| segment.name.as_str());
        let records = segments.iter().zip(1..).map(|(segment, id)| SegmentRecord {
            id,
            name: &segment.name,
            parent: segment.parent.and_then(name),
            origin: segment.origin.map(Vector),
            points: segment.points.iter().map(point).collect(),
        });
        Self {
            kind: "subject",
            character: subject.id,
            name: &subject.name,
            color: subject.color.map(|color| color.to_string()),
            tags: subject
                .tags
                .iter()
                .map(|(tag, value)| (tag.as_str(), value.as_str()))
                .collect(),
            segments: records.collect(),
        }
    }
}

fn point(point: &Point) -> PointRecord<'_> {
    PointRecord {
        id: point.id,
        name: &point.name,
        flags: point.flags,
        offset: Vector(point.offset),
    }
}
