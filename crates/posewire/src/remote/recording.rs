//! Control of a recorder.

use super::{Controlled, Status};
use crate::recording::TakeName;
use crate::sink::{TakeProgress, Takes};
use posewire_mxtp::remote::Content;

/// Begins and ends takes as MVN's remote control has its recordings begun and ended.
pub struct RecordingControl {
    takes: Takes,
    /// Hears of each take that has ended.
    ended: Box<dyn FnMut(&TakeProgress) + Send>,
}

impl RecordingControl {
    /// Control of these takes; `ended` hears how each went.
    pub fn new(takes: Takes, ended: Box<dyn FnMut(&TakeProgress) + Send>) -> Self {
        Self { takes, ended }
    }
}

impl Controlled for RecordingControl {
    /// One that cannot be written any more is recorded no more.
    fn status(&self) -> Status {
        let progress = self.takes.progress();
        let recording = progress.recording.filter(|take| take.recorded.failure.is_none());
        let file = recording.map(|recording| recording.recorded.file);
        let stem = |file: std::path::PathBuf| file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Status {
            recording: file.and_then(stem),
            recordings: progress.takes,
            paused: false,
            live: true,
        }
    }

    fn start_recording(&mut self, name: &TakeName) -> Result<String, String> {
        let file = self.takes.begin(name).map_err(|error| error.to_string())?;
        Ok(format!("records {}", file.display()))
    }

    fn stop_recording(&mut self) -> Result<String, String> {
        let ended = self.takes.end().map_err(|error| error.to_string())?;
        let take = ended.ok_or("nothing is being recorded")?;
        (self.ended)(&take);
        Ok(format!("ends {}", take.recorded.file.display()))
    }

    fn carry_out(&mut self, request: &Content) -> Result<String, String> {
        let _ = request;
        Err("a recorder cannot do this".to_owned())
    }
}
