//! Where frames go.

mod mxtp;
mod natnet;
mod notices;
mod progress;
mod record;
mod take;
mod takes;

pub(crate) use mxtp::Target as MxtpTarget;
pub use mxtp::{Fit, MxtpSink, MxtpSinkOptions, MxtpTargets};
pub(crate) use natnet::{FaultyFrames, Ledger as NatNetLedger, Ports as NatNetPorts};
pub use natnet::{NatNetSink, NatNetSinkOptions};
pub use progress::{ClientProgress, ClientState, LeftOut, Progress, TargetProgress};
pub use record::{RecordOptions, RecordProgress, RecordSink, RecordedSource, RecordedSubject};
pub use take::TakeSink;
pub use takes::{TakeProgress, Takes, TakesProgress, TakesSink};

use crate::queue::Policy;
use crate::{Error, Item, Result, SourceId};
use std::time::Instant;

/// Something that takes what a source gives: a network target, a file, a page, your code.
///
/// Each sink runs on a thread of its own behind a bounded queue, so a slow one delays nobody.
pub trait Sink: Send {
    /// What its queue does when it is full, and how many items it holds. Whatever their number, it holds no more than 128 MiB.
    ///
    /// A `Lossless` queue makes a file source wait; a live source cannot wait, so what finds no room is dropped and
    /// counted in [`Outcome::dropped`](crate::Outcome::dropped).
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, 1024)
    }

    /// Which items it takes. What no sink wants costs nothing.
    fn wants(&self) -> Wants {
        Wants::default()
    }

    /// Takes one item of a source.
    ///
    /// Numbers of subjects are those of the source: two sources may have different subjects of the same number.
    ///
    /// # Errors
    /// Whatever keeps the sink from going on; it is then finished and the session ends.
    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()>;

    /// Hears that its queue had no room for items of a live source: `dropped` of them since the start.
    fn dropped(&mut self, dropped: u64) {
        let _ = dropped;
    }

    /// When it has something to do even if no item comes.
    fn timeout(&self) -> Option<Instant> {
        None
    }

    /// Does what was to be done at its [`timeout`](Self::timeout).
    ///
    /// # Errors
    /// As [`accept`](Self::accept).
    fn handle_timeout(&mut self) -> Result<()> {
        Ok(())
    }

    /// Ends the sink's work: everything accepted is on its way, files are closed.
    ///
    /// # Errors
    /// What could not be brought to its end.
    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Which items a sink takes. Statistics and notices come to every sink.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wants {
    /// Subjects and their frames.
    pub frames: bool,
    /// Datagrams as they arrived, each before what was read from it.
    pub datagrams: bool,
    /// Complete samples also ahead of their turn, as [`Item::Ahead`]: for who shows or uses the newest. Which of all samples
    /// are the newest then, [`Foremost`](crate::Foremost) tells.
    pub ahead: bool,
}

impl Wants {
    /// Everything there is, once.
    pub const ALL: Self = Self {
        frames: true,
        datagrams: true,
        ahead: false,
    };

    /// Whether `item` is wanted.
    pub fn includes(self, item: &Item) -> bool {
        match item {
            Item::Datagram(_) => self.datagrams,
            Item::Subject(_) | Item::Frame { .. } => self.frames,
            Item::Ahead { .. } => self.ahead,
            Item::Statistics(_) | Item::Notice(_) => true,
        }
    }
}

impl Default for Wants {
    /// Frames, each in its turn, and no datagrams.
    fn default() -> Self {
        Self {
            frames: true,
            datagrams: false,
            ahead: false,
        }
    }
}

/// The source of a sink that numbers subjects as their source does, and so can take one source alone.
#[derive(Debug, Default)]
struct OnlySource(Option<SourceId>);

impl OnlySource {
    fn check(&mut self, source: SourceId) -> Result<()> {
        let only = *self.0.get_or_insert(source);
        if only == source {
            Ok(())
        } else {
            Err(Error::SeveralSources)
        }
    }
}
