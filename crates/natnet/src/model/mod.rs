//! Descriptions of what is streamed (message 5, MODELDEF).

mod decode;
mod device;
mod display;
mod encode;
mod rigid_body;
mod skeleton;

pub use device::{Camera, Device, ForcePlate};
pub use rigid_body::{BodyMarkerDescription, RigidBodyDescription};
pub use skeleton::{AssetDescription, AssetMarker, SkeletonDescription};

use crate::Name;

/// Everything that a server streams: names, IDs and the build of bodies. Frames carry IDs only.
///
/// ```
/// use posewire_natnet::Version;
/// use posewire_natnet::model::{Description, Model, RigidBodyDescription};
///
/// let model = Model {
///     descriptions: vec![Description::RigidBody(RigidBodyDescription {
///         name: "drone".into(),
///         id: 1,
///         ..RigidBodyDescription::default()
///     })],
/// };
/// let mut payload = Vec::new();
/// model.encode(Version::new(3, 1), &mut payload);
/// let (decoded, quirks) = Model::decode(Version::new(3, 1), &payload)?;
/// assert_eq!(decoded, model);
/// assert!(quirks.is_empty());
/// # Ok::<(), posewire_natnet::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The descriptions, in the order of the server.
    pub descriptions: Vec<Description>,
}

/// One description.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Description {
    /// Type 0.
    MarkerSet(MarkerSetDescription),
    /// Type 1.
    RigidBody(RigidBodyDescription),
    /// Type 2 (2.1 and later).
    Skeleton(SkeletonDescription),
    /// Type 3 (2.9 and later).
    ForcePlate(ForcePlate),
    /// Type 4 (2.11 and later).
    Device(Device),
    /// Type 5 (3.0 and later).
    Camera(Camera),
    /// Type 6 (4.1 and later).
    Asset(AssetDescription),
    /// A type that is not known, or a body that cannot be read, as it came (4.1 and later).
    Unknown {
        /// The number of the type.
        kind: i32,
        /// The body.
        bytes: Vec<u8>,
    },
}

impl Description {
    /// The number of the type.
    pub const fn kind(&self) -> i32 {
        match self {
            Self::MarkerSet(_) => 0,
            Self::RigidBody(_) => 1,
            Self::Skeleton(_) => 2,
            Self::ForcePlate(_) => 3,
            Self::Device(_) => 4,
            Self::Camera(_) => 5,
            Self::Asset(_) => 6,
            Self::Unknown { kind, .. } => *kind,
        }
    }

    /// The name of what is described; the serial number of a force plate.
    pub const fn name(&self) -> Option<&Name> {
        match self {
            Self::MarkerSet(set) => Some(&set.name),
            Self::RigidBody(body) => Some(&body.name),
            Self::Skeleton(skeleton) => Some(&skeleton.name),
            Self::ForcePlate(plate) => Some(&plate.serial),
            Self::Device(device) => Some(&device.name),
            Self::Camera(camera) => Some(&camera.name),
            Self::Asset(asset) => Some(&asset.name),
            Self::Unknown { .. } => None,
        }
    }
}

/// A set of markers: a name, a count and as many names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MarkerSetDescription {
    /// Name of the set; `all` holds the markers of every set.
    pub name: Name,
    /// Names of the markers, in the order of the frames.
    pub markers: Vec<Name>,
}

/// Names of the sections in errors and explanations.
pub(crate) mod section {
    pub(crate) const PREFIX: &str = "descriptions";

    /// The section of a type.
    pub(crate) const fn of(kind: i32) -> &'static str {
        match kind {
            0 => "marker set description",
            1 => "rigid body description",
            2 => "skeleton description",
            3 => "force plate description",
            4 => "device description",
            5 => "camera description",
            6 => "asset description",
            _ => "unknown description",
        }
    }
}
