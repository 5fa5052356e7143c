//! The raw datagrams of a recording (MCAP), also of one that was cut off.

use super::Captured;
use super::parts::Place;
use crate::recording::{END, RECORDING, SOURCE_RECORD, is_continued};
use crate::{Datagram, Wire};
use mcap::McapError;
use mcap::records::{Channel, MessageHeader, Metadata, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use posewire_motion::Stamp;
use std::collections::BTreeMap;
use std::io::{self, Read};

/// A recording being read from its beginning to its end; no index is needed.
pub(super) struct Recording {
    from: Box<dyn Read + Send>,
    reader: LinearReader,
    channels: BTreeMap<u16, Raw>,
    names: Vec<String>,
    place: Option<Place>,
    continued: bool,
    /// Whether the end of the data was read.
    has_ended: bool,
    counts: Counts,
}

/// A channel of raw datagrams.
struct Raw {
    source: u16,
    wire: Wire,
    from: std::net::SocketAddr,
    to: std::net::SocketAddr,
    is_repeated: bool,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) datagrams: u64,
    /// Messages of other programs, of channels that are not there.
    pub(super) other: u64,
}

/// What comes next in a recording.
pub(super) enum Next {
    Datagram(Captured),
    End,
    /// Nothing behind this place can be read.
    Damaged(String),
}

impl Recording {
    /// Whether a file begins as a recording does.
    pub(super) fn begins(bytes: &[u8]) -> bool {
        bytes.starts_with(mcap::MAGIC)
    }

    pub(super) fn open(from: impl Read + Send + 'static) -> Self {
        let options = LinearReaderOptions::default()
            .with_skip_end_magic(true)
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(LONGEST_RECORD);
        Self {
            from: Box::new(from),
            reader: LinearReader::new_with_options(options),
            channels: BTreeMap::new(),
            names: Vec::new(),
            place: None,
            continued: false,
            has_ended: false,
            counts: Counts::default(),
        }
    }

