//! How far reading or writing has come.

use crate::stop::Stop;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// How far reading or writing has come, and the wish to stop it. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    stop: Stop,
    counts: Arc<Counts>,
}

#[derive(Debug, Default)]
struct Counts {
    done: AtomicU64,
    total: AtomicU64,
}

impl Progress {
    /// Of work that ends early when `stop` is set.
    pub fn new(stop: Stop) -> Self {
        let counts = Arc::default();
        Self { stop, counts }
    }

    /// How much is done: bytes while a file is read, frames while one is written.
    pub fn done(&self) -> u64 {
        self.counts.done.load(Ordering::Relaxed)
    }

    /// How much there is to do, 0 where it is not known.
    pub fn total(&self) -> u64 {
        self.counts.total.load(Ordering::Relaxed)
    }

    /// Whether the work is to be stopped.
    pub fn is_stopped(&self) -> bool {
        self.stop.is_stopped()
    }

    /// Begins to count towards a new total.
    pub(crate) fn begin(&self, total: u64) {
        self.counts.done.store(0, Ordering::Relaxed);
        self.counts.total.store(total, Ordering::Relaxed);
    }

    /// So much more is done.
    ///
    /// # Errors
    /// When the work is to be stopped.
    pub(crate) fn advance(&self, count: u64) -> io::Result<()> {
        self.counts.done.fetch_add(count, Ordering::Relaxed);
        if self.is_stopped() {
            return Err(io::Error::other("stopped"));
        }
        Ok(())
    }
}
