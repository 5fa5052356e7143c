//! From subjects and their frames to a server's descriptions and frames.

use super::{Coordinates, Settings, clock};
use crate::frame::{BodyParams, Frame, FrameParams, LabeledMarker, MarkerParams, RigidBody, Skeleton};
use crate::model::{BodyMarkerDescription, Description, Model, RigidBodyDescription, SkeletonDescription};
use posewire_motion::{DVec3, Frame as MotionFrame, Marker, Pose, Segment, Subject};
use std::sync::Arc;

/// Writes subjects as a server's skeletons, rigid bodies and markers.
///
/// A subject with one segment is a rigid body, one with several a skeleton whose bones are numbered from 1 in the order of
/// the segments, one with none has markers without a label. IDs count from 1 in the order in which subjects are first
/// seen; subjects are told apart by number and name.
///
/// A frame's markers go out as labeled markers. A frame without any sends the points on its segments instead, each
/// numbered 256 times the segment's place, from 1, plus its own number. What has no place is told by [`lacks`](super::lacks).
///
/// ```
/// use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
/// use posewire_natnet::motion::{Encoder, Settings};
/// use std::sync::Arc;
///
/// let mut sent = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// sent.position = vec![Some(DVec3::new(0.0, 0.5, 1.0)); 23];
/// sent.orientation = vec![Some(DQuat::IDENTITY); 23];
///
/// let mut encoder = Encoder::new(Settings::default());
/// let frame = encoder.frame([&sent]);
/// assert_eq!(frame.skeletons[0].bones[0].position, [0.5, 1.0, 0.0]);
/// assert_eq!(encoder.model().descriptions[0].name().unwrap(), &"Ada");
/// ```
#[derive(Clone, Debug)]
pub struct Encoder {
    settings: Settings,
    subjects: Vec<Arc<Subject>>,
}

impl Encoder {
    /// An encoder for a server that is set so.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            subjects: Vec::new(),
        }
    }

    /// Makes a subject known before its first frame, or replaces what was known of it. True when that changes the model;
    /// false as well for a subject beyond the 32,767 that IDs have room for.
    pub fn describe(&mut self, subject: &Arc<Subject>) -> bool {
        let Some(place) = self.place(subject) else {
            let fits = self.subjects.len() < MAX_SUBJECTS;
            self.subjects.extend(fits.then(|| subject.clone()));
            return fits;
        };
        // The same subject in nearly every frame: the pointers are compared before what they point to.
        let before = std::mem::replace(&mut self.subjects[place], subject.clone());
        !Arc::ptr_eq(&before, subject) && before != *subject
    }

    /// Whether this very subject is known, as the last one of its number and name.
    pub fn knows(&self, subject: &Arc<Subject>) -> bool {
        self.subjects.iter().any(|known| Arc::ptr_eq(known, subject))
    }

    /// The descriptions of all subjects known so far.
    pub fn model(&self) -> Model {
        let described = self.subjects.iter().zip(1..);
        Model {
            descriptions: described
                .filter_map(|(subject, id)| description(subject, id, &self.settings))
                .collect(),
        }
    }

    /// One frame of what the subjects do at one instant. Number, time and timecode are those of the first. A subject that
    /// is new or changed is taken over, and the frame then says that the model has changed.
    pub fn frame<'a>(&mut self, frames: impl IntoIterator<Item = &'a MotionFrame>) -> Frame {
        let mut out = Frame {
            params: Some(FrameParams::default()),
            ..Frame::default()
        };
        for (index, frame) in frames.into_iter().enumerate() {
            if index == 0 {
                out.number = frame.sample as i32;
                out.timestamp = Some(frame.time.as_secs_f64());
                out.timecode = clock::timecode_out(frame.timecode, self.settings.timecode_rate);
            }
            if self.describe(&frame.subject) {
                out.params = Some(FrameParams::MODEL_CHANGED);
            }
            if let Some(place) = self.place(&frame.subject) {
                self.append(frame, place as i32 + 1, &mut out);
            }
        }
        out
    }

    fn place(&self, subject: &Arc<Subject>) -> Option<usize> {
        let known = |other: &Arc<Subject>| {
            Arc::ptr_eq(other, subject) || (other.id, &other.name) == (subject.id, &subject.name)
        };
        self.subjects.iter().position(known)
    }

    fn append(&self, frame: &MotionFrame, id: i32, out: &mut Frame) {
        match frame.subject.skeleton.segments.len() {
            0 => out.labeled_markers.extend(self.loose_markers(frame)),
            1 => out.rigid_bodies.push(self.body(id, frame.pose(0))),
            count => {
                let bone = |place| self.body(id << 16 | (place as i32 + 1), self.bone_pose(frame, place));
                let bones = (0..count).map(bone).collect();
                out.skeletons.push(Skeleton { id, bones });
            }
        }
        if !frame.subject.skeleton.segments.is_empty() {
            self.append_markers(frame, id, out);
        }
    }

    fn bone_pose(&self, frame: &MotionFrame, place: usize) -> Option<Pose> {
        let pose = frame.pose(place)?;
        match (self.settings.skeleton, frame.subject.skeleton.segments[place].parent) {
            (Coordinates::Local, Some(parent)) => Some(pose.relative_to(frame.pose(parent)?)),
            _ => Some(pose),
        }
    }

    fn body(&self, id: i32, pose: Option<Pose>) -> RigidBody {
        let (position, orientation) = match pose {
            Some(pose) => self.settings.pose_out(pose),
            None => ([0.0; 3], [0.0, 0.0, 0.0, 1.0]),
        };
        let params = pose.map_or(BodyParams::default(), |_| BodyParams::TRACKED);
        RigidBody {
            id,
            position,
            orientation,
            params: Some(params),
            ..RigidBody::default()
        }
    }

    fn loose_markers(&self, frame: &MotionFrame) -> impl Iterator<Item = LabeledMarker> {
        let loose = |marker: &Marker| self.marker(marker.id as i32, marker.position, MarkerParams::UNLABELED);
        frame.markers.iter().map(loose)
    }

    fn append_markers(&self, frame: &MotionFrame, owner: i32, out: &mut Frame) {
        let mut push = |id: usize, position, params| {
            if let Ok(member) = u16::try_from(id) {
                let id = owner << 16 | i32::from(member);
                out.labeled_markers.push(self.marker(id, position, params));
            }
        };
        for marker in &frame.markers {
            push(marker.id as usize, marker.position, MarkerParams::POINT_CLOUD_SOLVED);
        }
        if frame.markers.is_empty() {
            for (place, segment) in frame.subject.skeleton.segments.iter().enumerate() {
                let pose = frame.pose(place);
                for point in &segment.points {
                    let position = pose.map(|pose| pose.transform(point.offset));
                    push(
                        (place + 1) * 256 + usize::from(point.id),
                        position,
                        MarkerParams::MODEL_FILLED,
                    );
                }
            }
        }
    }

    /// A marker that was seen, or filled in, as `how` says, or that was not seen.
    fn marker(&self, id: i32, position: Option<DVec3>, how: MarkerParams) -> LabeledMarker {
        let model = match how {
            MarkerParams::UNLABELED => how,
            _ => MarkerParams::HAS_MODEL,
        };
        let seen = position.map_or(MarkerParams::OCCLUDED, |_| how);
        LabeledMarker {
            id,
            position: position.map_or([0.0; 3], |position| self.settings.position_out(position)),
            params: Some(MarkerParams(model.0 | seen.0)),
            ..LabeledMarker::default()
        }
    }
}