    /// The endpoints of the sources, each at its number.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    pub(super) fn counts(&self) -> Counts {
        self.counts
    }

    /// Which file of which recording it is, once that was read.
    pub(super) fn place(&self) -> Option<&Place> {
        self.place.as_ref()
    }

    /// The number of the file in which the recording goes on, once the end of this one was read that says so.
    pub(super) fn next_part(&self) -> Option<u32> {
        let place = self.place.as_ref().filter(|_| self.continued)?;
        place.part.checked_add(1)
    }

    /// Goes on with the next file of the same recording.
    pub(super) fn go_on(&mut self, from: impl Read + Send + 'static) {
        let Self {
            names, place, counts, ..
        } = std::mem::replace(self, Self::open(from));
        (self.names, self.place, self.counts) = (names, place, counts);
    }

    /// The next datagram.
    pub(super) fn next(&mut self) -> io::Result<Next> {
        loop {
            let read = match self.reader.next_event() {
                None if self.has_ended => return Ok(Next::End),
                // It is cut off also where it ends with a whole chunk.
                None => return Ok(Next::Damaged(problem(&McapError::UnexpectedEof))),
                Some(Err(error)) => return Ok(Next::Damaged(problem(&error))),
                Some(Ok(LinearReadEvent::ReadRequest(wanted))) => Err(wanted),
                Some(Ok(LinearReadEvent::Record { opcode, data })) => {
                    self.has_ended |= opcode == op::DATA_END;
                    Ok(parse(opcode, data))
                }
            };
            match read {
                Err(wanted) => self.fill(wanted)?,
                Ok(Err(error)) => return Ok(Next::Damaged(problem(&error))),
                Ok(Ok(Some(Parsed::Message(header, bytes)))) => {
                    if let Some(captured) = self.message(header, bytes) {
                        return Ok(Next::Datagram(captured));
                    }
                }
                Ok(Ok(Some(Parsed::Channel(channel)))) => self.channel(&channel),
                Ok(Ok(Some(Parsed::Metadata(metadata)))) => self.metadata(&metadata),
                Ok(Ok(None)) => {}
            }
        }
    }

    fn fill(&mut self, wanted: usize) -> io::Result<()> {
        let room = self.reader.insert(wanted.clamp(AT_ONCE, LONGEST_RECORD));
        let count = loop {
            match self.from.read(room) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => break read?,
            }
        };
        self.reader.notify_read(count);
        Ok(())
    }

    fn message(&mut self, header: MessageHeader, bytes: Box<[u8]>) -> Option<Captured> {
        let Some(raw) = self.channels.get(&header.channel_id) else {
            self.counts.other += 1;
            return None;
        };
        self.counts.datagrams += 1;
        Some(Captured {
            source: raw.source,
            is_repeated: raw.is_repeated,
            datagram: Datagram {
                wire: raw.wire,
                from: raw.from,
                to: raw.to,
                received: Stamp(i64::try_from(header.log_time).unwrap_or(i64::MAX)),
                bytes,
            },
        })
    }

    fn channel(&mut self, channel: &Channel) {
        if let Some(raw) = Raw::of(channel) {
            self.name(raw.source, None);
            self.channels.insert(channel.id, raw);
        }
    }

    fn metadata(&mut self, metadata: &Metadata) {
        let value = |key: &str| metadata.metadata.get(key);
        if metadata.name == RECORDING {
            let text = |key: &str| value(key).cloned().unwrap_or_default();
            let part = value("part").and_then(|part| part.parse().ok());
            self.place = part.map(|part| Place {
                recording: (text("started"), text("host")),
                part,
            });
        }
        self.continued |= metadata.name == END && is_continued(&metadata.metadata);
        if metadata.name == SOURCE_RECORD
            && let Some(source) = value("source").and_then(|number| number.parse().ok())
        {
            self.name(source, value("endpoint").cloned());
        }
    }

    fn name(&mut self, source: u16, name: Option<String>) {
        let place = usize::from(source);
        if self.names.len() <= place {
            self.names.resize(place + 1, String::new());
        }
        if let (Some(known), Some(name)) = (self.names.get_mut(place), name) {
            *known = name;
        }
    }
}

impl Raw {
    /// `None` for a channel of something else.
    fn of(channel: &Channel) -> Option<Self> {
        let value = |key: &str| channel.metadata.get(key);
        let is_repeated = match value("posewire")?.as_str() {
            "raw" => false,
            "repeated" => true,
            _ => return None,
        };
        Some(Self {
            source: value("source")?.parse().ok()?,
            wire: Wire::named(value("wire")?)?,
            from: value("from")?.parse().ok()?,
            to: value("to")?.parse().ok()?,
            is_repeated,
        })
    }
}

/// A record that matters.
enum Parsed {
    Message(MessageHeader, Box<[u8]>),
    Channel(Channel),
    Metadata(Metadata),
}

fn parse(opcode: u8, data: &[u8]) -> Result<Option<Parsed>, McapError> {
    if ![op::MESSAGE, op::CHANNEL, op::METADATA].contains(&opcode) {
        return Ok(None);
    }
    Ok(match mcap::parse_record(opcode, data)? {
        Record::Message { header, data } => Some(Parsed::Message(header, data.as_ref().into())),
        Record::Channel(channel) => Some(Parsed::Channel(channel)),
        Record::Metadata(metadata) => Some(Parsed::Metadata(metadata)),
        _ => None,
    })
}

fn problem(error: &McapError) -> String {
    match error {
        McapError::UnexpectedEof | McapError::UnexpectedEoc => "the recording was cut off".to_owned(),
        McapError::UnsupportedCompression(name) => format!("its chunks are compressed with {name}, which is not read"),
        error => error.to_string(),
    }
}

const AT_ONCE: usize = 64 << 10;
/// A datagram has 64 KiB at most; what describes a subject may be longer.
const LONGEST_RECORD: usize = 16 << 20;
