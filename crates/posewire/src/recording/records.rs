//! The records of an MCAP file, one after the other, as far as the file goes.

use crate::{Error, Result};
use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// Reads the records of the data section, those of chunks included; only from chunks whose checksum is right.
pub(super) struct Records {
    path: PathBuf,
    file: BufReader<File>,
    reader: LinearReader,
    /// What ended the records before their end.
    damage: Option<String>,
    /// Whether that is nothing but the end of the file.
    cut_off: bool,
    /// Whether the data's end was seen, behind which come the index and the footer.
    data_ended: bool,
    complete: bool,
}

impl Records {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let failed = |error: std::io::Error| Error::read(path, &error);
        let file = File::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        // No record is longer than its file; and none of ours is near the limit.
        let limit = usize::try_from(length).unwrap_or(MOST).min(MOST);
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(limit);
        Ok(Self {
            path: path.to_owned(),
            file: BufReader::with_capacity(BUFFER, file),
            reader: LinearReader::new_with_options(options),
            damage: None,
            cut_off: false,
            data_ended: false,
            complete: false,
        })
    }

    /// Gives the next record to `take`; `false` at the end, be it the file's own or that of what can be read.
    ///
    /// # Errors
    /// [`Error::Read`] when the file cannot be read, [`Error::NotMcap`] when it is none.
    pub(super) fn next(&mut self, take: impl FnOnce(Record<'_>) -> Result<()>) -> Result<bool> {
        while let Some(event) = self.reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(need)) => {
                    let read = self.file.read(self.reader.insert(need));
                    let count = read.map_err(|error| Error::read(&self.path, &error))?;
                    self.reader.notify_read(count);
                }
                Ok(LinearReadEvent::Record { opcode, data }) => match mcap::parse_record(opcode, data) {
                    // What comes after the data is made anew from it.
                    Ok(Record::DataEnd(_)) => self.data_ended = true,
                    Ok(Record::Footer(_)) => {
                        self.complete = true;
                        return Ok(false);
                    }
                    Ok(_) if self.data_ended => {}
                    Ok(record) => return take(record).map(|()| true),
                    Err(error) => return self.end(&error),
                },
                Err(error) => return self.end(&error),
            }
        }
        Ok(false)
    }

    /// Whether the file's footer was seen: the recording was finished.
    pub(super) fn is_complete(&self) -> bool {
        self.complete
    }

    /// Why the records ended before the data's end.
    pub(super) fn damage(&self) -> Option<&str> {
        self.damage.as_deref()
    }

    /// Whether the records ended where the file does, so that nothing follows them.
    pub(super) fn is_cut_off(&self) -> bool {
        self.cut_off
    }

    fn end(&mut self, error: &McapError) -> Result<bool> {
        if matches!(error, McapError::BadMagic) && !self.data_ended {
            return Err(Error::NotMcap {
                path: self.path.clone(),
            });
        }
        if let McapError::UnsupportedCompression(_) = error {
            return Err(Error::Compressed {
                path: self.path.clone(),
            });
        }
        self.cut_off = matches!(error, McapError::UnexpectedEof);
        self.damage = Some(if self.cut_off {
            "its end is lacking".to_owned()
        } else {
            error.to_string()
        });
        Ok(false)
    }
}

/// Whether a record is of the kind that stands in an index, which is made anew when the file is written anew.
pub(super) fn is_index(record: &Record<'_>) -> bool {
    let made = [op::HEADER, op::MESSAGE_INDEX, op::CHUNK_INDEX, op::ATTACHMENT_INDEX];
    made.contains(&record.opcode())
}

const BUFFER: usize = 1 << 20;
const MOST: usize = 1 << 30;
