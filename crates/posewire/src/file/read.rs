//! A whole take from a file.

use super::{Progress, Recording};
use crate::{Error, Result};
use posewire_mvnx::{Reader, read_take};
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

/// How a file is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Whether a damaged file is used up to the damage.
    pub salvage: bool,
    /// How many threads read it; as many as the machine has if absent.
    pub threads: Option<usize>,
}

/// Reads a whole take: an MVNX file of version 3 or 4, plain or gzipped.
///
/// `progress` counts bytes of the file.
///
/// # Errors
/// [`Error::Read`] when the file cannot be opened, [`Error::Take`] when it is not a take, [`Error::NoFrames`] when it holds
/// no frame, [`Error::Stopped`] when `progress` says so.
pub fn read(path: &Path, options: ReadOptions, progress: &Progress) -> Result<Recording> {
    let file = File::open(path).map_err(|error| Error::read(path, &error))?;
    let size = file.metadata().map_err(|error| Error::read(path, &error))?.len();
    progress.begin(size);
    let bytes = Watched { file, progress };
    let recording = read_recording(bytes, options);
    // Salvaging, the reader takes a stop for damage.
    if progress.is_stopped() {
        return Err(Error::Stopped {
            what: format!("reading {}", path.display()),
        });
    }
    let recording = recording.map_err(|error| Error::take(path, error))?;
    if recording.take.is_empty() {
        return Err(Error::NoFrames {
            path: path.display().to_string(),
        });
    }
    Ok(recording)
}

fn read_recording(bytes: impl Read, options: ReadOptions) -> Result<Recording, posewire_mvnx::Error> {
    let mut reader = Reader::new(BufReader::with_capacity(BUFFER, bytes))?.salvage(options.salvage);
    let take = read_take(&mut reader)?;
    Ok(Recording {
        take,
        document: Some(reader.document()),
        damage: reader.damage().map(ToString::to_string),
    })
}

/// A file that counts the bytes read from it and ends with an error when it is to be stopped.
struct Watched<'a> {
    file: File,
    progress: &'a Progress,
}

impl Read for Watched<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(to)?;
        self.progress.advance(count as u64)?;
        Ok(count)
    }
}

const BUFFER: usize = 256 * 1024;
