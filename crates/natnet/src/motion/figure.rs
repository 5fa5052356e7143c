//! A subject and the bones on the wire that its segments are.

use super::markers::is_position;
use super::{Coordinates, Settings};
use crate::Name;
use crate::frame::RigidBody;
use crate::model::RigidBodyDescription;
use posewire_motion::standard::BODY_SEGMENTS;
use posewire_motion::{DQuat, Frame, Point, Pose, Segment, SegmentKind, Skeleton, Subject};
use std::collections::HashMap;
use std::sync::Arc;

/// A subject and the bones on the wire that its segments are.
#[derive(Clone, Debug)]
pub(super) struct Figure {
    pub(super) subject: Arc<Subject>,
    /// Whether the model describes it; otherwise it is made of what the frames hold.
    pub(super) described: bool,
    /// For each segment the bone's number.
    bones: Vec<i32>,
    /// The places of the segments by the bone's number.
    places: HashMap<i32, usize>,
    /// The segments that hang on the world or on each other, parents first.
    order: Vec<usize>,
}

impl Figure {
    /// A figure of described bones.
    pub(super) fn described(subject: Subject, bones: &[RigidBodyDescription], settings: &Settings) -> Self {
        let places = places(bones.iter().map(|bone| bone.id));
        let mut segments: Vec<_> = bones.iter().map(|bone| segment(bone, settings)).collect();
        for (place, bone) in bones.iter().enumerate() {
            segments[place].parent = places.get(&bone.parent_id).copied().filter(|&parent| parent != place);
        }
        let order = order(&segments);
        place_origins(&mut segments, &order);
        let bones = bones.iter().map(|bone| bone.id).collect();
        Self {
            subject: Arc::new(with_skeleton(subject, segments, settings)),
            described: true,
            bones,
            places,
            order,
        }
    }

    /// A figure that no model describes: a segment for each bone, hanging on nothing. When bones are relative to parents
    /// that nobody knows, only the first one's pose can be told.
    pub(super) fn found(subject: Subject, bones: &[RigidBody], settings: &Settings) -> Self {
        let ids: Vec<_> = bones.iter().map(RigidBody::member_id).collect();
        let name = |id: &i32| Segment::new(format!("Bone {id}"), SegmentKind::Body);
        let segments: Vec<_> = ids.iter().map(name).collect();
        let known = match settings.skeleton {
            Coordinates::Global => segments.len(),
            Coordinates::Local => segments.len().min(1),
        };
        Self {
            subject: Arc::new(with_skeleton(subject, segments, settings)),
            described: false,
            places: places(ids.iter().copied()),
            bones: ids,
            order: (0..known).collect(),
        }
    }

    /// Whether the figure was made of bones with these numbers.
    pub(super) fn has_bones(&self, bones: &[RigidBody]) -> bool {
        self.bones.iter().copied().eq(bones.iter().map(RigidBody::member_id))
    }

    /// Fills in positions and orientations. Bones that no segment is are passed over; their number is returned.
    pub(super) fn pose(&self, bones: &[RigidBody], settings: &Settings, frame: &mut Frame) -> usize {
        let mut poses = vec![None; self.bones.len()];
        let mut unknown = 0;
        for (index, bone) in bones.iter().enumerate() {
            match self.place(index, bone) {
                Some(place) => poses[place] = pose(bone, settings),
                None => unknown += 1,
            }
        }
        match settings.skeleton {
            Coordinates::Local => poses = self.composed(&poses),
            Coordinates::Global => {}
        }
        frame.position = poses.iter().map(|pose| pose.map(|pose| pose.position)).collect();
        frame.orientation = poses.iter().map(|pose| pose.map(|pose| pose.orientation)).collect();
        unknown
    }

    /// Bones come in the order of their descriptions, nearly always. A body of its own has its ID in place of a member's.
    fn place(&self, index: usize, bone: &RigidBody) -> Option<usize> {
        let id = bone.member_id();
        if self.bones.get(index) == Some(&id) {
            return Some(index);
        }
        self.places.get(&id).or_else(|| self.places.get(&bone.id)).copied()
    }

