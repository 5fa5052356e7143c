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
mod opening;
mod origin;
mod packet;
mod parts;
mod pcap;
mod pcapng;
mod playlist;
mod protocol;
mod recording;
mod streams;
mod survey;
mod unpack;
mod write;

pub use convert::{ConvertOptions, Converted, convert};
pub(crate) use opening::Opening;
pub(crate) use origin::is_asked;
pub(crate) use parts::all_from as files_of;
pub(crate) use playlist::{Due, Playlist, Selection};
pub use protocol::Protocol;
pub use survey::{CapturedSource, Survey};
pub use write::PcapWriter;

use crate::{Datagram, Error, Result};
use input::Input;
use packet::Packets;
use recording::Recording;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use unpack::Unpacked;

/// How a capture is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CaptureOptions {
    /// What the UDP datagrams are; told by their content if absent.
    pub protocol: Option<Protocol>,
}

/// The kind of file that a capture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// A recording.
    Mcap,
    /// What libpcap writes.
    Pcap,
    /// What Wireshark writes.
    PcapNg,
}

impl Format {
    /// How the names of such files end, without the dot.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Mcap => "mcap",
            Self::Pcap => "pcap",
            Self::PcapNg => "pcapng",
        }
    }
}

/// A datagram of a capture, and where it belongs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Captured {
    /// Which of the [sources](Capture::sources) it is of.
    pub source: u16,
    /// Whether it is a copy from the file before, at the beginning of a part of a split recording.
    pub is_repeated: bool,
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
/// A recording (MCAP) gives its raw datagrams, whichever sources and senders they are of, also when it was cut off. Where it was
/// split, its first file stands for all of them, which lie beside it; a later one stands for itself.
///
/// A pcap or pcapng file is read packet by packet: Ethernet with VLAN tags, Linux cooked capture, loopback and bare IP; IP fragments
/// are put together, UDP datagrams taken that are MXTP or NatNet, and TCP streams cut into MXTP datagrams. Memory is bounded
/// whatever the file says.
pub struct Capture {
    files: Vec<PathBuf>,
    /// Which of the files is being read.
    place: usize,
    kind: Kind,
    damage: Option<String>,
    ended: bool,
}

enum Kind {
    Packets(Box<Unpacked>),
    Recording(Box<Recording>),
}

impl Capture {
    /// Opens a capture; what it is, its first bytes say.
    ///
    /// # Errors
    /// [`Error::Read`] when it cannot be read, [`Error::NotACapture`] when it is something else, [`Error::MissingPart`] when a file of
    /// a split recording is not there.
    pub fn open(path: &Path, options: &CaptureOptions) -> Result<Self> {
        let failed = |error: io::Error| Error::read(path, &error);
        let mut file = BufReader::with_capacity(BUFFER, File::open(path).map_err(failed)?);
        let found: Vec<_> = file.fill_buf().map_err(failed)?.iter().take(8).copied().collect();
        let mut files = vec![path.to_owned()];
        let kind = if Recording::begins(&found) {
            files = parts::all_from(path)?;
            Kind::Recording(Box::new(Recording::open(file)))
        } else if let Some(packets) = Packets::open(Input::new(file)).map_err(failed)? {
            Kind::Packets(Box::new(Unpacked::new(packets, options.protocol)))
        } else {
            let path = path.to_owned();
            return Err(Error::NotACapture { path, found });
        };
        Ok(Self {
            files,
            place: 0,
            kind,
            damage: None,
            ended: false,
        })
    }

    /// The kind of file that it is.
    pub fn format(&self) -> Format {
        match &self.kind {
            Kind::Packets(packets) => packets.format(),
            Kind::Recording(_) => Format::Mcap,
        }
    }

    /// The files that are read, in their order: several of a recording that was split.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The sources that datagrams have come from so far, as endpoints; [`Captured::source`] is a place in here. A recording says
    /// where it was recorded from; of other captures it is where datagrams went to, or the NatNet server.
    pub fn sources(&self) -> &[String] {
        match &self.kind {
            Kind::Packets(packets) => packets.origins.names(),
            Kind::Recording(recording) => recording.names(),
        }
    }

    /// What was read so far, and what could not be.
    pub fn counts(&self) -> Counts {
        match &self.kind {
            Kind::Packets(packets) => packets.unpacker.counts(),
            Kind::Recording(recording) => Counts {
                packets: recording.counts().datagrams,
                ..Counts::default()
            },
        }
    }

    /// What ended the capture before its end, if something did.
    pub fn damage(&self) -> Option<&str> {
        self.damage.as_deref()
    }

    /// The next datagram; `None` at the end, or where nothing more can be read.
    fn advance(&mut self) -> io::Result<Option<Captured>> {
        loop {
            let damage = match &mut self.kind {
                Kind::Packets(packets) => match packets.next()? {
                    Ok(captured) => return Ok(captured),
                    Err(damage) => Some(damage),
                },
                Kind::Recording(recording) => match recording.next()? {
                    // The file before has what a later one repeats of it.
                    recording::Next::Datagram(captured) if captured.is_repeated && self.place > 0 => continue,
                    recording::Next::Datagram(captured) => return Ok(Some(captured)),
                    recording::Next::End => None,
                    recording::Next::Damaged(damage) => Some(damage),
                },
            };
            if let Some(damage) = damage {
                self.note_damage(damage);
            }
            if !self.begin_next_file()? {
                return Ok(None);
            }
        }
    }

    /// Says in which of several files the damage is; the first one counts.
    fn note_damage(&mut self, damage: String) {
        let damage = match self.file().file_name() {
            Some(name) if self.files.len() > 1 => format!("{}: {damage}", name.to_string_lossy()),
            _ => damage,
        };
        self.damage.get_or_insert(damage);
    }

    /// `false` when there is none.
    fn begin_next_file(&mut self) -> io::Result<bool> {
        let Kind::Recording(recording) = &mut self.kind else {
            return Ok(false);
        };
        let Some(next) = self.files.get(self.place + 1) else {
            // A file that was opened by itself, from the middle of a recording, stands for itself.
            let wanted = recording
                .next_part()
                .filter(|part| *part as usize == self.files.len() + 1);
            if let Some(part) = wanted {
                self.note_damage(format!("the recording goes on in part {part}, which is missing"));
            }
            return Ok(false);
        };
        self.place += 1;
        recording.go_on(BufReader::with_capacity(BUFFER, File::open(next)?));
        Ok(true)
    }

    /// The file that is being read.
    fn file(&self) -> &Path {
        self.files.get(self.place).map_or(Path::new(""), PathBuf::as_path)
    }
}

impl Iterator for Capture {
    type Item = Result<Captured>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let next = self
            .advance()
            .map_err(|error| Error::read(self.file(), &error))
            .transpose();
        self.ended = !matches!(next, Some(Ok(_)));
        next
    }
}

impl std::fmt::Debug for Capture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Capture")
            .field("files", &self.files)
            .finish_non_exhaustive()
    }
}

const BUFFER: usize = 256 << 10;

#[cfg(test)]
mod tests;
