//! One line about descriptions.

use std::fmt;

use super::{Description, Model};

impl fmt::Display for Model {
    /// `3 descriptions: rigid body 2 "drone" (5 markers), marker set "all" (5 markers), ...`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.descriptions.len() {
            0 => f.write_str("no descriptions")?,
            1 => f.write_str("1 description: ")?,
            count => write!(f, "{count} descriptions: ")?,
        }
        for (n, description) in self.descriptions.iter().enumerate() {
            let separator = if n == 0 { "" } else { ", " };
            write!(f, "{separator}{description}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Description {
    /// `rigid body 2 "drone" (5 markers)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MarkerSet(set) => write!(f, "marker set {:?} ({} markers)", set.name, set.markers.len()),
            Self::RigidBody(body) => {
                write!(
                    f,
                    "rigid body {} {:?} ({} markers)",
                    body.id,
                    body.name,
                    body.markers.len()
                )
            }
            Self::Skeleton(one) => write!(f, "skeleton {} {:?} ({} bones)", one.id, one.name, one.bones.len()),
            Self::ForcePlate(one) => {
                write!(
                    f,
                    "force plate {} {:?} ({} channels)",
                    one.id,
                    one.serial,
                    one.channels.len()
                )
            }
            Self::Device(one) => write!(f, "device {} {:?} ({} channels)", one.id, one.name, one.channels.len()),
            Self::Camera(one) => write!(f, "camera {:?}", one.name),
            Self::Asset(one) => write!(
                f,
                "asset {} {:?} ({} bodies, {} markers)",
                one.id,
                one.name,
                one.rigid_bodies.len(),
                one.markers.len()
            ),
            Self::Unknown { kind, bytes } => write!(f, "type {kind} ({} bytes)", bytes.len()),
        }
    }
}
