//! The end of a feed that a session fills.

use crate::Feed;
use posewire::queue::Policy;
use posewire::{Item, Result, Sink, SourceId, Wants};

/// A sink that puts what comes into a [`Feed`].
///
/// Its queue keeps the newest: pages that show poses want those, and the session never waits.
#[derive(Debug)]
pub struct ViewerSink {
    feed: Feed,
}

impl ViewerSink {
    /// The sink that fills `feed`.
    pub fn new(feed: &Feed) -> Self {
        Self { feed: feed.clone() }
    }
}

impl Sink for ViewerSink {
    fn queue(&self) -> (Policy, usize) {
        (Policy::Newest, QUEUED)
    }

    fn wants(&self) -> Wants {
        Wants {
            ahead: true,
            ..Wants::default()
        }
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        self.feed.take(source, item);
        Ok(())
    }

    fn dropped(&mut self, dropped: u64) {
        self.feed.set_dropped(dropped);
    }

    fn finish(&mut self) -> Result<()> {
        self.feed.end();
        Ok(())
    }
}

/// Two seconds of 16 people at 240 Hz.
const QUEUED: usize = 8192;
