//! From subjects and their frames to a server's descriptions and frames.

use super::describe::{description, marker_set};
use super::points::{PlacedPoint, placed_points};
use super::{Coordinates, Settings, clock};
use crate::frame::{
    BodyMarker, BodyParams, Frame, FrameParams, LabeledMarker, MarkerParams, MarkerSet, RigidBody, Skeleton,
};
use crate::model::Model;
use posewire_motion::{DVec3, Frame as MotionFrame, Marker, Pose, Subject};
use std::sync::Arc;

/// Writes subjects as a server's skeletons, rigid bodies and markers.
///
/// A subject with one segment is a rigid body, one with several a skeleton whose bones are numbered from 1 in the order of
/// the segments, one with none has markers without a label. IDs count from 1 in the order in which subjects are first
/// seen; subjects are told apart by number and name.
///
/// The points on a subject's segments are a marker set of the subject's name, which every version has, and in a body
/// of its own the body's markers. A point is where the frame has a marker of its number, 256 times the segment's place, from
/// 1, plus its own, and else where the segment's pose takes it. A frame's markers go out as labeled markers; a frame without
/// any sends the points there as well. When bodies and points of all subjects are too much for one datagram, the points are left
/// out, of all of them. What has no place is told by [`lacks`](super::lacks).
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
    /// Whether a datagram can hold the points of all subjects.
    points_fit: bool,
}

