//! NatNet, the bitstream of OptiTrack Motive, in both directions and in every version.
//!
//! The crate turns bytes into frames, descriptions and commands and back. It has no socket, no file
//! and no clock. Versions 1.4 to 4.5 are spoken: [`Version`] says what each of them has.
//! [`client::Client`] and [`server::Server`] are the two ends, which are told the time and what arrives
//! and say what to send.
//!
//! ```
//! use posewire_natnet::frame::{BodyParams, Frame, RigidBody};
//! use posewire_natnet::{Message, Version};
//!
//! let version = Version::new(3, 1);
//! let body = RigidBody {
//!     id: 1,
//!     position: [0.1, 1.5, -0.25],
//!     orientation: [0.0, 0.0, 0.0, 1.0],
//!     params: Some(BodyParams::TRACKED),
//!     ..RigidBody::default()
//! };
//! let frame = Frame {
//!     number: 27_837,
//!     rigid_bodies: vec![body],
//!     timestamp: Some(231.975),
//!     ..Frame::default()
//! };
//! let mut bytes = Vec::new();
//! Message::Frame(frame.into()).encode(version, &mut bytes)?;
//!
//! let (message, quirks) = Message::decode(version, &bytes)?;
//! assert_eq!(
//!     message.to_string(),
//!     "NatNet FRAMEOFDATA frame 27837: 1 of 1 bodies tracked, time 231.975s",
//! );
//! assert!(quirks.is_empty());
//! # Ok::<(), posewire_natnet::Error>(())
//! ```

pub mod client;
pub mod command;
pub mod frame;
pub mod model;
pub mod motion;
pub mod server;

mod error;
mod explain;
mod line;
mod message;
mod name;
mod output;
mod packet;
mod quirk;
mod reader;
mod record;
mod retry;
mod version;
mod writer;

pub use error::Error;
pub use explain::{Explanation, Field, Value, explain};
pub use message::Message;
pub use name::Name;
pub use output::{Output, Socket, Transmit};
pub use packet::{MessageId, Packet};
pub use quirk::{Quirk, Quirks};
pub use version::Version;
