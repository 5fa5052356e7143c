//! Making a recording whole again that was cut off.

use super::part::cannot_write;
use super::records::{Records, is_index};
use crate::{Error, Result};
use mcap::records::Record;
use mcap::{McapError, WriteOptions};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// What was recovered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recovered {
    /// Messages that are in the new file.
    pub messages: u64,
    /// Whether the old file was finished, so that there was nothing to recover.
    pub was_complete: bool,
    /// Why nothing after them could be read.
    pub damage: Option<String>,
}

/// Writes what can be read of `from` into `to`, with an index. `from` and `to` may be the same file. The new file stands at its
/// place only once it is whole and on the disk.
///
/// # Errors
/// [`Error::Read`], [`Error::NotMcap`] and [`Error::Compressed`] of the old file; [`Error::Exists`] when `to` is there and is
/// another file than `from`, and [`Error::Write`].
pub fn recover(from: &Path, to: &Path) -> Result<Recovered> {
    let mut records = Records::open(from)?;
    if to.exists() && !is_same(from, to) {
        return Err(Error::Exists { path: to.to_owned() });
    }
    let draft = Draft::beside(to);
    let mut copy = Copy::into(&draft)?;
    copy_all(&mut records, &mut copy)?;
    let messages = copy.finish()?;
    draft.rename(to)?;
    Ok(Recovered {
        messages,
        was_complete: records.is_complete(),
        damage: records.damage().map(str::to_owned),
    })
}

fn copy_all(records: &mut Records, copy: &mut Copy) -> Result<()> {
    while records.next(|record| copy.take(record))? {}
    Ok(())
}

fn is_same(from: &Path, to: &Path) -> bool {
    match (from.canonicalize(), to.canonicalize()) {
        (Ok(from), Ok(to)) => from == to,
        _ => false,
    }
}

/// The new file before it has its name; it goes with its owner unless it was renamed.
struct Draft {
    path: PathBuf,
}

impl Draft {
    fn beside(to: &Path) -> Self {
        let mut name = to.file_name().unwrap_or_default().to_owned();
        name.push(".recovering");
        let path = to.with_file_name(name);
        Self { path }
    }

    fn rename(self, to: &Path) -> Result<()> {
        let renamed = fs::rename(&self.path, to);
        renamed.map_err(|error| Error::write(to.display().to_string(), &error))
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // After the renaming it is not there.
        let _ = fs::remove_file(&self.path);
    }
}

/// The new file's writer.
struct Copy {
    path: PathBuf,
    writer: mcap::Writer<BufWriter<File>>,
    messages: u64,
    schemas: BTreeMap<u16, u16>,
    channels: BTreeMap<u16, u16>,
}

impl Copy {
    fn into(draft: &Draft) -> Result<Self> {
        let file = File::create(&draft.path).map_err(|error| cannot_write(&draft.path, error.into()))?;
        let options = WriteOptions::new()
            .library(concat!("posewire ", env!("CARGO_PKG_VERSION")))
            .compression(None);
        let writer = options.create(BufWriter::with_capacity(BUFFER, file));
        Ok(Self {
            path: draft.path.clone(),
            writer: writer.map_err(|error| cannot_write(&draft.path, error))?,
            messages: 0,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
        })
    }

    fn take(&mut self, record: Record<'_>) -> Result<()> {
        if is_index(&record) {
            return Ok(());
        }
        let written = self.write(record);
        written.map_err(|error| cannot_write(&self.path, error))
    }

    fn write(&mut self, record: Record<'_>) -> Result<(), McapError> {
        match record {
            Record::Schema { header, data } => {
                let id = self.writer.add_schema(&header.name, &header.encoding, &data)?;
                self.schemas.insert(header.id, id);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).copied().unwrap_or_default();
                let (topic, encoding) = (&channel.topic, &channel.message_encoding);
                let id = self.writer.add_channel(schema, topic, encoding, &channel.metadata)?;
                self.channels.insert(channel.id, id);
            }
            Record::Message { mut header, data } => {
                // A message on a channel that was never told of cannot be read by anybody.
                if let Some(id) = self.channels.get(&header.channel_id) {
                    header.channel_id = *id;
                    self.writer.write_to_known_channel(&header, &data)?;
                    self.messages += 1;
                }
            }
            Record::Metadata(metadata) => self.writer.write_metadata(&metadata)?,
            _ => {}
        }
        Ok(())
    }

    fn finish(mut self) -> Result<u64> {
        let finished = self.writer.finish();
        finished.map_err(|error| cannot_write(&self.path, error))?;
        let Self {
            path, writer, messages, ..
        } = self;
        let mut file = writer.into_inner();
        let flushed = file.flush().and_then(|()| file.get_ref().sync_all());
        flushed.map_err(|error| cannot_write(&path, error.into()))?;
        Ok(messages)
    }
}

const BUFFER: usize = 1 << 20;
