//! Making a recording whole again that was cut off.

use super::lock;
use super::part::cannot_write;
use super::records::{Records, is_index};
use crate::beside::{beside, give_name};
use crate::{Error, Result};
use mcap::records::Record;
use mcap::{McapError, WriteOptions};
use std::collections::BTreeMap;
use std::fs::File;
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
/// place only once it is whole and on the disk. Of a file that is being recorded, `to` gets what is in it so far.
///
/// # Errors
/// [`Error::Read`], [`Error::NotMcap`] and [`Error::Compressed`] of the old file; [`Error::Exists`] when `to` is there and is
/// another file than `from`, [`Error::BeingRecorded`] and [`Error::DamagedWithin`] when `to` would replace what is still written or
/// can be read only in part, and [`Error::Write`].
pub fn recover(from: &Path, to: &Path) -> Result<Recovered> {
    let in_place = is_same(from, to);
    let old = File::open(from).map_err(|error| Error::read(from, &error))?;
    if in_place {
        // What a recorder has still to write would go into the old file, which nobody finds any more.
        lock::own(&old, from)?;
    }
    let mut records = Records::open(from)?;
    if to.exists() && !in_place {
        return Err(Error::Exists { path: to.to_owned() });
    }
    let draft = beside(to).map_err(|error| Error::write(to.display().to_string(), &error))?;
    let mut copy = Copy::into(draft.path())?;
    copy_all(&mut records, &mut copy)?;
    let messages = copy.finish()?;
    let damage = records.damage().map(str::to_owned);
    // What follows the damage is in the old file alone.
    if let Some(problem) = damage.clone().filter(|_| in_place && !records.is_cut_off()) {
        let path = from.to_owned();
        return Err(Error::DamagedWithin { path, problem });
    }
    drop(old);
    give_name(draft, to, in_place)?;
    Ok(Recovered {
        messages,
        was_complete: records.is_complete(),
        damage,
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

/// The new file's writer.
struct Copy {
    path: PathBuf,
    writer: mcap::Writer<BufWriter<File>>,
    messages: u64,
    schemas: BTreeMap<u16, u16>,
    channels: BTreeMap<u16, u16>,
}

impl Copy {
    fn into(path: &Path) -> Result<Self> {
        let file = File::create(path).map_err(|error| cannot_write(path, error.into()))?;
        let options = WriteOptions::new()
            .library(concat!("posewire ", env!("CARGO_PKG_VERSION")))
            .compression(None);
        let writer = options.create(BufWriter::with_capacity(BUFFER, file));
        Ok(Self {
            path: path.to_owned(),
            writer: writer.map_err(|error| cannot_write(path, error))?,
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
        let flushed = writer.into_inner().flush();
        flushed.map_err(|error| cannot_write(&path, error.into()))?;
        Ok(messages)
    }
}

const BUFFER: usize = 1 << 20;
