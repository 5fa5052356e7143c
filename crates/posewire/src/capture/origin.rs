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
        let origin = Origin::of(datagram);
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
    Packet::decode(packet).is_ok_and(|packet| ASKED.contains(&packet.id))
}
