//! Sees a recording onto the disk while it is written.

use crate::recording::Writer;
use crate::stop::Stop;
use crate::{Error, Result};
use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// A thread that sees the file onto the disk once a second, so that what is written outlives the machine, and no write waits
/// for it.
pub(super) struct Syncing {
    shared: Arc<Shared>,
    path: PathBuf,
    ending: Stop,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    file: Mutex<Option<File>>,
    failure: Mutex<Option<io::Error>>,
}

impl Syncing {
    pub(super) fn start(writer: &Writer) -> Self {
        let shared = Arc::new(Shared {
            file: Mutex::new(writer.handle()),
            failure: Mutex::default(),
        });
        let (synced, ending) = (Arc::clone(&shared), Stop::new());
        let end = ending.clone();
        let thread = thread::spawn(move || {
            while !end.wait(SYNC_EVERY) {
                let file = lock(&synced.file).as_ref().and_then(|file| file.try_clone().ok());
                synced.note(file.map_or(Ok(()), |file| file.sync_data()));
            }
        });
        Self {
            shared,
            path: writer.path().to_owned(),
            ending,
            thread: Some(thread),
        }
    }

    /// Goes on with the file that is written now.
    pub(super) fn follow(&mut self, writer: &Writer) {
        if self.path != writer.path() {
            writer.path().clone_into(&mut self.path);
            *lock(&self.shared.file) = writer.handle();
        }
    }

    /// What the disk did not take that the system had taken, once: the system tells only whoever asks first.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub(super) fn failure(&self) -> Result<()> {
        let failure = lock(&self.shared.failure).take();
        failure.map_or(Ok(()), |error| {
            Err(Error::write(self.path.display().to_string(), &error))
        })
    }

    pub(super) fn end(&mut self) {
        self.ending.stop();
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    }
}

impl Shared {
    fn note(&self, synced: io::Result<()>) {
        // A pipe is not on this disk.
        if let Err(error) = synced
            && error.kind() != io::ErrorKind::InvalidInput
        {
            *lock(&self.failure) = Some(error);
        }
    }
}

impl Drop for Syncing {
    fn drop(&mut self) {
        self.ending.stop();
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

const SYNC_EVERY: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::WriterOptions;

    #[test]
    fn a_disk_that_fails_is_told_once_and_a_pipe_is_no_disk() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("take.mcap");
        let writer = Writer::create(&path, &[], WriterOptions::default()).unwrap();
        let mut syncing = Syncing::start(&writer);
        syncing.end();
        syncing.shared.note(Err(io::ErrorKind::InvalidInput.into()));
        assert_eq!(syncing.failure(), Ok(()));
        syncing.shared.note(Err(io::ErrorKind::StorageFull.into()));
        assert!(matches!(
            syncing.failure(),
            Err(Error::Write {
                kind: io::ErrorKind::StorageFull,
                ..
            })
        ));
        assert_eq!(syncing.failure(), Ok(()));
    }
}
