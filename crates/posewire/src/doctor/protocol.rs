//! What arrives, by its first bytes.

use super::Check;
use super::finding::{Finding, plural};
use crate::endpoint::Endpoint;
use crate::{Datagram, Wire};
use posewire_mxtp::Header;
use posewire_natnet::{Packet, Quirks};
use std::collections::BTreeMap;
use std::fmt;
use std::net::SocketAddr;

/// What a datagram seems to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Guess {
    Mxtp,
    NatNet,
    Xtlp,
    Osc,
    Xml,
    Json,
    Discovery,
    Http,
    Lz4,
    Empty,
    Unknown,
}

impl Guess {
    /// Which protocol the bytes are of, as far as their beginning tells.
    pub(super) fn of(bytes: &[u8]) -> Self {
        let begins = |with: &[u8]| bytes.starts_with(with);
        let is_address = bytes.get(1).is_some_and(u8::is_ascii_alphanumeric) && bytes.len().is_multiple_of(4);
        match bytes {
            [] => Self::Empty,
            _ if begins(&Header::MAGIC) => Self::Mxtp,
            _ if begins(b"XTLP") => Self::Xtlp,
            _ if begins(b"#bundle\0") => Self::Osc,
            [b'/', ..] if is_address => Self::Osc,
            [b'<', ..] => Self::Xml,
            [b'{' | b'[', next, ..] if next.is_ascii_graphic() || next.is_ascii_whitespace() => Self::Json,
            _ if begins(b"M-SEARCH ") || begins(b"NOTIFY * ") => Self::Discovery,
            _ if begins(b"GET ") || begins(b"POST ") || begins(b"HTTP/") => Self::Http,
            _ if begins(&[0x04, 0x22, 0x4D, 0x18]) => Self::Lz4,
            _ if is_natnet(bytes) => Self::NatNet,
            _ => Self::Unknown,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Mxtp => "MXTP, the stream of MVN",
            Self::NatNet => "NatNet, the stream of Motive",
            Self::Xtlp => "XTLP, the other stream of MVN",
            Self::Osc => "OSC, as VMC and many instruments send it",
            Self::Xml => "XML, as remote control of a capture is",
            Self::Json => "JSON",
            Self::Discovery => "the looking for devices of a home network (SSDP)",
            Self::Http => "HTTP",
            Self::Lz4 => "compressed (LZ4), as Rokoko Studio sends it",
            Self::Empty => "empty",
            Self::Unknown => "of no protocol that is known here",
        }
    }

    /// What to do about it, where the protocol tells.
    fn remedy(self, from: SocketAddr, port: u16) -> Option<String> {
        match self {
            Self::NatNet => Some(format!(
                "Listen to that server as what it is: posewire doctor natnet://{}",
                host(from)
            )),
            Self::Mxtp => Some(format!(
                "Listen to it as what it is: posewire doctor mxtp://0.0.0.0:{port}"
            )),
            Self::Xtlp => {
                Some("In MVN's Network Streamer choose the protocol MXTP; XTLP is not supported yet.".to_owned())
            }
            _ => None,
        }
    }
}

impl fmt::Display for Guess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A packet of NatNet says its own size.
fn is_natnet(bytes: &[u8]) -> bool {
    Packet::decode(bytes).is_ok_and(|packet| packet.quirks == Quirks::NONE && packet.id.name() != "unknown")
}

/// An IPv6 address in brackets.
fn host(from: SocketAddr) -> String {
    match from {
        SocketAddr::V4(v4) => v4.ip().to_string(),
        SocketAddr::V6(v6) => format!("[{}]", v6.ip()),
    }
}

/// What came that is not of the protocol that is listened to.
#[derive(Debug)]
pub(super) struct Protocols {
    expects_natnet: bool,
    right: u64,
    others: BTreeMap<Guess, Other>,
}

#[derive(Debug)]
struct Other {
    count: u64,
    from: SocketAddr,
    port: u16,
    begins: Vec<u8>,
}

impl Protocols {
    pub(super) fn new(endpoint: &Endpoint) -> Self {
        Self {
            expects_natnet: matches!(endpoint, Endpoint::NatNet(_)),
            right: 0,
            others: BTreeMap::new(),
        }
    }

