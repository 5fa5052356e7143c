//! Packets of a capture file, whichever kind of file it is.

use super::Format;
use super::input::Input;
use super::pcap::Pcap;
use super::pcapng::PcapNg;
use crate::Wire;
use posewire_motion::Stamp;
use std::io;

/// A file of captured packets.
pub(super) struct Packets {
    input: Input,
    kind: Kind,
}

enum Kind {
    Pcap(Pcap),
    PcapNg(PcapNg),
}

/// What is known of a packet besides its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Head {
    pub(super) time: Stamp,
    /// What the packet begins with, as the registry of link types numbers it.
    pub(super) link: u32,
    /// Whether it was longer on the wire.
    pub(super) is_cut: bool,
    /// What it is, in a file that we wrote.
    pub(super) wire: Option<Wire>,
}

/// What comes next in a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    Packet(Head),
    End,
    /// Nothing behind this place can be read.
    Damaged(&'static str),
}

impl Packets {
    pub(super) fn format(&self) -> Format {
        match self.kind {
            Kind::Pcap(_) => Format::Pcap,
            Kind::PcapNg(_) => Format::PcapNg,
        }
    }

    /// Reads the file's header; `None` when it is no capture file.
    pub(super) fn open(mut input: Input) -> io::Result<Option<Self>> {
        let Ok(magic) = input.array()? else {
            return Ok(None);
        };
        let kind = match Pcap::open(magic, &mut input)? {
            Some(pcap) => Some(Kind::Pcap(pcap)),
            None => PcapNg::open(magic, &mut input)?.map(Kind::PcapNg),
        };
        Ok(kind.map(|kind| Self { input, kind }))
    }

    /// The next packet's bytes into `bytes`.
    pub(super) fn next(&mut self, bytes: &mut Vec<u8>) -> io::Result<Next> {
        match &mut self.kind {
            Kind::Pcap(pcap) => pcap.next(&mut self.input, bytes),
            Kind::PcapNg(pcapng) => pcapng.next(&mut self.input, bytes),
        }
    }

    /// How many bytes of the file have been read.
    pub(super) fn offset(&self) -> u64 {
        self.input.offset()
    }
}

/// What libpcap captures at most of one packet.
pub(super) const MAX_PACKET: usize = 256 << 10;
