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

/// Reads a whole take: an MVNX file of version 3 or 4, plain or gzipped, in UTF-8 or UTF-16.
///
/// `progress` counts bytes of the file.
///
/// # Errors
/// [`Error::Read`] when the file cannot be opened, [`Error::Take`] when it is not a take, [`Error::NoFrames`] when it holds
/// no frame, [`Error::Stopped`] when `progress` says so.
pub fn read(path: &Path, options: ReadOptions, progress: &Progress) -> Result<Recording> {
    let mut reader = open(path, options, progress)?;
    let take = read_take(&mut reader);
    // Salvaging, the reader takes a stop for damage.
    let take = match take {
        Ok(take) if !progress.is_stopped() => take,
        Ok(_) => return Err(stopped(path)),
        Err(error) => return Err(read_error(path, error, reader.counts().normal, progress)),
    };
    if take.is_empty() {
        return Err(no_frames(path, reader.damage()));
    }
    Ok(Recording {
        document: Some(reader.document()),
        damage: reader.damage().map(ToString::to_string),
        unread: unread(&reader),
        ..Recording::from(take)
    })
}

/// The names of what is not known in the frames read.
fn unread(reader: &TakeReader<'_>) -> Vec<String> {
    let unknown = reader.sections().iter().filter(|section| !section.known);
    unknown.map(|section| section.name.clone()).collect()
}

/// A reader of an MVNX file that stands before the first frame.
pub(super) fn open<'a>(path: &Path, options: ReadOptions, progress: &'a Progress) -> Result<TakeReader<'a>> {
    let failed = |error: io::Error| {
        if progress.is_stopped() {
            stopped(path)
        } else {
            Error::read(path, &error)
        }
    };
    let file = File::open(path).map_err(failed)?;
    let about = file.metadata().map_err(failed)?;
    if about.is_dir() {
        return Err(failed(io::ErrorKind::IsADirectory.into()));
    }
    progress.begin(about.len());
    let reader = Reader::new(BufReader::with_capacity(BUFFER, Watched { file, progress }));
    let reader = reader.map_err(|error| read_error(path, error, 0, progress))?;
    Ok(reader.salvage(options.salvage).threads(options.threads.unwrap_or(0)))
}

/// What kept a file from being read behind so many frames.
pub(super) fn read_error(path: &Path, error: posewire_mvnx::Error, frames: u64, progress: &Progress) -> Error {
    if progress.is_stopped() {
        return stopped(path);
    }
    Error::take(path, error, frames)
}

/// Why a file that was read to its end, or to the damage that was to be passed over, gave no frame.
pub(super) fn no_frames(path: &Path, damage: Option<&posewire_mvnx::Error>) -> Error {
    match damage {
        Some(damage) => Error::take(path, damage.clone(), 0),
        None => Error::NoFrames {
            path: path.display().to_string(),
        },
    }
}

pub(super) fn stopped(path: &Path) -> Error {
    Error::Stopped {
        what: format!("reading {}", path.display()),
    }
}

/// A reader of a file whose bytes are counted.
pub(super) type TakeReader<'a> = Reader<BufReader<Watched<'a>>>;

/// A file that counts the bytes read from it and ends with an error when it is to be stopped.
#[derive(Debug)]
pub(super) struct Watched<'a> {
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
