//! What a state machine wants done.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::Arc;

use crate::{Error, Message, Version};

/// What follows from what a state machine was told: something to know, or something to send.
#[derive(Clone, Debug, PartialEq)]
pub enum Output<E> {
    /// Something has happened.
    Event(E),
    /// A datagram to send.
    Transmit(Transmit),
}

/// A datagram to send. The bytes are shared by all who get the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transmit {
    /// The socket to send it from.
    pub socket: Socket,
    /// Where to.
    pub to: SocketAddr,
    /// The packet.
    pub bytes: Arc<[u8]>,
}

/// The sockets of a server. A client sends from its command socket only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Socket {
    /// Commands: a server's is bound to 1510, a client's to any port. Unicast frames come to it.
    Command,
    /// Frames: a server's is bound to the data port, because some clients take frames from no other;
    /// a client's is bound to the data port and has joined the group.
    Data,
}

/// Outputs on their way out. The oldest are lost when nobody takes them, and counted.
#[derive(Debug)]
pub(crate) struct Outputs<E> {
    queue: VecDeque<Output<E>>,
    dropped: u64,
}

impl<E> Outputs<E> {
    pub(crate) const fn new() -> Self {
        Self {
            queue: VecDeque::new(),
            dropped: 0,
        }
    }

    pub(crate) fn event(&mut self, event: E) {
        self.push(Output::Event(event));
    }

    pub(crate) fn transmit(&mut self, socket: Socket, to: SocketAddr, bytes: Arc<[u8]>) {
        self.push(Output::Transmit(Transmit { socket, to, bytes }));
    }

    /// Sends a command, whose layout depends on no version.
    pub(crate) fn command(&mut self, to: SocketAddr, message: &Message) {
        if let Ok(bytes) = encode(message, Version::LATEST) {
            self.transmit(Socket::Command, to, bytes);
        }
    }

    pub(crate) fn pop(&mut self) -> Option<Output<E>> {
        self.queue.pop_front()
    }

    pub(crate) const fn dropped(&self) -> u64 {
        self.dropped
    }

    fn push(&mut self, output: Output<E>) {
        if self.queue.len() == MAX_OUTPUTS {
            self.queue.pop_front();
            self.dropped += 1;
        }
        self.queue.push_back(output);
    }
}

/// The packet of a message.
pub(crate) fn encode(message: &Message, version: Version) -> Result<Arc<[u8]>, Error> {
    let mut bytes = Vec::new();
    message.encode(version, &mut bytes)?;
    Ok(bytes.into())
}

/// More than one call can bring: a frame for every client, with its copy, and then some.
const MAX_OUTPUTS: usize = 512;
