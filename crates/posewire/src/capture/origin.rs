//! Which sender and place a captured datagram belongs to, where the file does not say.

use crate::{Datagram, Wire};
use posewire_natnet::{MessageId, Packet};
use std::collections::BTreeMap;
use std::net::SocketAddr;

/// Numbers the sources of a capture in the order in which they appear.
///
/// MXTP that goes to one place is one source, whoever sends it, as what arrives at one port is. A NatNet server is one source, with
/// all that it is asked.
#[derive(Debug, Default)]
pub(super) struct Origins {
    numbers: BTreeMap<Origin, u16>,
    names: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Origin {
    Mxtp(Wire, SocketAddr),
    NatNet(std::net::IpAddr),
}

impl Origins {
    /// The number of a datagram's source. Sources beyond the 65,536th share the last number.
    pub(super) fn number(&mut self, datagram: &Datagram) -> u16 {
        let origin = self.origin(datagram);
        if let Some(number) = self.numbers.get(&origin) {
            return *number;
        }
        let Ok(number) = u16::try_from(self.names.len()) else {
            return u16::MAX;
        };
        self.numbers.insert(origin, number);
        self.names.push(origin.name());
        number
    }

    fn origin(&self, datagram: &Datagram) -> Origin {
        let [sender, receiver] = [datagram.from, datagram.to].map(|place| Origin::NatNet(place.ip()));
        let is_known = |origin| self.numbers.contains_key(origin);
        // A server too says that it goes.
        if is_natnet(datagram, &[MessageId::DISCONNECT]) && is_known(&sender) && !is_known(&receiver) {
            return sender;
        }
        Origin::of(datagram)
    }

    /// The sources so far, as endpoints.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }
}

impl Origin {
    fn of(datagram: &Datagram) -> Self {
        match datagram.wire {
            Wire::NatNetCommand | Wire::NatNetData if is_asked(&datagram.bytes) => Self::NatNet(datagram.to.ip()),
            Wire::NatNetCommand | Wire::NatNetData => Self::NatNet(datagram.from.ip()),
            wire => Self::Mxtp(wire, datagram.to),
        }
    }

    fn name(self) -> String {
        match self {
            Self::Mxtp(Wire::MxtpTcp, to) => format!("mxtp+tcp://{to}"),
            Self::Mxtp(_, to) => format!("mxtp://{to}"),
            Self::NatNet(server) if server.is_ipv6() => format!("natnet://[{server}]"),
            Self::NatNet(server) => format!("natnet://{server}"),
        }
    }
}

/// Whether a datagram is a NatNet packet of one of these kinds.
fn is_natnet(datagram: &Datagram, kinds: &[MessageId]) -> bool {
    let is_natnet = matches!(datagram.wire, Wire::NatNetCommand | Wire::NatNetData);
    is_natnet && is_of(&datagram.bytes, kinds)
}

/// Whether a NatNet packet is a client's.
pub(crate) fn is_asked(packet: &[u8]) -> bool {
    const ASKED: [MessageId; 8] = [
        MessageId::CONNECT,
        MessageId::REQUEST,
        MessageId::REQUEST_MODEL,
        MessageId::REQUEST_FRAME,
        MessageId::DISCONNECT,
        MessageId::KEEP_ALIVE,
        MessageId::ECHO_REQUEST,
        MessageId::DISCOVERY,
    ];
    is_of(packet, &ASKED)
}

fn is_of(packet: &[u8], kinds: &[MessageId]) -> bool {
    Packet::decode(packet).is_ok_and(|packet| kinds.contains(&packet.id))
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::Stamp;

    fn packet(from: [u8; 4], to: [u8; 4], id: MessageId) -> Datagram {
        Datagram {
            wire: Wire::NatNetCommand,
            from: (from, 1510).into(),
            to: (to, 50_000).into(),
            received: Stamp(0),
            bytes: [id.0.to_le_bytes(), [0; 2]].concat().into(),
        }
    }

    #[test]
    fn whoever_ends_a_connection_the_server_is_the_source() {
        const SERVER: [u8; 4] = [10, 0, 0, 7];
        // A client that listens on all its addresses.
        const CLIENT: [u8; 4] = [0; 4];
        let mut origins = Origins::default();
        for datagram in [
            packet(SERVER, CLIENT, MessageId::SERVER_INFO),
            packet(CLIENT, SERVER, MessageId::DISCONNECT),
            packet(SERVER, CLIENT, MessageId::DISCONNECT),
        ] {
            assert_eq!(origins.number(&datagram), 0);
        }
        assert_eq!(origins.names(), ["natnet://10.0.0.7"]);
    }
}
