//! What every request can see.

use crate::counts::Counts;
use crate::guard::Guard;
use crate::recorder::RecorderRecord;
use crate::{Content, Feed, Recorder};
use std::sync::{Arc, Mutex, PoisonError};
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
    /// The scene as it was written last, and its version.
    pub(crate) written: Mutex<Option<(u64, String)>>,
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

    /// The scene as JSON; as a message of the socket, it says so. It is written once for all pages, until it changes.
    pub(crate) fn scene(&self, is_message: bool) -> String {
        let version = self.feed().map_or(0, Feed::version);
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let is_old = written.as_ref().is_none_or(|(known, _)| *known != version);
        if is_old {
            *written = Some((version, self.write_scene()));
        }
        let text = written.as_ref().map_or("{}", |(_, text)| text);
        if is_message {
            format!("{{\"type\":\"scene\",{}", &text[1..])
        } else {
            text.to_owned()
        }
    }

    fn write_scene(&self) -> String {
        match &self.content {
            Content::Live(feed) => feed.scene(self.recorder.is_some()),
            Content::Takes(takes) => takes.scene(),
        }
    }
}
