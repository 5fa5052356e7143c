//! What there is to see, as JSON: subjects, their skeletons and channels, takes.

use crate::channel::{self, Group};
use posewire_motion::{Joint, Section, Segment, SegmentKind, Skeleton, Subject};
use serde::Serialize;

/// The scene, as `GET /api/scene` has it, and with a type the first message of the socket.
#[derive(Serialize)]
pub(crate) struct Scene<'a> {
    posewire: &'static str,
    mode: &'static str,
    recorder: bool,
    source: &'a [String],
    subjects: &'a [SubjectRecord],
    takes: &'a [TakeRecord],
}

impl<'a> Scene<'a> {
    /// A scene without takes, which are not live.
    pub(crate) fn live(source: &'a [String], subjects: &'a [SubjectRecord], recorder: bool) -> Self {
        Self {
            posewire: env!("CARGO_PKG_VERSION"),
            mode: "live",
            recorder,
            source,
            subjects,
            takes: &[],
        }
    }

    /// A scene of takes, which the page plays.
    pub(crate) fn takes(source: &'a [String], subjects: &'a [SubjectRecord], takes: &'a [TakeRecord]) -> Self {
        Self {
            mode: "takes",
            takes,
            ..Self::live(source, subjects, false)
        }
    }
}

/// A subject as a page knows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct SubjectRecord {
    id: u32,
    source: u16,
    name: String,
    color: Option<String>,
    rate_hz: Option<f64>,
    kind: &'static str,
    segments: Vec<SegmentRecord>,
    joints: Vec<JointRecord>,
    contacts: Vec<String>,
    channels: Vec<Group>,
}

impl SubjectRecord {
    /// A subject by the page's number; `present` has a bit for each of its [sections](Section::ALL).
    pub(crate) fn new(id: u32, source: u16, subject: &Subject, present: u32) -> Self {
        let skeleton = &subject.skeleton;
        Self {
            id,
            source,
            name: subject.name.clone(),
            color: subject.color.map(|color| color.to_string()),
            rate_hz: subject.rate.filter(|rate| rate.is_finite()),
            kind: kind(skeleton),
            segments: skeleton.segments.iter().map(SegmentRecord::new).collect(),
            joints: skeleton
                .joints
                .iter()
                .map(|joint| joint_record(joint, skeleton))
                .collect(),
            contacts: skeleton.contacts.clone(),
            channels: channel::groups(skeleton, present),
        }
    }
}

/// A take as a page knows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct TakeRecord {
    pub(crate) id: u32,
    pub(crate) subject: u32,
    pub(crate) file: String,
    pub(crate) rate_hz: f64,
    pub(crate) frames: usize,
    pub(crate) first_sample: u32,
    pub(crate) start_s: f64,
    pub(crate) duration_s: f64,
    /// Per gap: the frame before it, and how many samples it lacks.
    pub(crate) gaps: Vec<(usize, u32)>,
    /// Per stretch of frames that have no pose and show another's: the first, and how many they are.
    pub(crate) lost_poses: Vec<(usize, usize)>,
    pub(crate) markers: Vec<MarkerRecord>,
    pub(crate) start_timecode: Option<String>,
}

/// An event that the operator set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct MarkerRecord {
    pub(crate) frame: usize,
    pub(crate) name: String,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct SegmentRecord {
    name: String,
    kind: &'static str,
    parent: Option<usize>,
    origin: Option<[f64; 3]>,
    points: Vec<PointRecord>,
}

impl SegmentRecord {
    fn new(segment: &Segment) -> Self {
        let points = segment.points.iter().map(|point| PointRecord {
            name: point.name.clone(),
            offset: point.offset.to_array(),
        });
        Self {
            name: segment.name.clone(),
            kind: match segment.kind {
                SegmentKind::Body => "body",
                SegmentKind::Prop => "prop",
                SegmentKind::LeftFinger => "left finger",
                SegmentKind::RightFinger => "right finger",
            },
            parent: segment.parent,
            origin: segment.origin.map(|origin| origin.to_array()),
            points: points.collect(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct PointRecord {
    name: String,
    offset: [f64; 3],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct JointRecord {
    name: String,
    parent: usize,
    child: usize,
    offset_parent: Option<[f64; 3]>,
}

fn joint_record(joint: &Joint, skeleton: &Skeleton) -> JointRecord {
    let parent = skeleton.segments.get(joint.parent.segment);
    let point = parent.and_then(|segment| segment.point(joint.parent.point));
    JointRecord {
        name: joint.name.clone(),
        parent: joint.parent.segment,
        child: joint.child.segment,
        offset_parent: point.map(|point| point.offset.to_array()),
    }
}

/// What kind of thing a skeleton is of: MVN's has a person's joints, a rigid body is one segment.
fn kind(skeleton: &Skeleton) -> &'static str {
    match skeleton.segments.as_slice() {
        [] => "markers",
        [_] => "rigid body",
        _ if Section::JointAngles.entries(skeleton) > 0 && skeleton.segment("Pelvis").is_some() => "person",
        _ => "skeleton",
    }
}
