//! One line about descriptions.

use std::fmt;

use super::{Description, Model};
use crate::line::count;

impl fmt::Display for Model {
    /// `3 descriptions: rigid body 2 "drone" (5 markers), marker set "all" (5 markers), ...`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.descriptions.is_empty() {
            return f.write_str("no descriptions");
        }
        write!(f, "{}: ", count(self.descriptions.len(), "description"))?;
        for (n, description) in self.descriptions.iter().enumerate() {
            let separator = if n == 0 { "" } else { ", " };
            write!(f, "{separator}{description}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Description {
    /// `rigid body 2 "drone" (5 markers)`. Empty lists are left out.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MarkerSet(set) => write!(f, "marker set {:?}", set.name)?,
            Self::RigidBody(body) => write!(f, "rigid body {} {:?}", body.id, body.name)?,
            Self::Skeleton(skeleton) => write!(f, "skeleton {} {:?}", skeleton.id, skeleton.name)?,
            Self::ForcePlate(plate) => write!(f, "force plate {} {:?}", plate.id, plate.serial)?,
            Self::Device(device) => write!(f, "device {} {:?}", device.id, device.name)?,
            Self::Camera(camera) => write!(f, "camera {:?}", camera.name)?,
            Self::Asset(asset) => write!(f, "asset {} {:?}", asset.id, asset.name)?,
            Self::Unknown { kind, .. } => write!(f, "type {kind}")?,
        }
        match self.contents() {
            contents if contents.is_empty() => Ok(()),
            contents => write!(f, " ({contents})"),
        }
    }
}

impl Description {
    fn contents(&self) -> String {
        match self {
            Self::MarkerSet(set) => count(set.markers.len(), "marker"),
            Self::RigidBody(body) => count(body.markers.len(), "marker"),
            Self::Skeleton(skeleton) => count(skeleton.bones.len(), "bone"),
            Self::ForcePlate(plate) => count(plate.channels.len(), "channel"),
            Self::Device(device) => count(device.channels.len(), "channel"),
            Self::Camera(_) => String::new(),
            Self::Asset(asset) => count(asset.markers.len(), "marker"),
            Self::Unknown { bytes, .. } => count(bytes.len(), "byte"),
        }
    }
}