    fn composed(&self, local: &[Option<Pose>]) -> Vec<Option<Pose>> {
        let mut poses = vec![None; local.len()];
        for &place in &self.order {
            poses[place] = match self.subject.skeleton.segments[place].parent {
                None => local[place],
                Some(parent) => parent_pose(&poses, parent).zip(local[place]).map(|(a, b)| a.compose(b)),
            };
        }
        poses
    }
}

fn parent_pose(poses: &[Option<Pose>], parent: usize) -> Option<Pose> {
    poses.get(parent).copied().flatten()
}

/// The pose of a tracked bone. Before 2.6 nothing says whether it is; servers send zeros when it is not.
fn pose(bone: &RigidBody, settings: &Settings) -> Option<Pose> {
    let tracked = bone.is_tracked().unwrap_or(true) && is_position(bone.position, bone.params.is_some());
    let turned =
        bone.orientation.iter().all(|value| value.is_finite()) && bone.orientation.iter().any(|&value| value != 0.0);
    (tracked && turned).then(|| settings.pose_in(bone.position, bone.orientation))
}

fn places(ids: impl Iterator<Item = i32>) -> HashMap<i32, usize> {
    ids.enumerate().map(|(place, id)| (id, place)).collect()
}

fn segment(bone: &RigidBodyDescription, settings: &Settings) -> Segment {
    let point = |(place, marker): (usize, &crate::model::BodyMarkerDescription)| Point {
        id: u16::try_from(place + 1).unwrap_or(u16::MAX),
        name: name_or(&marker.name, || format!("Marker {}", place + 1)),
        offset: settings.position_in(marker.offset),
        flags: 0,
    };
    let name = name_or(&bone.name, || format!("Bone {}", bone.id));
    Segment {
        origin: Some(settings.position_in(bone.offset)),
        points: bone.markers.iter().enumerate().map(point).collect(),
        ..Segment::new(name, SegmentKind::Body)
    }
}

/// The text of a name, or what stands for it where there is none.
pub(super) fn name_or(name: &Name, otherwise: impl FnOnce() -> String) -> String {
    if name.is_empty() { otherwise() } else { name.to_string() }
}

/// The segments with their parents before them. Segments that hang on each other in a ring are left out.
fn order(segments: &[Segment]) -> Vec<usize> {
    let mut children = vec![Vec::new(); segments.len()];
    let mut order = Vec::with_capacity(segments.len());
    for (place, segment) in segments.iter().enumerate() {
        match segment.parent.and_then(|parent| children.get_mut(parent)) {
            Some(siblings) => siblings.push(place),
            None => order.push(place),
        }
    }
    let mut next = 0;
    while let Some(&place) = order.get(next) {
        order.append(&mut children[place]);
        next += 1;
    }
    order
}

/// Offsets are from the parent; origins are in the world of the null pose, in which nothing is turned.
fn place_origins(segments: &mut [Segment], order: &[usize]) {
    for &place in order {
        let parent = segments[place].parent.map(|parent| segments[parent].origin);
        if let Some(parent) = parent {
            segments[place].origin = parent
                .zip(segments[place].origin)
                .map(|(parent, offset)| parent + offset);
        }
    }
}

/// A skeleton named as MVN's body gets MVN's joints, so that joint angles can be worked out.
fn with_skeleton(subject: Subject, segments: Vec<Segment>, settings: &Settings) -> Subject {
    let names = segments.iter().map(|segment| segment.name.as_str());
    let mut skeleton = if names.eq(BODY_SEGMENTS.iter().map(|entry| entry.name)) {
        Skeleton::standard(0, false)
    } else {
        Skeleton::default()
    };
    let isb: Vec<DQuat> = skeleton.segments.iter().map(|segment| segment.isb).collect();
    skeleton.segments = segments;
    for (segment, isb) in skeleton.segments.iter_mut().zip(isb) {
        segment.isb = isb;
    }
    skeleton.sensors.clear();
    skeleton.contacts.clear();
    Subject {
        rate: settings.rate,
        skeleton,
        ..subject
    }
}
