//! Datagrams that were captured: read from pcap, pcapng and MCAP files, and written to them.
//!
//! ```
//! use posewire::capture::{Capture, CaptureOptions, PcapWriter};
//! use posewire::{Datagram, Wire};
//! use posewire_motion::Stamp;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("take.pcapng");
//! let datagram = Datagram {
//!     wire: Wire::MxtpUdp,
//!     from: "192.168.1.20:50123".parse()?,
//!     to: "192.168.1.30:9763".parse()?,
//!     received: Stamp(1_700_000_000_123_456_789),
//!     bytes: (*b"MXTP02").into(),
//! };
//! let mut writer = PcapWriter::create(&path, false)?;
//! writer.write(&datagram)?;
//! writer.finish()?;
//!
//! let mut capture = Capture::open(&path, &CaptureOptions::default())?;
//! let captured = capture.next().ok_or("one was written")??;
//! assert_eq!(captured.datagram, datagram);
//! assert_eq!(capture.sources(), ["mxtp://192.168.1.30:9763"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod convert;
mod fragments;
mod input;
mod link;
mod origin;
mod packet;
mod pcap;
mod pcapng;
mod protocol;
mod streams;
mod unpack;
mod write;

pub use convert::{Converted, convert};
pub use protocol::Protocol;
pub use write::PcapWriter;

use crate::{Datagram, Error, Result};
use input::Input;
use origin::Origins;
use packet::{Next, Packets};
use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use unpack::Unpacker;

/// How a capture is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CaptureOptions {
    /// What the UDP datagrams are; told by their content if absent.
    pub protocol: Option<Protocol>,
}

/// A datagram of a capture, and where it belongs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Captured {
    /// Which of the [sources](Capture::sources) it is of.
    pub source: u16,
    /// The datagram. Over TCP, it was received when the segment was captured that completes it.
    pub datagram: Datagram,
}

/// What of a capture was read, and what could not be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Packets in the file.
    pub packets: u64,
    /// Packets and UDP datagrams that are understood and are neither MXTP nor NatNet.
    pub other: u64,
    /// Packets of a link type that is not one of ours.
    pub unknown_link: u64,
    /// Packets whose headers are no headers.
    pub malformed: u64,
    /// Packets that were not captured to their end.
    pub cut: u64,
    /// IP packets of which a fragment is missing.
    pub incomplete: u64,
    /// Times that segments of a TCP stream are missing.
    pub gaps: u64,
    /// Bytes of MXTP streams over TCP that are part of no datagram.
    pub skipped_bytes: u64,
}

impl Counts {
    /// What of the capture may be missing in what was given.
    pub const fn lost(&self) -> u64 {
        self.unknown_link + self.malformed + self.cut + self.incomplete + self.gaps
    }
}

/// The datagrams of a capture file, in the order in which they were captured.
///
/// A pcap or pcapng file is read packet by packet: Ethernet with VLAN tags, Linux cooked capture, loopback and bare IP; IP fragments
/// are put together, UDP datagrams taken that are MXTP or NatNet, and TCP streams cut into MXTP datagrams. Memory is bounded
/// whatever the file says.
pub struct Capture {
    path: PathBuf,
    packets: Packets,
    packet: Vec<u8>,
    unpacker: Unpacker,
    origins: Origins,
    damage: Option<String>,
    ended: bool,
}

impl Capture {
    /// Opens a capture; what it is, its first bytes say.
    ///
    /// # Errors
    /// [`Error::Read`] when it cannot be read, [`Error::NotACapture`] when it is something else.
    pub fn open(path: &Path, options: &CaptureOptions) -> Result<Self> {
        let failed = |error: &io::Error| Error::read(path, error);
        let file = File::open(path).map_err(|error| failed(&error))?;
        let mut input = Input::new(BufReader::with_capacity(BUFFER, file));
        let beginning = input.peek().map_err(|error| failed(&error))?;
        let found = beginning.iter().take(8).copied().collect();
        match Packets::open(input).map_err(|error| failed(&error))? {
            Some(packets) => Ok(Self::of(path, packets, options)),
            None => Err(Error::NotACapture {
                path: path.to_owned(),
                found,
            }),
        }
    }

    fn of(path: &Path, packets: Packets, options: &CaptureOptions) -> Self {
        Self {
            path: path.to_owned(),
            packets,
            packet: Vec::new(),
            unpacker: Unpacker::new(options.protocol),
            origins: Origins::default(),
            damage: None,
            ended: false,
        }
    }

    /// The sources that datagrams have come from so far, as endpoints; [`Captured::source`] is a place in here.
    pub fn sources(&self) -> &[String] {
        self.origins.names()
    }

    /// What was read so far, and what could not be.
    pub fn counts(&self) -> Counts {
        self.unpacker.counts()
    }

    /// What ended the capture before its end, if something did.
    pub fn damage(&self) -> Option<&str> {
        self.damage.as_deref()
    }

    /// Reads packets until a datagram is ready or there are no more.
    fn fill(&mut self) -> Result<Option<Datagram>> {
        loop {
            if let Some(datagram) = self.unpacker.pop() {
                return Ok(Some(datagram));
            }
            if self.ended {
                return Ok(None);
            }
            let next = self.packets.next(&mut self.packet);
            match next.map_err(|error| Error::read(&self.path, &error)) {
                Ok(Next::Packet(head)) => self.unpacker.take(head, &self.packet),
                Ok(Next::End) => self.end(),
                Ok(Next::Damaged(problem)) => {
                    self.damage = Some(format!("{problem}, near byte {}", self.packets.offset()));
                    self.end();
                }
                Err(error) => {
                    self.end();
                    return Err(error);
                }
            }
        }
    }

    fn end(&mut self) {
        self.ended = true;
        self.unpacker.finish();
    }
}

impl Iterator for Capture {
    type Item = Result<Captured>;

    fn next(&mut self) -> Option<Self::Item> {
        let datagram = self.fill().transpose()?;
        Some(datagram.map(|datagram| Captured {
            source: self.origins.number(&datagram),
            datagram,
        }))
    }
}

impl std::fmt::Debug for Capture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Capture")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

const BUFFER: usize = 256 << 10;

#[cfg(test)]
mod tests;
