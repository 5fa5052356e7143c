//! A take on the disk.

use super::playback::Frames;
use crate::{Error, Result};
use posewire_motion::kinematics::{AllErgonomicAngles, Differences, complete};
use posewire_motion::{Frame, Subject};
use posewire_mvnx::Reader;
use std::collections::VecDeque;
use std::fmt;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An MVNX file, read as it is played, and what follows from its poses computed where the file lacks it.
pub(super) struct TakeFile {
    path: PathBuf,
    salvage: bool,
    reader: Reader<BufReader<File>>,
    ergonomic: AllErgonomicAngles,
    differences: Differences,
    /// The samples that came out at the end, once the file has ended.
    last: Option<VecDeque<Frame>>,
}

impl TakeFile {
    pub(super) fn open(path: &Path, salvage: bool) -> Result<Self> {
        let reader = open(path, salvage)?;
        let differences = Differences::new(rate_hz(reader.subject()));
        let ergonomic = AllErgonomicAngles::of(reader.subject());
        Ok(Self {
            path: path.to_owned(),
            salvage,
            reader,
            ergonomic,
            differences,
            last: None,
        })
    }
}

/// Opens an MVNX file, plain or gzipped, for reading frame by frame.
///
/// # Errors
/// [`Error::Read`] when the file cannot be opened, [`Error::Take`] when it is not a take.
pub(crate) fn open(path: &Path, salvage: bool) -> Result<Reader<BufReader<File>>> {
    let file = File::open(path).map_err(|error| Error::read(path, &error))?;
    let reader = Reader::new(BufReader::with_capacity(BUFFER, file)).map_err(|error| Error::take(path, error))?;
    Ok(reader.salvage(salvage))
}

fn rate_hz(subject: &Arc<Subject>) -> f64 {
    subject.rate.unwrap_or(USUAL_RATE)
}

impl Frames for TakeFile {
    fn rate_hz(&self) -> f64 {
        rate_hz(self.reader.subject())
    }

    fn next_sample(&mut self, frames: &mut Vec<Frame>) -> Result<bool> {
        while self.last.is_none() {
            let completed = match self.reader.next() {
                Some(frame) => {
                    let mut frame = frame.map_err(|error| Error::take(&self.path, error))?;
                    self.ergonomic.complete(&mut frame);
                    complete(&mut frame);
                    self.differences.push(frame)
                }
                None => self.last.insert(self.differences.finish().collect()).pop_front(),
            };
            if let Some(frame) = completed {
                frames.push(frame);
                return Ok(true);
            }
        }
        let last = self.last.as_mut().and_then(VecDeque::pop_front);
        frames.extend(last);
        Ok(!frames.is_empty())
    }

    fn rewind(&mut self) -> Result<()> {
        *self = Self::open(&self.path, self.salvage)?;
        Ok(())
    }

    fn damage(&self) -> Option<String> {
        self.reader.damage().map(ToString::to_string)
    }
}

impl fmt::Debug for TakeFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TakeFile")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

const BUFFER: usize = 256 * 1024;
/// For a file that does not say: what MVN records with Awinda.
const USUAL_RATE: f64 = 60.0;