/// A subject without segments needs no description.
fn description(subject: &Subject, id: i32, settings: &Settings) -> Option<Description> {
    let segments = &subject.skeleton.segments;
    match &segments[..] {
        [] => None,
        [segment] => Some(Description::RigidBody(RigidBodyDescription {
            name: subject.name.as_str().into(),
            id,
            parent_id: -1,
            offset: settings.position_out(segment.origin.unwrap_or_default()),
            markers: segment.points.iter().map(|point| marker(point, settings)).collect(),
            ..RigidBodyDescription::default()
        })),
        _ => Some(Description::Skeleton(SkeletonDescription {
            name: subject.name.as_str().into(),
            id,
            bones: (0..segments.len())
                .map(|place| bone(segments, place, settings))
                .collect(),
        })),
    }
}

/// Motive describes no markers of bones, and there are clients that cannot read any.
fn bone(segments: &[Segment], place: usize, settings: &Settings) -> RigidBodyDescription {
    let segment = &segments[place];
    let parent = segment.parent.filter(|&parent| parent < segments.len());
    let origin = parent.map_or(Some(DVec3::ZERO), |parent| segments[parent].origin);
    let offset = segment.origin.zip(origin).map(|(origin, parent)| origin - parent);
    RigidBodyDescription {
        name: segment.name.as_str().into(),
        id: place as i32 + 1,
        parent_id: parent.map_or(0, |parent| parent as i32 + 1),
        offset: settings.position_out(offset.unwrap_or_default()),
        ..RigidBodyDescription::default()
    }
}

fn marker(point: &posewire_motion::Point, settings: &Settings) -> BodyMarkerDescription {
    BodyMarkerDescription {
        offset: settings.position_out(point.offset),
        active_label: 0,
        name: point.name.as_str().into(),
    }
}

/// A marker's ID has 16 bits, one of them the sign, for that of its asset.
const MAX_SUBJECTS: usize = 0x7FFF;
