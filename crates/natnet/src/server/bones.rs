//! Skeletons for versions that have none: before 2.1, bones go out as rigid bodies.

use std::borrow::Cow;

use crate::frame::Frame;
use crate::model::{Description, Model, RigidBodyDescription, SkeletonDescription};
use crate::{Name, Version};

/// The frame as it goes out in a version: where that has no skeletons, their bones are rigid bodies after the others, with
/// the IDs that they have in frames anyway.
pub(super) fn fitting_frame(frame: &Frame, version: Version) -> Cow<'_, Frame> {
    if version.has_skeletons() || frame.skeletons.is_empty() {
        return Cow::Borrowed(frame);
    }
    let mut fitting = frame.clone();
    let mut skeletons = std::mem::take(&mut fitting.skeletons);
    for skeleton in &mut skeletons {
        fitting.rigid_bodies.append(&mut skeleton.bones);
    }
    Cow::Owned(fitting)
}

/// The descriptions that go with [`fitting_frame`]. A bone is called `Subject/Bone` and keeps its parent.
pub(super) fn fitting_model(model: &Model, version: Version) -> Cow<'_, Model> {
    let is_skeleton = |description: &Description| matches!(description, Description::Skeleton(_));
    if version.has_skeletons() || !model.descriptions.iter().any(is_skeleton) {
        return Cow::Borrowed(model);
    }
    let mut descriptions = Vec::new();
    for description in &model.descriptions {
        match description {
            Description::Skeleton(skeleton) => {
                let bones = skeleton.bones.iter().map(|bone| body(skeleton, bone));
                descriptions.extend(bones.map(Description::RigidBody));
            }
            other => descriptions.push(other.clone()),
        }
    }
    Cow::Owned(Model { descriptions })
}

fn body(skeleton: &SkeletonDescription, bone: &RigidBodyDescription) -> RigidBodyDescription {
    let name = [skeleton.name.as_bytes(), b"/", bone.name.as_bytes()].concat();
    let parent_id = match bone.parent_id {
        ..=0 => -1,
        parent => bone_id(skeleton.id, parent),
    };
    RigidBodyDescription {
        name: Name::new(name),
        id: bone_id(skeleton.id, bone.id),
        parent_id,
        ..bone.clone()
    }
}

/// The ID that a bone has in frames.
const fn bone_id(skeleton: i32, bone: i32) -> i32 {
    skeleton << 16 | bone
}
