//! Which captured datagrams are of a protocol that we speak.

use crate::Wire;
use posewire_mxtp::Header;
use posewire_natnet::{MessageId, Packet, Quirks};
use std::collections::BTreeSet;
use std::net::SocketAddr;

/// What captured datagrams are, where their content is not to decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Protocol {
    /// Every UDP datagram is one of MXTP.
    Mxtp,
    /// Every UDP datagram is a packet of NatNet.
    NatNet,
}

/// Tells MXTP and NatNet from everything else.
///
/// MXTP begins with `MXTP` and two digits. A NatNet packet says its own size, and is taken when that is right and one of its ports
/// is 1510 or 1511; on other ports once a frame or an answer to a connection has been seen from there.
#[derive(Debug, Default)]
pub(super) struct Detector {
    forced: Option<Protocol>,
    servers: BTreeSet<SocketAddr>,
}

impl Detector {
    pub(super) fn new(forced: Option<Protocol>) -> Self {
        Self {
            forced,
            servers: BTreeSet::new(),
        }
    }

    /// What a UDP datagram is; `None` when it is nothing that we speak.
    pub(super) fn wire(&mut self, from: SocketAddr, to: SocketAddr, bytes: &[u8]) -> Option<Wire> {
        match self.forced.or_else(|| self.detect(from, to, bytes))? {
            Protocol::Mxtp => Some(Wire::MxtpUdp),
            Protocol::NatNet => Some(natnet_wire(to)),
        }
    }

    fn detect(&mut self, from: SocketAddr, to: SocketAddr, bytes: &[u8]) -> Option<Protocol> {
        if is_mxtp(bytes) {
            return Some(Protocol::Mxtp);
        }
        self.is_natnet(from, to, bytes).then_some(Protocol::NatNet)
    }

    fn is_natnet(&mut self, from: SocketAddr, to: SocketAddr, bytes: &[u8]) -> bool {
        let Some(packet) = Packet::decode(bytes)
            .ok()
            .filter(|packet| packet.quirks == Quirks::NONE)
        else {
            return false;
        };
        let is_known = packet.id.name() != "unknown";
        let is_telling = [MessageId::SERVER_INFO, MessageId::MODEL, MessageId::FRAME].contains(&packet.id);
        if is_telling && packet.payload.len() >= 4 && self.servers.len() < MAX_SERVERS {
            self.servers.insert(from);
        }
        let ends = [from, to];
        let is_place = |end: &SocketAddr| [COMMAND_PORT, DATA_PORT].contains(&end.port()) || self.servers.contains(end);
        is_known && ends.iter().any(is_place)
    }
}

fn is_mxtp(bytes: &[u8]) -> bool {
    let digits = bytes.strip_prefix(&Header::MAGIC).and_then(|rest| rest.get(..2));
    digits.is_some_and(|digits| digits.iter().all(u8::is_ascii_digit))
}

/// The group or the data port is where frames alone go.
fn natnet_wire(to: SocketAddr) -> Wire {
    let is_data = to.ip().is_multicast() || to.port() == DATA_PORT;
    if is_data { Wire::NatNetData } else { Wire::NatNetCommand }
}

const COMMAND_PORT: u16 = 1510;
const DATA_PORT: u16 = 1511;
const MAX_SERVERS: usize = 1024;

#[cfg(test)]
mod tests {
    use super::*;

    fn at(port: u16) -> SocketAddr {
        ([10, 0, 0, 1], port).into()
    }

    #[test]
    fn mxtp_is_known_by_its_first_bytes_and_natnet_by_size_and_place() {
        let mut detector = Detector::default();
        let mut wire = |from, to, bytes: &[u8]| detector.wire(at(from), at(to), bytes);
        assert_eq!(wire(5000, 6000, b"MXTP02"), Some(Wire::MxtpUdp));
        assert_eq!(wire(5000, 9763, b"MXTPxx"), None);
        let request = b"\x02\0\x0a\0FrameRate\0";
        assert_eq!(wire(5000, 1510, request), Some(Wire::NatNetCommand));
        assert_eq!(wire(5000, 6000, request), None);
        assert_eq!(wire(6000, 5000, b"\x07\0\x04\0\0\0\0\0"), Some(Wire::NatNetCommand));
        assert_eq!(wire(5000, 6000, request), Some(Wire::NatNetCommand));
        assert_eq!(wire(6000, 1511, b"\x07\0\x05\0\0\0\0\0"), None);
        assert_eq!(wire(6000, 1511, b"\x07\0\x04\0\0\0\0\0"), Some(Wire::NatNetData));
    }

    #[test]
    fn a_protocol_that_is_forced_is_not_looked_for() {
        let mut detector = Detector::new(Some(Protocol::NatNet));
        assert_eq!(detector.wire(at(1), at(2), b"MXTP02"), Some(Wire::NatNetCommand));
        let mut detector = Detector::new(Some(Protocol::Mxtp));
        assert_eq!(detector.wire(at(1), at(2), b""), Some(Wire::MxtpUdp));
    }
}
