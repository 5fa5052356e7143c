//! A subject from its JSON in a recording.

use posewire_motion::standard::BODY_SEGMENTS;
use posewire_motion::{DVec3, Point, Segment, SegmentKind, Skeleton, Subject};
use serde::Deserialize;

#[derive(Deserialize)]
struct Described {
    id: u32,
    name: String,
    color: Option<String>,
    rate_hz: Option<f64>,
    #[serde(default)]
    tags: Vec<(String, String)>,
    segments: Vec<DescribedSegment>,
    #[serde(default)]
    joints: Vec<String>,
    #[serde(default)]
    contacts: Vec<String>,
}

#[derive(Deserialize)]
struct DescribedSegment {
    name: String,
    #[serde(default)]
    kind: String,
    parent: Option<usize>,
    origin: Option<Vector>,
    #[serde(default)]
    points: Vec<DescribedPoint>,
}

#[derive(Deserialize)]
struct DescribedPoint {
    id: u16,
    name: String,
    offset: Vector,
}

/// Numbers that are none are null.
type Vector = [Option<f64>; 3];

/// The subject that [`describe`](super::description::describe) has described; `None` of other text.
///
/// Joints are there by their names alone: those of MVN's skeleton have the ends that they have there, others are left out, and
/// so are sensors, of which poses say nothing.
pub(super) fn subject_of(text: &str) -> Option<Subject> {
    let described: Described = serde_json::from_str(text).ok()?;
    if described.segments.len() > MOST_SEGMENTS {
        return None;
    }
    let rate = described.rate_hz.filter(|rate| rate.is_finite() && *rate > 0.0);
    let color = described.color.as_deref().and_then(|color| color.parse().ok());
    let mut skeleton = Skeleton {
        segments: described.segments.into_iter().map(segment).collect(),
        contacts: described.contacts,
        ..Skeleton::default()
    };
    cut_rings(&mut skeleton.segments);
    add_what_mvn_has(&mut skeleton, &described.joints);
    Some(Subject {
        id: described.id,
        color,
        rate,
        tags: described.tags,
        ..Subject::new(described.name, skeleton)
    })
}

fn segment(described: DescribedSegment) -> Segment {
    let kind = match described.kind.as_str() {
        "prop" => SegmentKind::Prop,
        "left finger" => SegmentKind::LeftFinger,
        "right finger" => SegmentKind::RightFinger,
        _ => SegmentKind::Body,
    };
    Segment {
        parent: described.parent,
        origin: described.origin.and_then(vector),
        points: described.points.into_iter().filter_map(point).collect(),
        ..Segment::new(described.name, kind)
    }
}

fn point(described: DescribedPoint) -> Option<Point> {
    Some(Point {
        id: described.id,
        name: described.name,
        offset: vector(described.offset)?,
        flags: 0,
    })
}

fn vector([x, y, z]: Vector) -> Option<DVec3> {
    Some(DVec3::new(x?, y?, z?))
}

/// Lets segments hang on nothing that hang on none that is there, or on themselves by way of others.
fn cut_rings(segments: &mut [Segment]) {
    for place in 0..segments.len() {
        if !hangs_on_a_root(segments, place) {
            segments[place].parent = None;
        }
    }
}

fn hangs_on_a_root(segments: &[Segment], place: usize) -> bool {
    let mut at = Some(place);
    for _ in 0..=segments.len() {
        let Some(here) = at else { return true };
        let Some(segment) = segments.get(here) else {
            return false;
        };
        at = segment.parent;
    }
    at.is_none()
}

/// Of MVN's skeleton its joints, angles and axes, which its names tell.
fn add_what_mvn_has(skeleton: &mut Skeleton, joints: &[String]) {
    let body = BODY_SEGMENTS.iter().map(|known| known.name);
    let found = skeleton.segments.iter().map(|segment| segment.name.as_str());
    if !body.eq(found.take(BODY_SEGMENTS.len())) {
        return;
    }
    let standard = Skeleton::standard(0, false);
    for (segment, known) in skeleton.segments.iter_mut().zip(&standard.segments) {
        segment.isb = known.isb;
    }
    let known = standard.joints.into_iter();
    skeleton.joints = known.filter(|joint| joints.contains(&joint.name)).collect();
    skeleton.ergonomic_angles = standard.ergonomic_angles;
}

/// More than any skeleton has: who hangs on whom is looked at for each.
const MOST_SEGMENTS: usize = 4096;

#[cfg(test)]
mod tests {
    use super::super::description::describe;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_was_described_is_read() {
        for (props, fingers) in [(0, false), (2, true)] {
            let mut subject = Subject::new("Ada", Skeleton::standard(props, fingers));
            (subject.id, subject.rate, subject.color) = (3, Some(240.0), Some(posewire_motion::Color([1, 2, 3])));
            subject.tags = vec![("a".to_owned(), "b".to_owned())];
            subject.skeleton.segments[4].origin = None;
            let read = subject_of(&describe(&subject)).unwrap();
            subject.skeleton.sensors.clear();
            assert_eq!(read, subject);
        }
    }

    #[test]
    fn segments_that_hang_on_each_other_hang_on_nothing() {
        let segment = |name: &str, parent: usize| format!("{{\"name\": \"{name}\", \"parent\": {parent}}}");
        let segments = [
            segment("a", 1),
            segment("b", 0),
            segment("c", 9),
            segment("d", 3),
            segment("e", 2),
        ]
        .join(",");
        let text = format!("{{\"id\": 0, \"name\": \"x\", \"segments\": [{segments}]}}");
        let parents = subject_of(&text).unwrap().skeleton.segments;
        let parents: Vec<_> = parents.into_iter().map(|segment| segment.parent).collect();
        assert_eq!(parents, [None, Some(0), None, None, Some(2)]);
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in ".{0,99}", place in any::<prop::sample::Index>(), byte in any::<u8>()) {
            let _ = subject_of(&text);
            let mut described = describe(&Subject::new("Ada", Skeleton::standard(0, false))).into_bytes();
            let place = place.index(described.len());
            described[place] = byte;
            let _ = subject_of(&String::from_utf8_lossy(&described));
        }
    }
}
