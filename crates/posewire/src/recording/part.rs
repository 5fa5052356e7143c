//! One MCAP file, being written.

use super::format::{Keys, protocol};
use super::lock::{self, Whereabouts};
use super::poses;
use crate::{Error, Result};
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{McapError, WriteOptions};
use posewire_motion::Stamp;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// One MCAP file, being written. Chunks are built in memory and written as a whole, so that only the last can be torn.
pub(super) struct Part {
    path: PathBuf,
    /// The same open file, to cut off a torn chunk and to see it onto the disk.
    file: File,
    writer: mcap::Writer<NoSeek<BufWriter<Counted>>>,
    written: Arc<AtomicU64>,
    /// How long the file was when it last ended with a whole chunk.
    whole: u64,
    /// Bytes of messages that are not in the file yet, with what stands around them.
    pending: u64,
    channels: u64,
    /// Bytes of what the end repeats of channels and metadata.
    repeated: u64,
    chunks: u64,
}

/// A message to be written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Message<'a> {
    pub(super) channel: u16,
    pub(super) sequence: u32,
    pub(super) at: Stamp,
    pub(super) data: &'a [u8],
}

impl Part {
    /// Creates the file, which nobody else records into until this is closed. One that is there is replaced only with `overwrite`.
    pub(super) fn create(path: &Path, overwrite: bool) -> Result<Self> {
        let file = lock::create(path, overwrite)?;
        let same = file
            .try_clone()
            .map_err(|error| Error::write(path.display().to_string(), &error))?;
        let written = Arc::new(AtomicU64::new(0));
        let counted = Counted {
            file: same,
            written: Arc::clone(&written),
        };
        let options = WriteOptions::new()
            .library(concat!("posewire ", env!("CARGO_PKG_VERSION")))
            .compression(None)
            .chunk_size(Some(CHUNK))
            // Every chunk has its own checksum, which is all that a file without an end can have.
            .calculate_data_section_crc(false)
            .disable_seeking(true);
        let writer = options.create(NoSeek::new(BufWriter::with_capacity(BUFFER, counted)));
        Ok(Self {
            path: path.to_owned(),
            file,
            writer: writer.map_err(|error| cannot_write(path, error))?,
            written,
            whole: 0,
            pending: 0,
            channels: 0,
            repeated: FOOTER,
            chunks: 0,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The file as it is open, to see it onto the disk from elsewhere.
    pub(super) fn handle(&self) -> Option<File> {
        self.file.try_clone().ok()
    }

    /// Whether the file still has its name.
    pub(super) fn whereabouts(&self) -> Whereabouts {
        lock::whereabouts(&self.file, &self.path)
    }

    /// How long the file is, and will be with what is not in it yet.
    pub(super) fn length(&self) -> u64 {
        self.written.load(Ordering::Relaxed).max(self.whole) + self.pending
    }

    /// How long the file will be with its end.
    pub(super) fn whole_length(&self) -> u64 {
        let chunks = self.chunks + self.pending.div_ceil(CHUNK);
        self.length() + self.repeated + chunks * (CHUNK_INDEXED + self.channels * CHANNEL_INDEXED)
    }

    /// Adds a channel for datagrams.
    pub(super) fn raw_channel(&mut self, topic: &str, wire: crate::Wire, keys: &Keys) -> Result<u16> {
        self.note_channel(topic, keys, 0);
        let added = self.writer.add_channel(0, topic, protocol(wire), keys);
        added.map_err(|error| cannot_write(&self.path, error))
    }

    /// Adds a channel for poses.
    pub(super) fn pose_channel(&mut self, topic: &str, keys: &Keys) -> Result<u16> {
        let schema = poses::SCHEMA.as_bytes();
        self.note_channel(topic, keys, schema.len() as u64);
        let schema = self
            .writer
            .add_schema(poses::SCHEMA_NAME, poses::SCHEMA_ENCODING, schema);
        let added = schema.and_then(|schema| self.writer.add_channel(schema, topic, poses::MESSAGE_ENCODING, keys));
        added.map_err(|error| cannot_write(&self.path, error))
    }

    pub(super) fn message(&mut self, message: Message<'_>) -> Result<()> {
        let at = u64::try_from(message.at.nanoseconds()).unwrap_or_default();
        let header = MessageHeader {
            channel_id: message.channel,
            sequence: message.sequence,
            log_time: at,
            publish_time: at,
        };
        self.pending += MESSAGE + message.data.len() as u64;
        let written = self.writer.write_to_known_channel(&header, message.data);
        written.map_err(|error| cannot_write(&self.path, error))
    }

    fn note_channel(&mut self, topic: &str, keys: &Keys, schema: u64) {
        let length = CHANNEL + topic.len() as u64 + length_of(keys) + schema;
        self.channels += 1;
        // It stands in the data as well.
        self.repeated += length;
        self.pending += length;
    }

    pub(super) fn metadata(&mut self, name: &str, metadata: Keys) -> Result<()> {
        self.repeated += METADATA_INDEXED + name.len() as u64;
        self.pending += METADATA_INDEXED + length_of(&metadata);
        let record = Metadata {
            name: name.to_owned(),
            metadata,
        };
        let written = self.writer.write_metadata(&record);
        written.map_err(|error| cannot_write(&self.path, error))
    }

    /// Hands everything to the system: what was written by now outlives this program.
    pub(super) fn flush(&mut self) -> Result<()> {
        let flushed = self.writer.flush();
        flushed.map_err(|error| cannot_write(&self.path, error))?;
        self.whole = self.written.load(Ordering::Relaxed);
        self.chunks += self.pending.div_ceil(CHUNK);
        self.pending = 0;
        Ok(())
    }

    /// Writes the index and sees everything onto the disk. Gives how long the file is.
    pub(super) fn finish(mut self) -> Result<u64> {
        let finished = self.writer.finish();
        finished.map_err(|error| cannot_write(&self.path, error))?;
        let flushed = self.writer.into_inner().into_inner().flush();
        let synced = flushed.and_then(|()| match self.file.sync_all() {
            // A pipe, which is not on this disk.
            Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
            synced => synced,
        });
        synced.map_err(|error| Error::write(self.path.display().to_string(), &error))?;
        // Whoever sees it onto the disk may have it open for longer.
        let _ = self.file.unlock();
        Ok(self.written.load(Ordering::Relaxed))
    }

    /// Gives the file up after a failure, without the chunk that is torn. Gives how long it is.
    pub(super) fn abandon(self) -> u64 {
        let Self {
            writer, file, whole, ..
        } = self;
        let (buffered, _) = writer.into_inner().into_inner().into_parts();
        drop(buffered);
        // When this fails too, what comes before the torn chunk can be read all the same.
        let _ = file.set_len(whole);
        let _ = file.unlock();
        whole
    }
}

/// A file that counts what it takes.
struct Counted {
    file: File,
    written: Arc<AtomicU64>,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.file.write(bytes)?;
        self.written.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

fn length_of(keys: &Keys) -> u64 {
    let lengths = keys.iter().map(|(key, value)| key.len() + value.len() + 8);
    lengths.sum::<usize>() as u64
}

pub(super) fn cannot_write(path: &Path, error: McapError) -> Error {
    let error = match error {
        McapError::Io(error) => error,
        other => io::Error::other(other),
    };
    Error::write(path.display().to_string(), &error)
}

/// A chunk is written when it has so many bytes, or when it has waited long enough.
const CHUNK: u64 = 1 << 20;
const BUFFER: usize = 64 << 10;
/// What a message has around it and in the index, in bytes; so the others.
const MESSAGE: u64 = 31 + 16;
const CHANNEL: u64 = 64;
const CHANNEL_INDEXED: u64 = 10 + 15;
const CHUNK_INDEXED: u64 = 73 + 57;
const METADATA_INDEXED: u64 = 64;
/// The records with which every file ends.
const FOOTER: u64 = 2048;