impl Encoder {
    /// An encoder for a server that is set so.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            subjects: Vec::new(),
            points_fit: true,
        }
    }

    /// Makes a subject known before its first frame, or replaces what was known of it. True when that changes the model;
    /// false as well for a subject beyond the 32,767 that IDs have room for.
    pub fn describe(&mut self, subject: &Arc<Subject>) -> bool {
        let changes = self.take_over(subject);
        if changes {
            self.measure();
        }
        changes
    }

    /// Puts a subject in the place of one that is now called otherwise; the ID stays. False when that one is not known.
    pub fn rename(&mut self, before: &Arc<Subject>, subject: &Arc<Subject>) -> bool {
        let place = self.place(before);
        if let Some(place) = place {
            self.subjects[place] = subject.clone();
            self.measure();
        }
        place.is_some()
    }

    /// Whether this very subject is known, as the last one of its number and name.
    pub fn knows(&self, subject: &Arc<Subject>) -> bool {
        self.subjects.iter().any(|known| Arc::ptr_eq(known, subject))
    }

    /// The descriptions of all subjects known so far.
    pub fn model(&self) -> Model {
        let points = self.subjects.iter().filter(|_| self.points_fit);
        let described = self.subjects.iter().zip(1..);
        let bodies = described.filter_map(|(subject, id)| description(subject, id, &self.settings));
        Model {
            descriptions: points.filter_map(|subject| marker_set(subject)).chain(bodies).collect(),
        }
    }

    /// One frame of what the subjects do at one instant. Number, time and timecode are those of the first. A subject that
    /// is new or changed is taken over, and the frame then says that the model has changed.
    pub fn frame<'a>(&mut self, frames: impl IntoIterator<Item = &'a MotionFrame>) -> Frame {
        let frames: Vec<_> = frames.into_iter().collect();
        let changes = frames.iter().filter(|frame| self.describe(&frame.subject)).count();
        let mut out = Frame {
            params: Some(if changes > 0 {
                FrameParams::MODEL_CHANGED
            } else {
                FrameParams::default()
            }),
            ..Frame::default()
        };
        if let Some(first) = frames.first() {
            out.number = first.sample as i32;
            out.timestamp = Some(first.time.as_secs_f64());
            out.timecode = clock::timecode_out(first.timecode, self.settings.timecode_rate);
        }
        for frame in frames {
            if let Some(place) = self.place(&frame.subject) {
                self.append(frame, place as i32 + 1, &mut out);
            }
        }
        out
    }

    fn measure(&mut self) {
        self.points_fit = self.subjects.iter().map(|subject| size(subject)).sum::<usize>() <= LARGEST_FRAME;
    }

    fn take_over(&mut self, subject: &Arc<Subject>) -> bool {
        let Some(place) = self.place(subject) else {
            let fits = self.subjects.len() < MAX_SUBJECTS;
            self.subjects.extend(fits.then(|| subject.clone()));
            return fits;
        };
        // The same subject in nearly every frame: the pointers are compared before what they point to.
        let before = std::mem::replace(&mut self.subjects[place], subject.clone());
        !Arc::ptr_eq(&before, subject) && before != *subject
    }

    fn place(&self, subject: &Arc<Subject>) -> Option<usize> {
        let known = |other: &Arc<Subject>| {
            Arc::ptr_eq(other, subject) || (other.id, &other.name) == (subject.id, &subject.name)
        };
        self.subjects.iter().position(known)
    }

    fn append(&self, frame: &MotionFrame, id: i32, out: &mut Frame) {
        let points = if self.points_fit {
            placed_points(frame)
        } else {
            Vec::new()
        };
        if !points.is_empty() {
            out.marker_sets.push(self.marker_set(frame, &points));
        }
        match frame.subject.skeleton.segments.len() {
            0 => return out.labeled_markers.extend(self.loose_markers(frame)),
            1 => out.rigid_bodies.push(RigidBody {
                markers: points.iter().map(|point| self.body_marker(point)).collect(),
                ..self.body(id, frame.pose(0))
            }),
            count => {
                let bone = |place| self.body(id << 16 | (place as i32 + 1), self.bone_pose(frame, place));
                let bones = (0..count).map(bone).collect();
                out.skeletons.push(Skeleton { id, bones });
            }
        }
        self.append_markers(frame, id, &points, out);
    }

    fn marker_set(&self, frame: &MotionFrame, points: &[PlacedPoint]) -> MarkerSet {
        MarkerSet {
            name: frame.subject.name.as_str().into(),
            markers: points.iter().map(|point| self.wire_position(point.position)).collect(),
        }
    }

    fn body_marker(&self, point: &PlacedPoint) -> BodyMarker {
        BodyMarker {
            position: self.wire_position(point.position),
            id: Some(point.number as i32),
            size: None,
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

    fn append_markers(&self, frame: &MotionFrame, owner: i32, points: &[PlacedPoint], out: &mut Frame) {
        let mut push = |number: u32, position, params| {
            if let Ok(member) = u16::try_from(number) {
                let id = owner << 16 | i32::from(member);
                out.labeled_markers.push(self.marker(id, position, params));
            }
        };
        for marker in &frame.markers {
            push(marker.id, marker.position, MarkerParams::POINT_CLOUD_SOLVED);
        }
        if frame.markers.is_empty() {
            for point in points {
                push(point.number, point.position, MarkerParams::MODEL_FILLED);
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
            position: self.wire_position(position),
            params: Some(MarkerParams(model.0 | seen.0)),
            ..LabeledMarker::default()
        }
    }

    /// What is not known is zeros.
    fn wire_position(&self, position: Option<DVec3>) -> [f32; 3] {
        position.map_or([0.0; 3], |position| self.settings.position_out(position))
    }
}

/// Bytes that a subject can take in a frame of any version, with its points.
fn size(subject: &Subject) -> usize {
    let segments = &subject.skeleton.segments;
    let points: usize = segments.iter().map(|segment| segment.points.len()).sum();
    let (markers, body_markers) = (points * (12 + 26), if segments.len() == 1 { points * 20 } else { 0 });
    16 + subject.name.len() + segments.len() * 42 + markers + body_markers
}

/// What is left of a datagram for markers of the frames' own and all else is enough for most.
const LARGEST_FRAME: usize = 60_000;
/// A marker's ID has 16 bits, one of them the sign, for that of its asset.
const MAX_SUBJECTS: usize = 0x7FFF;
