//! Who is served, and what became of what was sent.

use crate::Notice;
use crate::net::Sent;
use crate::sink::notices::Notices;
use crate::sink::{ClientProgress, ClientState, TargetProgress};
use posewire_natnet::Version;
use posewire_natnet::command::Sender;
use posewire_natnet::server::{Event, LeftReason};
use std::net::SocketAddr;

/// Who is served, and what became of the frames.
#[derive(Debug, Default)]
pub(crate) struct Ledger {
    clients: Vec<ClientProgress>,
    notices: Notices,
    datagrams: u64,
    congested: u64,
    refused: u64,
    too_large: u64,
}

impl Ledger {
    /// Enters what a server tells of its clients.
    pub(crate) fn note(&mut self, event: Event) {
        match event {
            Event::Connected {
                client,
                sender,
                version,
            } => self.connected(client, sender.as_ref(), version),
            Event::Version { client, version } => self.changed(client, version),
            Event::Left { client, reason } => self.left(
                client,
                match reason {
                    LeftReason::Silent => ClientState::Silent,
                    LeftReason::Disconnected => ClientState::Left,
                },
            ),
            other => tracing::warn!(event = ?other, "NatNet client"),
        }
    }

    /// Enters a client, or one that comes again.
    fn connected(&mut self, address: SocketAddr, sender: Option<&Sender>, version: Version) {
        self.notices.push(Notice::Connected {
            peer: who(address, &sender.map(name).unwrap_or_default()),
        });
        if let Some(known) = self.find(address) {
            (known.state, known.version) = (ClientState::Connected, version);
            return;
        }
        if self.clients.len() >= MAX_REMEMBERED {
            let gone = self
                .clients
                .iter()
                .position(|client| client.state != ClientState::Connected);
            gone.map(|place| self.clients.remove(place));
        }
        self.clients.push(ClientProgress {
            address,
            name: sender.map(name).unwrap_or_default(),
            version,
            state: ClientState::Connected,
            frames: 0,
            dropped: 0,
        });
    }

    fn changed(&mut self, address: SocketAddr, version: Version) {
        if let Some(client) = self.find(address) {
            client.version = version;
        }
    }

    fn left(&mut self, address: SocketAddr, state: ClientState) {
        let Some(client) = self.find(address) else { return };
        client.state = state;
        let peer = who(address, &client.name);
        self.notices.push(if state == ClientState::Silent {
            let reason = "nothing came from it any more".to_owned();
            Notice::Disconnected { peer, reason }
        } else {
            let text = format!("{peer} has left");
            Notice::Remark { text }
        });
    }

    /// Enters what became of one frame for `to`.
    pub(crate) fn count(&mut self, to: SocketAddr, sent: Sent) {
        let taken = matches!(sent, Sent::Taken);
        match sent {
            Sent::Taken => self.datagrams += 1,
            Sent::NoRoom => self.congested += 1,
            Sent::Refused => self.refused += 1,
            // No loss of this side: who has vanished is dropped for its silence.
            Sent::Nobody => {}
        }
        if let Some(client) = self.find(to) {
            client.frames += u64::from(taken);
            client.dropped += u64::from(!taken);
        }
    }

    /// Enters a frame that no datagram of some version can hold.
    pub(super) fn count_too_large(&mut self) {
        self.too_large += 1;
    }

    /// Whether the system has refused all that was tried so far.
    pub(super) fn is_refused(&self) -> bool {
        self.refused > 0 && self.datagrams == 0
    }

    /// How many clients are there now.
    pub(super) fn peers(&self) -> usize {
        let is_there = |client: &&ClientProgress| client.state == ClientState::Connected;
        self.clients.iter().filter(is_there).count()
    }

    pub(crate) fn progress(&self, endpoint: &str, multicast: bool) -> TargetProgress {
        TargetProgress {
            endpoint: endpoint.to_owned(),
            peers: if multicast { 1 } else { self.peers() },
            datagrams: self.datagrams,
            congested: self.congested,
            failed: self.refused + self.too_large,
            dropped: 0,
            clients: self.clients.clone(),
            notices: self.notices.to_vec(),
        }
    }

