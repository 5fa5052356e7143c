//! What every request can see.

use crate::counts::Counts;
use crate::guard::Guard;
use crate::recorder::RecorderRecord;
use crate::{Content, Feed, Recorder};
use std::sync::Arc;
use tokio::sync::watch;

/// What every request can see.
#[derive(Debug)]
pub(crate) struct App {
    pub(crate) content: Content,
    pub(crate) guard: Guard,
    pub(crate) counts: Arc<Counts>,
    pub(crate) recorder: Option<Recorder>,
    /// What it does, looked at again and again: to look waits for the disk, which nothing here may.
    pub(crate) recorded: Option<watch::Receiver<RecorderRecord>>,
    /// Whether the server is to stop.
    pub(crate) stop: watch::Receiver<bool>,
}

impl App {
    /// The live feed, unless takes are shown.
    pub(crate) fn feed(&self) -> Option<&Feed> {
        match &self.content {
            Content::Live(feed) => Some(feed),
            Content::Takes(_) => None,
        }
    }

    /// The scene as JSON; as a message of the socket, it says so.
    pub(crate) fn scene(&self, is_message: bool) -> String {
        match &self.content {
            Content::Live(feed) => feed.scene(self.recorder.is_some(), is_message),
            Content::Takes(takes) => takes.scene(is_message),
        }
    }
}
