//! MXTP, the real-time network stream of Xsens MVN, in both directions.
//!
//! The crate turns bytes into typed datagrams and back. It has no socket, no file and no clock.
//! Both revisions of the specification are spoken: MV0305 Rev J (MVN Studio) and Rev N (MVN Analyze
//! and Animate). Section numbers in this documentation are those of Rev N.
//!
//! ```
//! use posewire_mxtp::body::{Body, QuaternionSegment};
//! use posewire_mxtp::ids::{SegmentCounts, SegmentId};
//! use posewire_mxtp::{Datagram, Header, MessageType};
//!
//! let segments: Vec<_> = (1..=23)
//!     .map(|id| QuaternionSegment::new(SegmentId(id), [0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]))
//!     .collect();
//! let header = Header::rev_n(MessageType::QUATERNION, 6681, 27_837, SegmentCounts::BODY);
//! let sent = Datagram::new(header, Body::Quaternion(&segments))?;
//! let mut bytes = Vec::new();
//! sent.encode(&mut bytes);
//!
//! let datagram = Datagram::decode(&bytes)?;
//! assert_eq!(
//!     datagram.to_string(),
//!     "MXTP02 char 0 sample 6681 time 27.837s 0x80 23 segments, pelvis (0.000, 0.000, 1.000)",
//! );
//! # Ok::<(), posewire_mxtp::Error>(())
//! ```

pub mod body;
pub mod ids;
pub mod motion;
pub mod remote;

mod assembler;
mod datagram;
mod description;
mod error;
mod explain;
mod framing;
mod header;
mod message_type;
mod quirk;
mod sequence;

pub use assembler::{Assembler, AssemblerOptions, Counters, Event, QuirkCounts, SampleCounts};
pub use datagram::Datagram;
pub use error::Error;
pub use explain::{Explanation, Field, Value, explain};
pub use framing::Framer;
pub use header::{DatagramCounter, Header, Revision};
pub use message_type::MessageType;
pub use quirk::{Quirk, Quirks};
pub use sequence::{Observation, ResetKind, Sequence, Tally};
