//! Captures for other programs, as Wireshark: pcapng and pcap.

use super::pcapng::{ENHANCED_PACKET, INTERFACE, OPTION_NAME, OPTION_RESOLUTION, SECTION, interface_name};
use crate::{Datagram, Error, Result, Wire};
use etherparse::PacketBuilder;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};

/// Writes datagrams as packets: Ethernet, IP and UDP or TCP headers are made up around each, with the addresses that are known.
///
/// A datagram is one packet, however long; only an IP packet's 65,535 bytes limit it. Times are in nanoseconds. A datagram over
/// TCP is one segment or several of the stream between its two ends. Where a place says no address of this machine
/// (`0.0.0.0`), it is written so.
#[derive(Debug)]
pub struct PcapWriter {
    path: PathBuf,
    out: BufWriter<File>,
    is_classic: bool,
    /// The number of the next byte of each TCP stream.
    sequences: BTreeMap<(SocketAddr, SocketAddr), u32>,
    packet: Vec<u8>,
}

impl PcapWriter {
    /// Creates the file: classic pcap when it ends in `.pcap`, else pcapng.
    ///
    /// # Errors
    /// [`Error::Exists`] when it is there and is not to be overwritten; [`Error::Write`] when it cannot be created.
    pub fn create(path: &Path, overwrite: bool) -> Result<Self> {
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(true).create_new(!overwrite);
        let failed = |error: io::Error| match error.kind() {
            io::ErrorKind::AlreadyExists => Error::Exists { path: path.to_owned() },
            _ => Error::write(path.display().to_string(), &error),
        };
        let file = options.open(path).map_err(failed)?;
        let is_classic = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("pcap"));
        let mut writer = Self {
            path: path.to_owned(),
            out: BufWriter::new(file),
            is_classic,
            sequences: BTreeMap::new(),
            packet: Vec::new(),
        };
        let header = if is_classic { pcap_header() } else { pcapng_header() };
        writer.out.write_all(&header).map_err(failed)?;
        Ok(writer)
    }

    /// Writes one datagram.
    ///
    /// # Errors
    /// [`Error::Write`] when the file takes no more; [`Error::TooLongForIp`] when it fits into no packet.
    pub fn write(&mut self, datagram: &Datagram) -> Result<()> {
        match datagram.wire {
            Wire::MxtpTcp => self.write_tcp(datagram),
            _ => self.write_udp(datagram),
        }
    }

    /// Brings everything to the disk.
    ///
    /// # Errors
    /// [`Error::Write`] when it does not get there.
    pub fn finish(mut self) -> Result<()> {
        let flushed = self.out.flush();
        flushed.map_err(|error| self.failed(&error))
    }

    fn write_udp(&mut self, datagram: &Datagram) -> Result<()> {
        let (from, to) = same_family(datagram.from, datagram.to);
        self.packet.clear();
        let built = match (from.ip(), to.ip()) {
            (IpAddr::V4(a), IpAddr::V4(b)) => ethernet(to.ip())
                .ipv4(a.octets(), b.octets(), HOPS)
                .udp(from.port(), to.port())
                .write(&mut self.packet, &datagram.bytes),
            (a, b) => ethernet(to.ip())
                .ipv6(octets(a), octets(b), HOPS)
                .udp(from.port(), to.port())
                .write(&mut self.packet, &datagram.bytes),
        };
        match built {
            Ok(()) => self.write_packet(datagram),
            Err(_) => Err(Error::TooLongForIp {
                found: datagram.bytes.len(),
            }),
        }
    }

    /// The segments of a datagram; the first ones too are of its time.
    fn write_tcp(&mut self, datagram: &Datagram) -> Result<()> {
        let (from, to) = same_family(datagram.from, datagram.to);
        let mut number = self.sequences.get(&(from, to)).copied().unwrap_or(1);
        for segment in datagram.bytes.chunks(SEGMENT) {
            self.packet.clear();
            let built = match (from.ip(), to.ip()) {
                (IpAddr::V4(a), IpAddr::V4(b)) => ethernet(to.ip())
                    .ipv4(a.octets(), b.octets(), HOPS)
                    .tcp(from.port(), to.port(), number, WINDOW)
                    .ack(1)
                    .psh()
                    .write(&mut self.packet, segment),
                (a, b) => ethernet(to.ip())
                    .ipv6(octets(a), octets(b), HOPS)
                    .tcp(from.port(), to.port(), number, WINDOW)
                    .ack(1)
                    .psh()
                    .write(&mut self.packet, segment),
            };
            if built.is_err() {
                return Err(Error::TooLongForIp { found: segment.len() });
            }
            number = number.wrapping_add(segment.len() as u32);
            self.write_packet(datagram)?;
        }
        self.sequences.insert((from, to), number);
        Ok(())
    }

    fn write_packet(&mut self, datagram: &Datagram) -> Result<()> {
        let nanoseconds = u64::try_from(datagram.received.nanoseconds()).unwrap_or_default();
        let head = if self.is_classic {
            self.record(nanoseconds)
        } else {
            self.block(datagram.wire, nanoseconds)
        };
        let padding: &[u8] = if self.is_classic {
            &[]
        } else {
            &[0; 3][..self.packet.len().next_multiple_of(4) - self.packet.len()]
        };
        let parts = [
            &head[..],
            &self.packet,
            padding,
            if self.is_classic { &[] } else { &head[4..8] },
        ];
        let written = parts.into_iter().try_for_each(|part| self.out.write_all(part));
        written.map_err(|error| self.failed(&error))
    }

    /// What stands before a packet in a pcap file.
    fn record(&self, nanoseconds: u64) -> Vec<u8> {
        let length = self.packet.len() as u32;
        let (seconds, fraction) = (nanoseconds / BILLION, nanoseconds % BILLION);
        numbers(&[seconds as u32, fraction as u32, length, length])
    }

    /// What stands before a packet in a pcapng file.
    fn block(&self, wire: Wire, nanoseconds: u64) -> Vec<u8> {
        let length = self.packet.len();
        let whole = 32 + length.next_multiple_of(4);
        let [upper, lower] = [(nanoseconds >> 32) as u32, nanoseconds as u32];
        let interface = Wire::ALL.iter().position(|known| *known == wire).unwrap_or_default() as u32;
        numbers(&[
            ENHANCED_PACKET,
            whole as u32,
            interface,
            upper,
            lower,
            length as u32,
            length as u32,
        ])
    }

    fn failed(&self, error: &io::Error) -> Error {
        Error::write(self.path.display().to_string(), error)
    }
}

