//! Between the messages on the wire and canonical frames, in both directions.
//!
//! | type | wire | frame |
//! |---|---|---|
//! | 01 | Y-up, cm, Euler angles in degrees | position, orientation |
//! | 02 | Z-up, m, quaternion | position, orientation |
//! | 03 | Y-up, cm | markers |
//! | 05 | Unity: Y-up, left-handed, m, relative to the parent | position, orientation |
//! | 20 | degrees | joint and ergonomic angles |
//! | 21 | Z-up, m, s | position, velocity, acceleration |
//! | 22 | Z-up, rad, s | orientation, angular velocity, angular acceleration |
//! | 23 | Z-up, m, rad, s | the sensors' sections |
//! | 24 | Z-up, m, s | centre of mass |
//! | 25 | `HH:MM:SS.mmm` | timecode |
//!
//! A frame's `f64` values keep every `f32` of the wire: decoding and encoding again gives the same bits (a NaN stays one),
//! except for the angles of type 01 (the same rotation within 5e-7 rad) and the relative poses of type 05 (within 2e-6).

mod character;
mod convert;
mod datagrams;
mod decode;
mod encode;
mod joints;
mod lacks;
mod landmarks;
mod message;
mod place;
mod sections;
mod sensors;
mod types;
mod unity;

pub use datagrams::Datagrams;
pub use decode::Filler;
pub use encode::{Encoder, EncoderOptions};
pub use lacks::lacks;
pub use landmarks::LANDMARKS;
pub use sections::{carriers, has_place, needed_sections, sections};
pub use types::MessageTypes;
