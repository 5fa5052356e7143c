//! Takes that pages begin, end, list and fetch.

use posewire::recording::TakeName;
use posewire::sink::{TakeProgress, Takes};
use serde::Serialize;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, UNIX_EPOCH};
use tokio::sync::watch;
use tokio::task::spawn_blocking;
use tokio::time::sleep;

/// What pages may record with: the takes of a session's [`TakesSink`](posewire::sink::TakesSink), and the folder that they
/// go to. Clones are the same recorder.
#[derive(Clone, Debug)]
pub struct Recorder {
    takes: Takes,
    folder: Arc<Path>,
    /// Why the last take ended that ended badly, until another begins.
    failure: Arc<Mutex<Option<String>>>,
}

/// What a recorder does, as pages are told.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct RecorderRecord {
    enabled: bool,
    pub(crate) state: RecorderState,
    pub(crate) name: Option<String>,
    seconds: f64,
    bytes: u64,
    datagrams: u64,
    lost: u64,
    error: Option<String>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum RecorderState {
    #[default]
    Idle,
    Recording,
    Failed,
}

/// A file in the folder.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct RecordingRecord {
    name: String,
    bytes: u64,
    /// When it was last written, seconds since 1970.
    modified: u64,
}

/// Why a take does not begin or end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Refused {
    /// The name cannot be that of a take.
    Name(String),
    /// A take runs already, or none does.
    State(String),
    /// It cannot be written.
    Write { error: String, help: Option<String> },
}

impl Recorder {
    /// A recorder of the takes that go to `folder`.
    pub fn new(takes: Takes, folder: &Path) -> Self {
        Self {
            takes,
            folder: folder.into(),
            failure: Arc::default(),
        }
    }

    /// Begins a take.
    ///
    /// # Errors
    /// Why it does not begin; the name cannot lead out of the folder.
    pub(crate) fn begin(&self, name: &str) -> Result<(), Refused> {
        let name = name.parse::<TakeName>();
        let name = name.map_err(|error| Refused::Name(error.to_string()))?;
        self.takes
            .begin(&name)
            .map(drop)
            .map_err(|error| self.refusal(&error))?;
        self.set_failure(None);
        Ok(())
    }

    /// Ends the take.
    ///
    /// # Errors
    /// Why it does not, and what of it could not be written.
    pub(crate) fn end(&self) -> Result<(), Refused> {
        match self.takes.end() {
            Ok(Some(_)) => Ok(()),
            Ok(None) => Err(Refused::State("nothing is being recorded".to_owned())),
            Err(error) => Err(self.refusal(&error)),
        }
    }

    /// What it does.
    pub(crate) fn record(&self) -> RecorderRecord {
        let idle = RecorderRecord {
            enabled: true,
            ..RecorderRecord::default()
        };
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match (self.takes.progress().recording, failure) {
            (Some(take), _) => self.of_take(&take),
            (None, Some(error)) => RecorderRecord {
                state: RecorderState::Failed,
                error: Some(error),
                ..idle
            },
            (None, None) => idle,
        }
    }

    /// Keeps `record` up to date for as long as somebody looks at it.
    pub(crate) async fn watch(self, record: watch::Sender<RecorderRecord>) {
        while !record.is_closed() {
            sleep(LOOK_EVERY).await;
            let recorder = self.clone();
            if let Ok(newest) = spawn_blocking(move || recorder.record()).await {
                record.send_replace(newest);
            }
        }
    }

    /// The recordings in the folder, the newest first.
    pub(crate) fn recordings(&self) -> Vec<RecordingRecord> {
        let mut recordings: Vec<_> = self.files().map(|(_, recording)| recording).collect();
        recordings.sort_by(|a, b| (b.modified, &a.name).cmp(&(a.modified, &b.name)));
        recordings
    }

    /// Opens a recording that is listed by this name, with its length; `None` where none is.
    ///
    /// # Errors
    /// Those of the system.
    pub(crate) fn open(&self, name: &str) -> io::Result<Option<(File, u64)>> {
        let found = self.files().find(|(_, recording)| recording.name == name);
        let Some((path, _)) = found else { return Ok(None) };
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Ok(Some((file, length)))
    }

    /// Plain files in the folder that are named as recordings are.
    fn files(&self) -> impl Iterator<Item = (PathBuf, RecordingRecord)> {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        entries.filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_recording = Path::new(&name).extension().is_some_and(|ending| ending == "mcap");
            let is_plain = entry.file_type().is_ok_and(|kind| kind.is_file());
            let about = entry.metadata().ok().filter(|_| is_recording && is_plain)?;
            let modified = about.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok());
            let recording = RecordingRecord {
                name,
                bytes: about.len(),
                modified: modified.map_or(0, |since| since.as_secs()),
            };
            Some((entry.path(), recording))
        })
    }

    fn refusal(&self, error: &posewire::Error) -> Refused {
        match error {
            posewire::Error::TakeRuns { .. } | posewire::Error::Stopped { .. } => Refused::State(self.told(error)),
            error => {
                self.set_failure(Some(self.told(error)));
                Refused::Write {
                    error: self.told(error),
                    help: error.help(),
                }
            }
        }
    }

    fn of_take(&self, take: &TakeProgress) -> RecorderRecord {
        let recorded = &take.recorded;
        let failure = recorded.failure.as_ref();
        let name = recorded
            .file
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned());
        RecorderRecord {
            enabled: true,
            state: failure.map_or(RecorderState::Recording, |_| RecorderState::Failed),
            name,
            seconds: take.lasted.as_secs_f64(),
            bytes: recorded.bytes,
            datagrams: recorded.datagrams(),
            lost: recorded.lost(),
            error: failure.map(|error| self.told(error)),
        }
    }

    /// What pages are told of an error: not where on the disk the folder is.
    fn told(&self, error: &posewire::Error) -> String {
        error.to_string().replace(&format!("{}/", self.folder.display()), "")
    }

    fn set_failure(&self, failure: Option<String>) {
        *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = failure;
    }
}

const LOOK_EVERY: Duration = Duration::from_millis(100);