    fn find(&mut self, address: SocketAddr) -> Option<&mut ClientProgress> {
        self.clients.iter_mut().find(|client| client.address == address)
    }
}

/// A client's address and, where it has one, its name.
fn who(address: SocketAddr, name: &str) -> String {
    match name {
        "" => address.to_string(),
        name => format!("{address} ({name})"),
    }
}

/// What a client calls itself. Those of the vendor's Python sample write `Ping` there, which names nobody.
fn name(sender: &Sender) -> String {
    match sender.name.to_string() {
        ping if ping == "Ping" => String::new(),
        name => name,
    }
}

/// Twice as many clients as a server has at once.
const MAX_REMEMBERED: usize = 128;

#[cfg(test)]
mod tests {
    use super::*;

    fn client(port: u16) -> SocketAddr {
        ([127, 0, 0, 1], port).into()
    }

    #[test]
    fn what_a_client_did_not_get_is_no_loss_when_it_has_vanished() {
        let mut ledger = Ledger::default();
        ledger.connected(client(1), None, Version::new(4, 1));
        for sent in [Sent::Taken, Sent::NoRoom, Sent::Nobody] {
            ledger.count(client(1), sent);
        }
        let progress = ledger.progress("natnet://127.0.0.1", false);
        assert_eq!((progress.datagrams, progress.congested, progress.failed), (1, 1, 0));
        assert_eq!((progress.clients[0].frames, progress.clients[0].dropped), (1, 2));
    }

    #[test]
    fn who_came_and_went_is_told() {
        let mut ledger = Ledger::default();
        let sender = Sender {
            name: "ROS".into(),
            ..Sender::default()
        };
        for address in [client(1), client(2)] {
            ledger.connected(address, Some(&sender), Version::new(4, 1));
        }
        ledger.left(client(1), ClientState::Left);
        ledger.left(client(2), ClientState::Silent);
        let notices = ledger.progress("natnet://127.0.0.1", false).notices;
        let told: Vec<_> = notices.iter().map(ToString::to_string).collect();
        let expected = [
            "connected to 127.0.0.1:1 (ROS)",
            "connected to 127.0.0.1:2 (ROS)",
            "127.0.0.1:1 (ROS) has left",
            "lost the connection to 127.0.0.1:2 (ROS): nothing came from it any more",
        ];
        assert_eq!(told, expected);
    }

    #[test]
    fn ping_is_no_name() {
        let mut ledger = Ledger::default();
        for (port, name) in [(1, "Ping"), (2, "ROS")] {
            let sender = Sender {
                name: name.into(),
                ..Sender::default()
            };
            ledger.connected(client(port), Some(&sender), Version::new(4, 1));
        }
        let names = ledger.clients.iter().map(|client| client.name.as_str());
        assert_eq!(names.collect::<Vec<_>>(), ["", "ROS"]);
    }

    #[test]
    fn a_frame_that_is_too_large_fails_and_is_not_the_networks_fault() {
        let mut ledger = Ledger::default();
        ledger.count_too_large();
        assert!(!ledger.is_refused());
        ledger.count(client(1), Sent::Refused);
        assert!(ledger.is_refused());
        assert_eq!(ledger.progress("", true).failed, 2);
    }

    #[test]
    fn those_who_have_left_are_remembered_within_bounds() {
        let mut ledger = Ledger::default();
        for port in 1..=1000 {
            ledger.connected(client(port), None, Version::new(3, 1));
            ledger.left(client(port), ClientState::Left);
        }
        ledger.connected(client(1000), None, Version::new(4, 1));
        let progress = ledger.progress("", false);
        assert_eq!((progress.peers, progress.clients.len()), (1, MAX_REMEMBERED));
        assert_eq!(progress.clients[MAX_REMEMBERED - 1].version, Version::new(4, 1));
    }
}
