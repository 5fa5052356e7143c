//! What a motion-capture pose is: space, time, skeleton, frame and take.
//!
//! Every protocol and file of posewire is translated to the types of this crate and back. They know no bytes, no
//! sockets and no files. One convention holds throughout, the *canonical* one:
//!
//! - metres, radians, seconds;
//! - right-handed axes, X forward, Y left, Z up;
//! - `f64` values, quaternions as w, x, y, z, every segment's orientation the identity in the T-pose;
//! - what was not measured, or not tracked, is `None` and never zero.
//!
//! ```
//! use posewire_motion::{DVec3, Frame, Skeleton, Space, Subject};
//! use std::sync::Arc;
//!
//! let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
//! let mut frame = Frame::new(subject);
//! frame.position = vec![Some(DVec3::new(0.1, 0.2, 0.95)); 23];
//! assert_eq!(frame.subject.skeleton.segments[6].name, "Head");
//!
//! // The same point for a game engine that is left-handed and Y-up.
//! let unity = Space::UNITY.position_from_canonical(DVec3::new(1.0, 2.0, 3.0));
//! assert_eq!(unity, DVec3::new(-2.0, 3.0, 1.0));
//! ```

mod column;
mod entries;
mod error;
mod frame;
pub mod kinematics;
mod pose;
pub mod rotation;
mod section;
mod skeleton;
mod space;
pub mod standard;
mod subject;
mod take;
mod time;

pub use column::Column;
pub use entries::Entries;
pub use error::Error;
pub use frame::{CenterOfMass, Frame, Marker};
pub use glam::{DMat3, DQuat, DVec3};
pub use pose::Pose;
pub use section::{Per, Section};
pub use skeleton::{Connector, ErgonomicAngle, Joint, Point, Segment, SegmentKind, Skeleton};
pub use space::{Handedness, Space, Unit, Up};
pub use subject::{Color, Subject};
pub use take::{Frames, Reordered, Take};
pub use time::{Stamp, Timecode};
