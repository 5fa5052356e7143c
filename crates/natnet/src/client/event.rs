//! What a client tells.

use std::net::SocketAddr;
use std::sync::Arc;

use posewire_motion::Stamp;

use super::{ClockEstimate, FrameOrder};
use crate::command::{Response, ServerInfo, Text};
use crate::frame::Frame;
use crate::model::Model;
use crate::{Error, MessageId, Quirks, Version};

/// What has happened to a client.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A server has answered that was not known, was lost, or is not what it was.
    Connected {
        /// Its command endpoint.
        server: SocketAddr,
        /// What it says about itself.
        info: ServerInfo,
    },
    /// Frames and descriptions are read as this version from now on: after
    /// [`Connected`](Self::Connected), and whenever the server says otherwise.
    Version(Version),
    /// The descriptions, asked for at the beginning and whenever they have changed.
    Model {
        /// The descriptions.
        model: Arc<Model>,
        /// What was unusual about them.
        quirks: Quirks,
    },
    /// A frame.
    Frame(ReceivedFrame),
    /// A line for the log.
    Message(Text),
    /// The server's clock, read once more.
    Clock(ClockEstimate),
    /// What became of a [`request`](super::Client::request).
    Answer {
        /// The text of the request.
        request: String,
        /// What came back.
        answer: Answer,
    },
    /// The server is gone. The client tries to connect again until it is dropped.
    Lost(LostReason),
    /// A datagram of the server that cannot be read.
    Malformed {
        /// Its kind, where that can be read.
        id: Option<MessageId>,
        /// What is wrong with it.
        error: Error,
    },
}

/// A frame as it came.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceivedFrame {
    /// The frame.
    pub frame: Arc<Frame>,
    /// When it arrived.
    pub received: Stamp,
    /// How its number follows those before.
    pub order: FrameOrder,
    /// Whether a frame with a higher number had come before it: one that is late, or repeats an older one.
    pub late: bool,
    /// What was unusual about it.
    pub quirks: Quirks,
}

/// What came back for a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The server's answer. A command that worked gives the number 0.
    Response(Response),
    /// The server does not know the request.
    Unrecognized,
    /// Nothing, though asked three times.
    Nothing,
}

/// How a server was lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LostReason {
    /// Nothing has come from it for [`lost_after`](super::ClientOptions::lost_after).
    Silent,
    /// It says that the client was silent for too long.
    TimedOut,
    /// It has said goodbye.
    Closed,
}
