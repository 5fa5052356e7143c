//! Which servers are there?

use std::net::SocketAddr;
use std::time::Duration;

use posewire_motion::Stamp;

use crate::command::{Sender, ServerInfo};
use crate::output::Outputs;
use crate::retry::Retry;
use crate::{Message, MessageId, Output, Packet};

/// A server that has answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Its command endpoint.
    pub server: SocketAddr,
    /// What it says about itself.
    pub info: ServerInfo,
}

/// Asks everybody three times within a second who they are, and tells of every server once.
///
/// It is driven as a [`Client`](super::Client) is, and has ended when [`timeout`](Self::timeout) is `None`.
/// At most 64 servers are told of.
#[derive(Debug)]
pub struct Discovery {
    sender: Sender,
    targets: Vec<SocketAddr>,
    retry: Retry,
    asked: u32,
    found: Vec<SocketAddr>,
    outputs: Outputs<Found>,
}

impl Discovery {
    /// Begins to ask at `now`. The targets are command endpoints: broadcast addresses of networks, or single
    /// hosts.
    pub fn new(now: Stamp, sender: Sender, targets: Vec<SocketAddr>) -> Self {
        let mut discovery = Self {
            sender,
            targets,
            retry: Retry::every(Duration::from_millis(400)),
            asked: 0,
            found: Vec::new(),
            outputs: Outputs::new(),
        };
        discovery.retry.start(now);
        discovery.handle_timeout(now);
        discovery
    }

    /// Takes in one datagram.
    pub fn handle(&mut self, from: SocketAddr, bytes: &[u8]) {
        let Ok(packet) = Packet::decode(bytes) else { return };
        if packet.id != MessageId::SERVER_INFO || self.found.len() == MAX_FOUND || self.found.contains(&from) {
            return;
        }
        if let Ok((info, _)) = ServerInfo::decode(packet.payload) {
            self.found.push(from);
            self.outputs.event(Found { server: from, info });
        }
    }

    /// Asks again, or ends.
    pub fn handle_timeout(&mut self, now: Stamp) {
        if !self.retry.is_due(now) {
            return;
        }
        if self.asked == QUESTIONS {
            self.retry.stop();
            return;
        }
        self.asked += 1;
        let question = Message::Discovery(Some(self.sender.clone()));
        for target in &self.targets {
            self.outputs.command(*target, &question);
        }
    }

    /// The next server, or question to send. Call it until it returns `None`, after every other call.
    pub fn poll(&mut self) -> Option<Output<Found>> {
        self.outputs.pop()
    }

    /// When [`handle_timeout`](Self::handle_timeout) is next due; `None` at the end.
    pub fn timeout(&self) -> Option<Stamp> {
        self.retry.next()
    }
}

const QUESTIONS: u32 = 3;
const MAX_FOUND: usize = 64;
