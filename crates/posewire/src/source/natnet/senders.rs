//! Whose datagrams are taken.

use std::net::{IpAddr, SocketAddr};

use posewire_natnet::client::Mode;

use crate::net;

/// Whose datagrams are taken: the server's, which may have several addresses.
///
/// A server on this machine answers from the address that suits the network, whichever it was asked at; so each of the
/// machine's addresses is the server's. Several servers may send to one group, and one of them from another of its networks
/// than it answers on: where no frames come from the address that answers, those of the first other one are taken.
#[derive(Debug)]
pub(super) struct Senders {
    server: IpAddr,
    is_own: bool,
    mode: Mode,
    /// Another address of this machine that it answers from.
    alias: Option<IpAddr>,
    /// Another address that frames are taken from.
    other: Option<IpAddr>,
}

impl Senders {
    pub(super) fn new(mode: Mode, server: IpAddr) -> Self {
        Self {
            server,
            is_own: net::is_own(server),
            mode,
            alias: None,
            other: None,
        }
    }

    /// Whether the server runs on this machine.
    pub(super) fn is_own(&self) -> bool {
        self.is_own
    }

    /// The endpoint that a sender is known by.
    pub(super) fn known_as(&mut self, from: SocketAddr) -> SocketAddr {
        let ip = from.ip();
        let is_alias = ip != self.server && self.is_own && (self.alias == Some(ip) || net::is_own(ip));
        if !is_alias {
            return from;
        }
        self.alias = Some(ip);
        SocketAddr::new(self.server, from.port())
    }

    /// `None` for a stranger's frame; otherwise whether its address was adopted just now, as it is when frames have been
    /// waited for too long.
    pub(super) fn accepts(&mut self, from: IpAddr, is_waiting: bool) -> Option<bool> {
        // Of single frames the client itself knows whose they are.
        if self.mode == Mode::Unicast || from == self.server || self.other == Some(from) {
            return Some(false);
        }
        let adopts = is_waiting && self.other.is_none();
        adopts.then(|| {
            self.other = Some(from);
            true
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_address_is_taken_only_when_the_server_is_silent() {
        let [server, other, third] = [1, 2, 3].map(|last| IpAddr::from([192, 0, 2, last]));
        let mut senders = Senders::new(Mode::Multicast, server);
        assert_eq!(senders.accepts(server, false), Some(false));
        assert_eq!(senders.accepts(other, false), None);
        assert_eq!(senders.accepts(other, true), Some(true));
        assert_eq!(senders.accepts(other, false), Some(false));
        assert_eq!(senders.accepts(third, true), None);
        assert_eq!(senders.accepts(server, false), Some(false));
    }

    #[test]
    fn a_server_on_this_machine_is_known_by_one_of_its_addresses() {
        let [own, other, stranger] = [[127, 0, 1, 1], [127, 0, 0, 1], [198, 51, 100, 1]].map(IpAddr::from);
        let mut senders = Senders::new(Mode::Unicast, own);
        let mut known_as = |ip| senders.known_as(SocketAddr::new(ip, 1510)).ip();
        assert_eq!(
            [own, other, other, stranger].map(&mut known_as),
            [own, own, own, stranger]
        );
    }
}