fn pcap_header() -> Vec<u8> {
    let version = 2 | 4 << 16;
    numbers(&[0xa1b2_3c4d, version, 0, 0, SNAP_LENGTH, super::link::ETHERNET])
}

/// The first block of a section, and one interface for each wire.
fn pcapng_header() -> Vec<u8> {
    let unknown = u32::MAX;
    let mut header = numbers(&[SECTION, 28, 0x1a2b_3c4d, 1, unknown, unknown, 28]);
    for wire in Wire::ALL {
        header.extend(interface(&interface_name(wire)));
    }
    header
}

/// An interface whose times are in nanoseconds.
fn interface(name: &str) -> Vec<u8> {
    let padded = name.len().next_multiple_of(4);
    let length = 36 + padded as u32;
    let option = |code: u16, length: usize| u32::from(code) | (length as u32) << 16;
    let mut block = numbers(&[
        INTERFACE,
        length,
        super::link::ETHERNET,
        SNAP_LENGTH,
        option(OPTION_NAME, name.len()),
    ]);
    block.extend(name.bytes().chain([0; 3]).take(padded));
    block.extend(numbers(&[option(OPTION_RESOLUTION, 1), 9, 0, length]));
    block
}

fn numbers(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A packet has two addresses of one kind; one that is not known takes the kind of the other.
fn same_family(from: SocketAddr, to: SocketAddr) -> (SocketAddr, SocketAddr) {
    let like = |place: SocketAddr, other: SocketAddr| match (place.ip(), other.ip()) {
        (IpAddr::V6(ip), IpAddr::V4(_)) if ip.is_unspecified() => SocketAddr::from(([0; 4], place.port())),
        _ => place,
    };
    (like(from, to), like(to, from))
}

fn octets(ip: IpAddr) -> [u8; 16] {
    match ip {
        IpAddr::V4(ip) => ip.to_ipv6_mapped().octets(),
        IpAddr::V6(ip) => ip.octets(),
    }
}

/// Made-up addresses; a group has the one that follows from it.
fn ethernet(to: IpAddr) -> etherparse::PacketBuilderStep<etherparse::Ethernet2Header> {
    let target = match to {
        IpAddr::V4(ip) if ip.is_broadcast() => [0xff; 6],
        IpAddr::V4(ip) if ip.is_multicast() => {
            let [_, b, c, d] = ip.octets();
            [0x01, 0x00, 0x5e, b & 0x7f, c, d]
        }
        IpAddr::V6(ip) if ip.is_multicast() => {
            let [.., a, b, c, d] = ip.octets();
            [0x33, 0x33, a, b, c, d]
        }
        _ => [0x02, 0, 0, 0, 0, 2],
    };
    PacketBuilder::ethernet2([0x02, 0, 0, 0, 0, 1], target)
}

const BILLION: u64 = 1_000_000_000;
const HOPS: u8 = 64;
const WINDOW: u16 = u16::MAX;
const SNAP_LENGTH: u32 = 256 << 10;
/// The longest that fits into an IP packet with room for its headers.
const SEGMENT: usize = 65_000;
