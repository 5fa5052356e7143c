//! Segments, the joints between them and the points on them.

use crate::standard;
use glam::{DQuat, DVec3};

/// The segments of a subject and how they hang together.
///
/// All other types name a segment, joint or sensor by its place in these lists.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    /// The segments in the order of the source: body, props, left fingers, right fingers.
    pub segments: Vec<Segment>,
    /// The joints for which the source gives angles.
    pub joints: Vec<Joint>,
    /// The ergonomic angles that the source gives.
    pub ergonomic_angles: Vec<ErgonomicAngle>,
    /// For each motion tracker, the place of the segment that wears it.
    pub sensors: Vec<usize>,
    /// The names of the foot contacts that the source tells of.
    pub contacts: Vec<String>,
}

impl Skeleton {
    /// MVN's skeleton: 23 body segments with 22 joints, then `props` props, then, with `fingers`, 20 segments of the left
    /// hand and 20 of the right. Origins and points are those of a nominal adult.
    pub fn standard(props: usize, fingers: bool) -> Self {
        standard::skeleton(props, fingers)
    }

    /// The place of the segment with this name.
    pub fn segment(&self, name: &str) -> Option<usize> {
        self.segments.iter().position(|segment| segment.name == name)
    }

    /// How many segments are of this kind.
    pub fn count(&self, kind: SegmentKind) -> usize {
        self.segments.iter().filter(|segment| segment.kind == kind).count()
    }

    /// How many segments are fingers, of both hands.
    pub fn finger_count(&self) -> usize {
        self.count(SegmentKind::LeftFinger) + self.count(SegmentKind::RightFinger)
    }
}

/// What a segment is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SegmentKind {
    /// One of the body's segments, or a segment of an unknown skeleton.
    Body,
    /// Something that is held or worn.
    Prop,
    /// A segment of the left hand, carpus included.
    LeftFinger,
    /// A segment of the right hand, carpus included.
    RightFinger,
}

/// A part of the body that is taken as rigid.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Its name without spaces, as MVN exports it: `RightUpperArm`.
    pub name: String,
    /// What it is part of.
    pub kind: SegmentKind,
    /// The place of the segment that it hangs on; `None` for the root and for what hangs on nothing.
    pub parent: Option<usize>,
    /// Its origin in the null pose (a T-pose with every orientation the identity), metres in the world; `None` until the
    /// source has said.
    pub origin: Option<DVec3>,
    /// Landmarks and joint centres on it.
    pub points: Vec<Point>,
    /// From the segment's ISB axes, in which joint angles are defined, to its own axes: ISB orientation is `orientation * isb`.
    pub isb: DQuat,
}

impl Segment {
    /// A segment with a name and a kind, hanging on nothing.
    pub fn new(name: impl Into<String>, kind: SegmentKind) -> Self {
        Self {
            name: name.into(),
            kind,
            parent: None,
            origin: None,
            points: Vec::new(),
            isb: DQuat::IDENTITY,
        }
    }

    /// The point with this id.
    pub fn point(&self, id: u16) -> Option<&Point> {
        self.points.iter().find(|point| point.id == id)
    }
}

/// A landmark or joint centre on a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Its number on the segment, from 1.
    pub id: u16,
    /// Its name: `pSacrum`, `jL5S1`.
    pub name: String,
    /// From the segment's origin, in the segment's axes, metres.
    pub offset: DVec3,
    /// MXTP's characteristics of the point, whose meaning is not public; 0 elsewhere.
    pub flags: u32,
}

/// One end of a joint: a point of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Connector {
    /// The segment's place in the skeleton.
    pub segment: usize,
    /// The [`Point::id`] on that segment.
    pub point: u16,
}

/// Two segments that turn against each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Joint {
    /// Its name: `jRightElbow`.
    pub name: String,
    /// Where it sits on the parent segment.
    pub parent: Connector,
    /// Where it sits on the child segment.
    pub child: Connector,
}

/// An angle between two segments that need not touch, as ergonomists use it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ErgonomicAngle {
    /// Its name: `T8_Head`.
    pub name: String,
    /// The place of the segment that it is measured from; `None` for the vertical.
    pub parent: Option<usize>,
    /// The place of the segment that is measured.
    pub child: usize,
}
