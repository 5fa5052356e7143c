//! From a server's descriptions and frames to subjects and their frames.

use super::figure::{Figure, name_or};
use super::markers::{body_markers, is_unlabeled, labeled_marker, member_marker, other_markers};
use super::{Settings, clock};
use crate::Name;
use crate::frame::{Frame, RigidBody};
use crate::model::{Description, Model, RigidBodyDescription};
use posewire_motion::{Frame as MotionFrame, Skeleton, Subject};
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// What a subject is on the wire, with its streaming ID.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entity {
    /// A rigid body of its own.
    Body(i32),
    /// A skeleton.
    Skeleton(i32),
    /// An asset, such as a trained marker set.
    Asset(i32),
    /// The markers that belong to none of these.
    Markers,
}

impl fmt::Display for Entity {
    /// `Body 5`: also the name of a subject that the model does not name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Body(id) => write!(f, "Body {id}"),
            Self::Skeleton(id) => write!(f, "Skeleton {id}"),
            Self::Asset(id) => write!(f, "Asset {id}"),
            Self::Markers => f.write_str("Markers"),
        }
    }
}

/// The subjects of one server: made of its descriptions, moved by its frames.
///
/// A subject's number counts from 0 in the order in which the server first told of it, and stays when descriptions
/// change. A subject that is described again as it was stays the same `Arc`.
///
/// ```
/// use posewire_natnet::frame::{BodyParams, Frame, RigidBody};
/// use posewire_natnet::motion::{Settings, Subjects};
///
/// let body = RigidBody {
///     id: 5,
///     position: [0.5, 1.5, 2.5],
///     orientation: [0.0, 0.0, 0.0, 1.0],
///     params: Some(BodyParams::TRACKED),
///     ..RigidBody::default()
/// };
/// let frame = Frame { number: 7, rigid_bodies: vec![body], ..Frame::default() };
///
/// let mut subjects = Subjects::new(Settings::default());
/// let mut frames = Vec::new();
/// subjects.read(&frame, &mut frames);
/// assert_eq!((frames[0].subject.name.as_str(), frames[0].sample), ("Body 5", 7));
/// assert_eq!(frames[0].position[0].map(|at| at.to_array()), Some([2.5, 0.5, 1.5]));
/// ```
#[derive(Clone, Debug)]
pub struct Subjects {
    settings: Settings,
    figures: HashMap<Entity, Figure>,
    /// Subjects by their number.
    entities: Vec<Entity>,
    numbers: HashMap<Entity, u32>,
    left_out: u64,
}

impl Subjects {
    /// The most subjects of one server. What else it tells of is left out and counted.
    pub const LIMIT: usize = 2048;

