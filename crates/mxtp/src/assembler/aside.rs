//! Datagrams put aside until it shows whether their sample begins a session.

use super::character::is_newer;
use super::counters::Fate;
use crate::{DatagramCounter, Header, MessageType};
use posewire_motion::Stamp;
use std::mem::size_of;

/// Datagrams of the few samples that may begin a session, in the order of their arrival.
#[derive(Debug, Default)]
pub(super) struct Aside {
    held: Vec<Held>,
    bytes: usize,
}

/// A datagram that is counted already, as what it is if its sample begins no session.
#[derive(Debug)]
pub(super) struct Held {
    pub(super) now: Stamp,
    pub(super) sample: u32,
    pub(super) message_type: MessageType,
    pub(super) bytes: Vec<u8>,
    pub(super) fate: Fate,
    /// How many messages of its stream had come in their order.
    pub(super) in_order: i64,
    /// Whether a newer message of its type came before it.
    pub(super) overtaken: bool,
    counter: DatagramCounter,
}

impl Held {
    pub(super) fn new(now: Stamp, header: &Header, bytes: &[u8], (fate, in_order): (Fate, i64)) -> Self {
        Self {
            now,
            sample: header.sample,
            message_type: header.message_type,
            bytes: bytes.to_vec(),
            fate,
            in_order,
            overtaken: false,
            counter: header.counter,
        }
    }

    fn is_overtaken_by(&self, other: &Self) -> bool {
        self.counter.index() == 0 && self.message_type == other.message_type && is_newer(other.sample, self.sample)
    }

    fn size(&self) -> usize {
        self.bytes.len() + size_of::<Self>()
    }
}

impl Aside {
    /// Whether the same datagram is there.
    pub(super) fn has(&self, header: &Header) -> bool {
        let key = (header.sample, header.message_type, header.counter);
        let mut keys = self
            .held
            .iter()
            .map(|held| (held.sample, held.message_type, held.counter));
        keys.any(|held| held == key)
    }

    /// Puts a datagram aside, unless there is no room for it.
    pub(super) fn put(&mut self, datagram: Held) {
        if self.held.len() < MAX_DATAGRAMS && self.bytes + datagram.size() <= MAX_BYTES {
            self.bytes += datagram.size();
            self.held.push(datagram);
        }
    }

    /// Drops those that are of no such sample.
    pub(super) fn retain(&mut self, is_kept: impl Fn(u32) -> bool) {
        if !self.held.is_empty() {
            self.held.retain(|held| is_kept(held.sample));
            self.bytes = self.held.iter().map(Held::size).sum();
        }
    }

    /// Takes out all of them, in the order of their samples.
    pub(super) fn take(&mut self) -> Vec<Held> {
        self.bytes = 0;
        let mut held = std::mem::take(&mut self.held);
        for place in 1..held.len() {
            let (earlier, later) = held.split_at_mut(place);
            let datagram = &mut later[0];
            datagram.overtaken = earlier.iter().any(|other| datagram.is_overtaken_by(other));
        }
        let first = held.iter().map(|held| held.sample).reduce(older);
        held.sort_by_key(|held| held.sample.wrapping_sub(first.unwrap_or_default()));
        held
    }

    /// Bytes held.
    pub(super) const fn buffered(&self) -> usize {
        self.bytes
    }
}

/// The one of two samples that comes before the other.
fn older(one: u32, other: u32) -> u32 {
    if is_newer(one, other) { other } else { one }
}

/// Eight samples of 64 datagrams.
const MAX_DATAGRAMS: usize = 512;
const MAX_BYTES: usize = 256 << 10;
