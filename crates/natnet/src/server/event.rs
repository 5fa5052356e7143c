//! What a server tells.

use std::net::SocketAddr;

use crate::command::{Sender, Text};
use crate::{Error, MessageId, Version};

/// What has happened to a server.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A new client, or one that connects again with another wish (unicast).
    Connected {
        /// Its command endpoint.
        client: SocketAddr,
        /// Who it says it is.
        sender: Option<Sender>,
        /// The version that it gets.
        version: Version,
    },
    /// A client gets another version: it has asked for it.
    Version {
        /// Its command endpoint.
        client: SocketAddr,
        /// The version that it gets.
        version: Version,
    },
    /// A client is gone.
    Left {
        /// Its command endpoint.
        client: SocketAddr,
        /// Why.
        reason: LeftReason,
    },
    /// A client could not connect because there are 64.
    Refused {
        /// Its command endpoint.
        client: SocketAddr,
    },
    /// A request in text, whoever it is from.
    Request {
        /// Where it is from.
        from: SocketAddr,
        /// What it says.
        text: Text,
        /// Whether it got an answer that is not "unrecognized".
        recognized: bool,
    },
    /// The descriptions are too large for a version that a client has.
    ModelTooLarge {
        /// Its command endpoint.
        client: SocketAddr,
        /// How large they are.
        error: Error,
    },
    /// A datagram that cannot be read.
    Malformed {
        /// Where it is from.
        from: SocketAddr,
        /// Its kind, where that can be read.
        id: Option<MessageId>,
        /// What is wrong with it.
        error: Error,
    },
}

/// Why a client is gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LeftReason {
    /// It has said so.
    Disconnected,
    /// Nothing has come from it for [`silence_limit`](super::ServerOptions::silence_limit).
    Silent,
}
