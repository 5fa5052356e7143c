//! What the server has done and refused.

use std::sync::atomic::{AtomicU64, Ordering};

/// A count that any thread adds to.
#[derive(Debug, Default)]
pub(crate) struct Count(AtomicU64);

impl Count {
    pub(crate) fn add(&self, more: u64) {
        self.0.fetch_add(more, Ordering::Relaxed);
    }

    pub(crate) fn subtract(&self, less: u64) {
        self.0.fetch_sub(less, Ordering::Relaxed);
    }

    pub(crate) fn value(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// What the server has done and refused since it was started.
#[derive(Debug, Default)]
pub(crate) struct Counts {
    /// TCP connections that are open now.
    pub(crate) connections: Count,
    /// Pages that are connected now.
    pub(crate) pages: Count,
    /// Ticks and their bytes that were sent to pages.
    pub(crate) ticks: Count,
    pub(crate) bytes: Count,
    /// Ticks that were skipped because a page was not ready for them.
    pub(crate) skipped: Count,
    /// Connections closed because nothing could be written to them for ten seconds.
    pub(crate) stalled: Count,
    pub(crate) refused: Refused,
}

/// What was refused, by why.
#[derive(Debug, Default)]
pub(crate) struct Refused {
    /// Connections beyond those that are served.
    pub(crate) connections: Count,
    /// Requests that name another host.
    pub(crate) host: Count,
    /// Requests of another origin's page.
    pub(crate) origin: Count,
    /// Requests without the token.
    pub(crate) token: Count,
    /// Messages of pages that are too long, no JSON, or ask for what there is not.
    pub(crate) message: Count,
    /// Requests for what there is not, or with a body that is not what was expected.
    pub(crate) request: Count,
}
