//! Whose frames are taken.

use std::net::IpAddr;

use posewire_natnet::client::Mode;

use crate::net;

/// Whose frames are taken from a group, to which several servers may send.
///
/// The server's own; where none come from the address that answers, those of the first other one: a server with several
/// networks may send from any of its addresses, one on this machine from whichever suits the group.
#[derive(Debug)]
pub(super) struct Senders {
    server: IpAddr,
    is_own: bool,
    mode: Mode,
    other: Option<IpAddr>,
}

impl Senders {
    pub(super) fn new(mode: Mode, server: IpAddr) -> Self {
        Self {
            server,
            is_own: net::is_own(server),
            mode,
            other: None,
        }
    }

    /// Whether the server runs on this machine.
    pub(super) fn is_own(&self) -> bool {
        self.is_own
    }

    /// `None` for a stranger's frame; otherwise whether its address was adopted just now, as it is when frames have been
    /// waited for too long.
    pub(super) fn accepts(&mut self, from: IpAddr, is_waiting: bool) -> Option<bool> {
        // Of single frames the client itself knows whose they are.
        if self.mode == Mode::Unicast || from == self.server || self.other == Some(from) {
            return Some(false);
        }
        if self.is_own && net::is_own(from) {
            self.other = Some(from);
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
    fn a_server_on_this_machine_sends_from_any_of_its_addresses() {
        let mut senders = Senders::new(Mode::Multicast, [127, 0, 0, 1].into());
        assert_eq!(senders.accepts([127, 0, 0, 2].into(), false), Some(false));
        assert_eq!(senders.accepts([192, 0, 2, 1].into(), false), None);
    }
}
