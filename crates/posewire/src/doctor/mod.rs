//! Why nothing arrives, or what is wrong with what does.
//!
//! A [`Listener`] opens an endpoint as every source is opened, listens for a while and says what it found; [`examine_system`] says
//! who listens where, and what of this machine may be in the way. Each [`Finding`] says what it is, why it matters and what
//! to do. An [`Examination`] is the part without sockets: it takes items as they come and judges them.
//!
//! ```
//! use posewire::doctor::{Check, Listener};
//! use posewire::source::PlaybackOptions;
//! use posewire::stop::Stop;
//! use std::time::Duration;
//!
//! let nobody_sends = Listener::open(&"mxtp://127.0.0.1:0".parse()?, &PlaybackOptions::default())?;
//! let listened = nobody_sends.listen(Duration::from_millis(50), &Stop::new())?;
//! assert_eq!(listened.findings[0].check, Check::NothingArrives);
//! # Ok::<(), posewire::Error>(())
//! ```

mod axes;
mod check;
mod clocks;
mod contents;
mod examination;
mod examiner;
mod figures;
mod finding;
mod landmarks;
mod lengths;
mod listen;
mod losses;
mod natnet;
mod neighbours;
mod orientation;
mod paces;
mod protocol;
mod senders;
mod silence;
mod sizes;
mod summary;
mod system;
#[cfg(test)]
mod test;
mod values;

pub use check::Check;
pub use examination::Examination;
pub use finding::{Finding, Severity};
pub use listen::{Listened, Listener};
pub(crate) use senders::Senders;
pub use system::examine_system;
