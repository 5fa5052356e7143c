//! Which protocol the bytes are of, and how they are read.

use super::input::is_mxtp;
use super::natnet::{Bitstream, begins_packet};
use super::part::{Explained, Part};
use super::{mxtp, natnet};
use crate::cli::{Explain, Protocol};
use crate::error::Usage;
use posewire_natnet::Packet;

/// How the bytes are read.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Reading {
    Mxtp,
    NatNet(Bitstream),
    /// Nothing tells the protocol: MXTP, the one that can be found between other bytes.
    Unknown,
}

impl Reading {
    /// What the user says, else what the bytes say.
    pub(super) fn of(bytes: &[u8], arguments: &Explain, name: &str) -> Result<Self, Usage> {
        let protocol = arguments.protocol.or_else(|| told_by(bytes));
        match (protocol, arguments.version) {
            (Some(Protocol::Mxtp), Some(version)) => Err(Usage {
                problem: format!("--version {version} is of NatNet, {name} is read as MXTP"),
                help: "leave --version out: MXTP says its revision itself".to_owned(),
            }),
            (Some(Protocol::Mxtp), None) => Ok(Self::Mxtp),
            (Some(Protocol::Natnet), _) if is_mxtp(bytes) => Err(Usage {
                problem: format!("{name} begins with \"MXTP\", it is no NatNet"),
                help: "leave --protocol out, or say --protocol mxtp".to_owned(),
            }),
            (Some(Protocol::Natnet), None) => Ok(Self::NatNet(Bitstream::guess(packets(bytes)))),
            (_, Some(version)) => Ok(Self::NatNet(Bitstream::given(version))),
            (None, None) => Ok(Self::Unknown),
        }
    }

    pub(super) fn parts<'a>(&self, bytes: &'a [u8]) -> Box<dyn Iterator<Item = Part<'a>> + 'a> {
        match self {
            Self::Mxtp | Self::Unknown => Box::new(mxtp::Parts::of(bytes)),
            Self::NatNet(_) => Box::new(natnet::Parts::of(bytes)),
        }
    }

    pub(super) fn explain<'a>(&'a self, offset: usize, bytes: &'a [u8]) -> Explained<'a> {
        match self {
            Self::Mxtp | Self::Unknown => mxtp::explain(offset, bytes),
            Self::NatNet(bitstream) => natnet::explain(bitstream, offset, bytes),
        }
    }

    /// What an input without a datagram should have had.
    pub(super) const fn expected(&self) -> &'static str {
        match self {
            Self::Mxtp => "datagrams, which begin with \"MXTP\"",
            Self::NatNet(_) => "NatNet packets, which begin with their number and size",
            Self::Unknown => "datagrams, which begin with \"MXTP\", or whole NatNet packets",
        }
    }

    /// What to do about an input without a datagram.
    pub(super) fn way_out(&self, bytes: &[u8]) -> String {
        match (self, Packet::decode(bytes)) {
            (Self::Mxtp, Ok(packet)) if begins_packet(bytes) => {
                format!("leave --protocol out: it begins as a NatNet {} does", packet.id)
            }
            (Self::Unknown, Ok(packet)) if packet.id.name() != "unknown" => {
                let (id, size) = (packet.id, packet.stated_size);
                format!("if it is the NatNet {id} of {size} bytes that it begins as, cut short: --protocol natnet")
            }
            _ => "give the payload of UDP datagrams, or a TCP stream, as raw bytes".to_owned(),
        }
    }
}

/// The protocol that the bytes begin with. Zeros would be a row of the shortest NatNet packets.
fn told_by(bytes: &[u8]) -> Option<Protocol> {
    if is_mxtp(bytes) {
        Some(Protocol::Mxtp)
    } else if begins_packet(bytes) && (bytes.len() == Packet::HEADER_SIZE || bytes.iter().any(|byte| *byte != 0)) {
        Some(Protocol::Natnet)
    } else {
        None
    }
}

fn packets(bytes: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    natnet::Parts::of(bytes).filter_map(|part| match part {
        Part::Datagram { bytes, .. } => Some(bytes),
        Part::Skipped { .. } => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_beginning_tells_the_protocol() {
        for (bytes, protocol) in [
            (&b"MXTP02"[..], Some(Protocol::Mxtp)),
            (b"\x0a\0\0\0", Some(Protocol::Natnet)),
            (b"\0\0\0\0", Some(Protocol::Natnet)),
            (b"\x02\0\x01\0a\x0a\0\0\0", Some(Protocol::Natnet)),
            (b"\0\0\0\0\0\0\0\0", None),
            (b"\x07\0\xff\0cut", None),
            (b"noise MXTP02", None),
            (b"\x0a", None),
        ] {
            assert_eq!(told_by(bytes), protocol, "{bytes:?}");
        }
    }
}
