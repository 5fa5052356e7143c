//! What every request can see.

use crate::counts::Counts;
use crate::guard::Guard;
use crate::{Content, Feed};
use std::sync::Arc;
use tokio::sync::watch;

/// What every request can see.
#[derive(Debug)]
pub(crate) struct App {
    pub(crate) content: Content,
    pub(crate) guard: Guard,
    pub(crate) counts: Arc<Counts>,
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
            Content::Live(feed) => feed.scene(false, is_message),
            Content::Takes(takes) => takes.scene(is_message),
        }
    }
}
