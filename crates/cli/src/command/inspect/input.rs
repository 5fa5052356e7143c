//! A take's file, and what to say when it is something else.

use crate::error::Usage;
use crate::plain::plural;
use posewire::endpoint::Endpoint;
use posewire_motion::Frame;
use posewire_mvnx::Reader;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// An MVNX file that is being read.
pub(super) struct TakeFile {
    pub(super) path: PathBuf,
    /// Bytes on the disk.
    pub(super) size: u64,
    pub(super) compressed: bool,
    pub(super) reader: Reader<BufReader<Counted>>,
    read: Arc<AtomicU64>,
}

impl TakeFile {
    /// Opens a file and reads what stands before its frames.
    pub(super) fn open(path: &Path, salvage: bool) -> anyhow::Result<Self> {
        let wrong_name = check_name(path)?;
        let file = File::open(path).map_err(|error| posewire::Error::read(path, &error))?;
        let size = file
            .metadata()
            .map_err(|error| posewire::Error::read(path, &error))?
            .len();
        let read = Arc::new(AtomicU64::new(0));
        let mut bytes = BufReader::with_capacity(
            BUFFER,
            Counted {
                file,
                read: Arc::clone(&read),
            },
        );
        let beginning = bytes.fill_buf().map_err(|error| posewire::Error::read(path, &error))?;
        refuse_datagrams(path, beginning)?;
        let compressed = beginning.starts_with(&GZIP);
        let may_be_take = compressed || is_markup(beginning);
        if let Some(error) = wrong_name.filter(|_| !may_be_take) {
            return Err(error.into());
        }
        let reader = Reader::new(bytes).map_err(|error| posewire::Error::take(path, error, 0))?;
        Ok(Self {
            path: path.to_owned(),
            size,
            compressed,
            reader: reader.salvage(salvage),
            read,
        })
    }

    /// The next frame, `None` at the end.
    pub(super) fn next_frame(&mut self) -> posewire::Result<Option<Frame>> {
        let frame = self.reader.next().transpose();
        frame.map_err(|error| posewire::Error::take(&self.path, error, self.reader.counts().normal))
    }

    /// How far it was read, in one line.
    pub(super) fn progress(&self, frames: u64) -> String {
        let percent = self.read.load(Ordering::Relaxed) * 100 / self.size.max(1);
        format!(
            "reading {}: {percent} %, {}",
            self.path.display(),
            plural(frames, "frame")
        )
    }
}

/// A file that counts the bytes read from it.
pub(super) struct Counted {
    file: File,
    read: Arc<AtomicU64>,
}

impl Read for Counted {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(to)?;
        self.read.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

/// Refuses what is no file that could be a take. The ending of another format counts only when the content is no markup.
fn check_name(path: &Path) -> anyhow::Result<Option<posewire::Error>> {
    let text = path.to_string_lossy();
    let usage = |problem: String, help: String| Err(Usage { problem, help }.into());
    match text.parse() {
        Ok(Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_) | Endpoint::NatNet(_)) => usage(
            format!("{text} is a live stream, inspect reads a take"),
            format!("posewire monitor {text}"),
        ),
        Ok(Endpoint::Synthetic(_)) => usage(
            format!("{text} is not a file"),
            "posewire demo shows the walker".to_owned(),
        ),
        Ok(_) | Err(posewire::Error::UnknownFormat { .. }) => Ok(None),
        Err(error @ posewire::Error::NotSupportedYet { .. }) => Ok(Some(error)),
        Err(error) => Err(error.into()),
    }
}

fn refuse_datagrams(path: &Path, beginning: &[u8]) -> Result<(), Usage> {
    if !beginning.starts_with(&posewire_mxtp::Header::MAGIC) {
        return Ok(());
    }
    let name = path.display();
    Err(Usage {
        problem: format!("{name} holds MXTP datagrams, inspect reads a take"),
        help: format!("posewire explain {name}"),
    })
}

fn is_markup(beginning: &[u8]) -> bool {
    let text = beginning.strip_prefix(BYTE_ORDER_MARK).unwrap_or(beginning);
    text.trim_ascii_start().starts_with(b"<")
}

const BUFFER: usize = 256 * 1024;
const GZIP: [u8; 2] = [0x1f, 0x8b];
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
