//! Who gets frames.

use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

use posewire_motion::Stamp;

use crate::Version;

/// A client of a server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectedClient {
    /// The endpoint that it connected from.
    pub address: SocketAddr,
    /// The version that it gets.
    pub version: Version,
    /// When something last came from it.
    pub heard: Stamp,
    /// Whether it has ever sent a keep-alive. Some clients never do.
    pub keeps_alive: bool,
    /// Whether it has sent anything but connects.
    pub has_spoken: bool,
}

/// The clients, in the order in which they have connected.
#[derive(Debug, Default)]
pub(super) struct Clients {
    list: Vec<ConnectedClient>,
}

/// What a connect has led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Admission {
    New,
    Known,
    Refused,
}

impl Clients {
    pub(super) const fn new() -> Self {
        Self { list: Vec::new() }
    }

    pub(super) fn as_slice(&self) -> &[ConnectedClient] {
        &self.list
    }

    pub(super) fn find(&self, address: SocketAddr) -> Option<&ConnectedClient> {
        self.list.iter().find(|client| client.address == address)
    }

    pub(super) fn find_mut(&mut self, address: SocketAddr) -> Option<&mut ConnectedClient> {
        self.list.iter_mut().find(|client| client.address == address)
    }

    /// Adds a client, or takes over the new wish of a known one, which is new by that.
    pub(super) fn admit(&mut self, client: ConnectedClient) -> Admission {
        if let Some(known) = self.find_mut(client.address) {
            let same = known.version == client.version;
            known.version = client.version;
            known.heard = client.heard;
            return if same { Admission::Known } else { Admission::New };
        }
        if self.list.len() == MAX_CLIENTS {
            return Admission::Refused;
        }
        self.list.push(client);
        Admission::New
    }

    pub(super) fn remove(&mut self, address: SocketAddr) -> bool {
        let before = self.list.len();
        self.list.retain(|client| client.address != address);
        self.list.len() < before
    }

    /// Removes one client that has been silent for `limit`, or stays in spite of that where `spare` says so.
    pub(super) fn remove_silent(&mut self, now: Stamp, limit: Duration, spare: bool) -> Option<SocketAddr> {
        let is_silent = |client: &ConnectedClient| now.since(client.heard) >= limit;
        let mut places = 0..self.list.len();
        let place = places.find(|place| is_silent(&self.list[*place]) && !(spare && self.is_spared(*place)))?;
        Some(self.list.remove(place).address)
    }

    /// When somebody who is not spared was last heard, the longest ago.
    pub(super) fn longest_silent(&self, spare: bool) -> Option<Stamp> {
        let places = (0..self.list.len()).filter(|place| !(spare && self.is_spared(*place)));
        places.map(|place| self.list[place].heard).min()
    }

    /// Whether a client never keeps alive and is the last that its host has brought: it may well be there still.
    fn is_spared(&self, place: usize) -> bool {
        let client = self.list[place];
        let is_same_host = |other: &ConnectedClient| other.address.ip() == client.address.ip();
        !client.keeps_alive && !self.list[place + 1..].iter().any(is_same_host)
    }

    /// The client of every host that has connected last.
    pub(super) fn last_of_each_host(&self) -> Vec<ConnectedClient> {
        let mut hosts: Vec<IpAddr> = Vec::new();
        let is_first = |client: &&ConnectedClient| {
            let new = !hosts.contains(&client.address.ip());
            if new {
                hosts.push(client.address.ip());
            }
            new
        };
        self.list.iter().rev().filter(is_first).copied().collect()
    }
}

pub(super) const MAX_CLIENTS: usize = 64;
