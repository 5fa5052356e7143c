//! The motion-capture streaming engine: sources, sessions and sinks.
//!
//! This crate is the only place of the project with sockets, files, threads and clocks; the
//! protocol crates below it are pure.
//!
//! Any number of [`Source`]s feed any number of [`Sink`]s in a [`Session`], each on a thread of its own, each sink behind a
//! bounded queue:
//!
//! ```
//! use posewire::source::PlaybackOptions;
//! use posewire::stop::Stop;
//! use posewire::{Item, Session, Sink, Source, SourceId};
//! use std::time::Duration;
//!
//! struct Hips;
//!
//! impl Sink for Hips {
//!     fn accept(&mut self, _: SourceId, item: &Item) -> posewire::Result<()> {
//!         if let Item::Frame { frame, .. } = item {
//!             println!("{} {:?}", frame.subject.name, frame.position[0]);
//!         }
//!         Ok(())
//!     }
//! }
//!
//! let options = PlaybackOptions { duration: Some(Duration::from_millis(50)), ..PlaybackOptions::default() };
//! let source = Source::open(&"synthetic:walk?people=2&rate=240".parse()?, &options)?;
//! let outcome = Session::start([source], vec![Box::new(Hips)], Stop::new()).wait()?;
//! assert_eq!(outcome.dropped, 0);
//! # Ok::<(), posewire::Error>(())
//! ```

mod beside;
pub mod capture;
pub mod clock;
mod datagram;
pub mod doctor;
pub mod endpoint;
mod error;
pub mod faults;
pub mod file;
pub mod histogram;
mod item;
pub mod json;
pub mod net;
pub mod pacer;
pub mod queue;
pub mod recording;
pub mod remote;
pub mod replay;
mod session;
pub mod sink;
pub mod source;
pub mod stats;
pub mod stop;

pub use datagram::{Datagram, Wire};
pub use error::{Error, Result};
pub use item::{Foremost, Item, Notice, SourceId};
pub use session::{Feed, Outcome, Session};
pub use sink::{Sink, Wants};
pub use source::Source;

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
