//! Between NatNet's frames and descriptions and canonical frames, in both directions.
//!
//! | NatNet | motion |
//! |---|---|
//! | skeleton, or asset with bones | a subject with a segment for each bone |
//! | rigid body of its own | a subject with one segment |
//! | labeled marker of an asset | a marker of the asset's subject, numbered as the asset's member |
//! | other markers | one subject, `Markers`, without segments |
//! | bit "tracking valid" off | `None` |
//!
//! [`Subjects`] reads a server's stream and [`Encoder`] writes one. Neither knows a socket or a clock. Values that are
//! global on the wire keep their `f32` bits from NatNet to motion and back.
//!
//! Which axis is up and whether bones are relative to their parents is told by no packet: see [`Settings`]. Bone offsets
//! in descriptions are taken as right-handed in every version; Motive's own are left-handed before 3.0, and nothing
//! public says which axis is mirrored, so null poses of Motive before 3.0 are not to be trusted.

mod clock;
mod describe;
mod encode;
mod figure;
mod lacks;
mod markers;
mod points;
mod settings;
mod subjects;

pub use encode::Encoder;
pub use lacks::lacks;
pub use markers::OTHER_MARKERS;
pub use settings::{Coordinates, Settings};
pub use subjects::{Entity, Subjects};
