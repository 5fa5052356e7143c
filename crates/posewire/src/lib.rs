//! The motion-capture streaming engine: sources, sessions and sinks.
//!
//! This crate is the only place of the project with sockets, files, threads and clocks; the
//! protocol crates below it are pure.
//!
//! ```
//! use posewire::endpoint::Endpoint;
//!
//! let endpoint: Endpoint = "mxtp://239.255.42.99?interface=eth0".parse()?;
//! assert_eq!(endpoint.to_string(), "mxtp://239.255.42.99:9763?interface=eth0");
//!
//! let error = "mxtp://localhost?tll=4".parse::<Endpoint>().unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "mxtp://localhost?tll=4: unknown option \"tll\", expected interface or ttl"
//! );
//! # Ok::<(), posewire::Error>(())
//! ```

pub mod clock;
pub mod endpoint;
mod error;
pub mod histogram;
mod item;
pub mod net;
pub mod pacer;
pub mod queue;
mod session;
pub mod sink;
pub mod source;
pub mod stats;
pub mod stop;

pub use error::{Error, Result};
pub use item::{Item, Notice};
pub use session::{Outcome, Session};
pub use sink::Sink;
pub use source::Source;
