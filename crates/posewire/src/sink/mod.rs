//! Where frames go.

mod mxtp;
mod natnet;
mod progress;
mod take;

pub use mxtp::{MxtpSink, MxtpSinkOptions};
pub use natnet::{NatNetSink, NatNetSinkOptions};
pub use progress::{ClientProgress, ClientState, LeftOut, Progress, TargetProgress};
pub use take::TakeSink;

use crate::queue::Policy;
use crate::{Item, Result};

/// Something that takes what a source gives: a network target, a file, a page, your code.
///
/// Each sink runs on a thread of its own behind a bounded queue, so a slow one delays nobody.
pub trait Sink: Send {
    /// What its queue does when it is full, and how many items it holds.
    ///
    /// A `Lossless` queue makes a file source wait; a live source cannot wait, so what finds no room is dropped and
    /// counted in [`Outcome::dropped`](crate::Outcome::dropped).
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, 1024)
    }

    /// Takes one item.
    ///
    /// # Errors
    /// Whatever keeps the sink from going on; it is then finished and the session ends.
    fn accept(&mut self, item: &Item) -> Result<()>;

    /// Ends the sink's work: everything accepted is on its way, files are closed.
    ///
    /// # Errors
    /// What could not be brought to its end.
    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}