    /// No subjects yet, of a server that is set so.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            figures: HashMap::new(),
            entities: Vec::new(),
            numbers: HashMap::new(),
            left_out: 0,
        }
    }

    /// What the subject with this number is on the wire.
    pub fn entity(&self, number: u32) -> Option<Entity> {
        self.entities.get(number as usize).copied()
    }

    /// How many bodies, skeletons, assets and bones of all frames were left out: those beyond [`LIMIT`](Self::LIMIT), and
    /// bones that their skeleton's description does not have. When it grows, the model should be asked for again.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    /// The subjects that there are now, described or found in frames, in no particular order.
    pub fn subjects(&self) -> impl Iterator<Item = &Arc<Subject>> {
        self.figures.values().map(|figure| &figure.subject)
    }

    /// Sets the frames a second that subjects carry. Subjects that had another one become new.
    pub fn set_rate(&mut self, rate: Option<f64>) {
        self.settings.rate = rate;
        for figure in self.figures.values_mut() {
            if figure.subject.rate != rate {
                Arc::make_mut(&mut figure.subject).rate = rate;
            }
        }
    }

    /// Takes over the server's descriptions, in place of all that it sent before.
    pub fn describe(&mut self, model: &Model) {
        let mut before = std::mem::take(&mut self.figures);
        // No description is of loose markers.
        self.figures.extend(before.remove_entry(&Entity::Markers));
        for description in &model.descriptions {
            let (entity, name, bones) = match description {
                Description::RigidBody(body) => (Entity::Body(body.id), &body.name, std::slice::from_ref(body)),
                Description::Skeleton(skeleton) => (Entity::Skeleton(skeleton.id), &skeleton.name, &skeleton.bones[..]),
                Description::Asset(asset) => (Entity::Asset(asset.id), &asset.name, &asset.rigid_bodies[..]),
                _ => continue,
            };
            self.describe_one(entity, name, bones, &mut before);
        }
    }

    /// Appends a frame for each subject that `frame` holds: bodies, skeletons, assets, then loose markers.
    pub fn read(&mut self, frame: &Frame, out: &mut Vec<MotionFrame>) {
        let mut owners = Owners::default();
        let without_labels = frame.labeled_markers.is_empty();
        for body in &frame.rigid_bodies {
            let entity = Entity::Body(body.id);
            if let Some(mut moved) = self.moved(entity, std::slice::from_ref(body), frame) {
                if without_labels {
                    moved.markers.extend(body_markers(&self.settings, body));
                }
                owners.insert(body.id, Some(out.len()));
                out.push(moved);
            }
        }
        for asset in &frame.assets {
            if let Some(mut moved) = self.moved(Entity::Asset(asset.id), &asset.rigid_bodies, frame) {
                let markers = asset.markers.iter();
                moved
                    .markers
                    .extend(markers.map(|marker| member_marker(&self.settings, marker)));
                owners.insert(asset.id, moved.markers.is_empty().then_some(out.len()));
                out.push(moved);
            }
        }
        for skeleton in &frame.skeletons {
            if let Some(moved) = self.moved(Entity::Skeleton(skeleton.id), &skeleton.bones, frame) {
                owners.insert(skeleton.id, Some(out.len()));
                out.push(moved);
            }
        }
        self.read_markers(frame, &owners, out);
    }

    fn describe_one(
        &mut self,
        entity: Entity,
        name: &Name,
        bones: &[RigidBodyDescription],
        before: &mut HashMap<Entity, Figure>,
    ) {
        let Some(subject) = self.subject(entity, name) else {
            return;
        };
        let mut figure = Figure::described(subject, bones, &self.settings);
        if let Some(same) = before.remove(&entity).filter(|old| old.subject == figure.subject) {
            figure.subject = same.subject;
        }
        self.figures.insert(entity, figure);
    }

    /// A frame of the subject, with the poses of its bones.
    fn moved(&mut self, entity: Entity, bones: &[RigidBody], frame: &Frame) -> Option<MotionFrame> {
        let usable = |figure: &Figure| figure.described || figure.has_bones(bones);
        if !self.figures.get(&entity).is_some_and(usable) {
            let subject = self.subject(entity, &Name::default())?;
            let figure = Figure::found(subject, bones, &self.settings);
            self.figures.insert(entity, figure);
        }
        let figure = self.figures.get(&entity)?;
        let mut moved = MotionFrame::new(figure.subject.clone());
        moved.sample = frame.number as u32;
        moved.time = clock::time_in(frame.timestamp);
        moved.timecode = clock::timecode_in(frame.timecode, self.settings.timecode_rate);
        self.left_out += figure.pose(bones, &self.settings, &mut moved) as u64;
        Some(moved)
    }

    /// Gives labeled markers to their subjects, and the others to a subject of their own.
    fn read_markers(&mut self, frame: &Frame, owners: &Owners, out: &mut Vec<MotionFrame>) {
        let mut loose = Vec::new();
        for marker in &frame.labeled_markers {
            let owner = owners.get(&marker.asset_id()).filter(|_| !is_unlabeled(marker));
            match owner {
                None => loose.push(labeled_marker(&self.settings, marker)),
                Some(Some(place)) => out[*place].markers.push(member_marker(&self.settings, marker)),
                Some(None) => {}
            }
        }
        loose.extend(other_markers(&self.settings, frame));
        if loose.is_empty() && !self.figures.contains_key(&Entity::Markers) {
            return;
        }
        if let Some(mut moved) = self.moved(Entity::Markers, &[], frame) {
            moved.markers = loose;
            out.push(moved);
        }
    }

    /// A subject without a skeleton; `None` when there are too many.
    fn subject(&mut self, entity: Entity, name: &Name) -> Option<Subject> {
        let Some(id) = self.number(entity) else {
            self.left_out += 1;
            return None;
        };
        let name = name_or(name, || entity.to_string());
        Some(Subject {
            id,
            ..Subject::new(name, Skeleton::default())
        })
    }

    fn number(&mut self, entity: Entity) -> Option<u32> {
        if let Some(number) = self.numbers.get(&entity) {
            return Some(*number);
        }
        let number = self.entities.len();
        (number < Self::LIMIT).then(|| {
            self.entities.push(entity);
            self.numbers.insert(entity, number as u32);
            number as u32
        })
    }
}

/// For each streaming ID of a frame the place of the subject that gets its labeled markers; `None` for a subject that has
/// them already.
type Owners = HashMap<i32, Option<usize>>;