    pub(super) fn datagram(&mut self, datagram: &Datagram) {
        self.expects_natnet = matches!(datagram.wire, Wire::NatNetCommand | Wire::NatNetData);
        let guess = Guess::of(&datagram.bytes);
        // Clients get packets whose size is a byte off as well; what a server sends to the port it was asked from is its own.
        let is_natnet = guess == Guess::NatNet || self.expects_natnet && guess == Guess::Unknown;
        if guess == Guess::Mxtp && !self.expects_natnet || is_natnet && self.expects_natnet {
            self.right += 1;
            return;
        }
        let first = || Other {
            count: 0,
            from: datagram.from,
            port: datagram.to.port(),
            begins: datagram.bytes.iter().take(LOOKED_AT).copied().collect(),
        };
        self.others.entry(guess).or_insert_with(first).count += 1;
    }

    /// How many datagrams were of the right protocol.
    pub(super) fn right(&self) -> u64 {
        self.right
    }

    pub(super) fn findings(&self) -> impl Iterator<Item = Finding> {
        let wanted = if self.expects_natnet { "NatNet" } else { "MXTP" };
        self.others.iter().map(move |(guess, other)| {
            let count = plural(other.count, "datagram");
            let verb = if other.count == 1 { "is" } else { "are" };
            let begins = match guess {
                Guess::Unknown => format!(" It begins with \"{}\".", other.begins.escape_ascii()),
                _ => String::new(),
            };
            let what = format!("{count} {verb} {guess}, and not {wanted}.{begins}");
            let finding = Finding::new(Check::WrongProtocol, what).at(other.from);
            match guess.remedy(other.from, other.port) {
                Some(remedy) => finding.with_remedy(remedy),
                None => finding,
            }
        })
    }
}

const LOOKED_AT: usize = 12;

#[cfg(test)]
mod tests {
    use super::super::test::{datagram, endpoint};
    use super::*;

    fn found(url: &str, wire: Wire, bytes: &[u8]) -> Vec<Finding> {
        let mut protocols = Protocols::new(&endpoint(url));
        let mut datagram = datagram("10.0.0.7:1510", bytes);
        datagram.wire = wire;
        protocols.datagram(&datagram);
        protocols.findings().collect()
    }

    #[test]
    fn each_protocol_is_told_by_its_first_bytes() {
        for (bytes, guess) in [
            (&b"MXTP02"[..], Guess::Mxtp),
            (b"XTLP\x01\0", Guess::Xtlp),
            (b"\x07\0\x04\0\0\0\0\0", Guess::NatNet),
            (b"/VMC/Ext/OK\0,i\0\0\0\0\0\x01", Guess::Osc),
            (b"#bundle\0", Guess::Osc),
            (b"<IdentifyReq/>", Guess::Xml),
            (b"{\"version\":3}", Guess::Json),
            (b"M-SEARCH * HTTP/1.1", Guess::Discovery),
            (b"GET / HTTP/1.1", Guess::Http),
            (b"\x04\x22\x4d\x18rest", Guess::Lz4),
            (b"", Guess::Empty),
            (b"\x07\0\x09\0\0\0\0\0", Guess::Unknown),
            (b"hello", Guess::Unknown),
        ] {
            assert_eq!(Guess::of(bytes), guess, "{}", bytes.escape_ascii());
        }
    }

    #[test]
    fn natnet_on_the_port_of_mxtp_is_answered_with_its_url() {
        let found = found("mxtp://0.0.0.0", Wire::MxtpUdp, b"\x07\0\x04\0\0\0\0\0");
        assert_eq!(found[0].check, Check::WrongProtocol);
        assert_eq!(found[0].place.as_deref(), Some("10.0.0.7:1510"));
        assert!(found[0].what.starts_with("1 datagram is NatNet"), "{}", found[0].what);
        assert!(found[0].remedy.ends_with("natnet://10.0.0.7"), "{}", found[0].remedy);
    }

    #[test]
    fn mxtp_where_natnet_is_awaited_is_answered_with_its_url() {
        let found = found("natnet://10.0.0.7", Wire::NatNetData, b"MXTP02");
        assert!(found[0].what.contains("MXTP"), "{}", found[0].what);
        assert!(found[0].remedy.ends_with("mxtp://0.0.0.0:9763"), "{}", found[0].remedy);
    }

    #[test]
    fn what_nobody_knows_is_shown() {
        let found = found("mxtp://0.0.0.0", Wire::MxtpUdp, b"hello\x1b");
        assert!(found[0].what.ends_with("\"hello\\x1b\"."), "{}", found[0].what);
    }

    #[test]
    fn the_right_protocol_is_no_finding() {
        assert_eq!(found("mxtp://0.0.0.0", Wire::MxtpUdp, b"MXTP02"), []);
        assert_eq!(found("natnet://h", Wire::NatNetData, b"\x07\0\x04\0\0\0\0\0"), []);
    }
}
