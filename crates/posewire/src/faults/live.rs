//! Faults in a stream that leaves in real time.

use super::{FaultCounts, FaultPlan, Faults};
use std::time::Instant;

/// [`Faults`] by the clock: the stream begins when the first datagram is due.
#[derive(Debug)]
pub struct LiveFaults {
    faults: Faults,
    start: Option<Instant>,
}

impl LiveFaults {
    /// The faults of a plan, for a stream that is about to begin.
    pub fn new(plan: FaultPlan) -> Self {
        Self {
            faults: Faults::new(plan),
            start: None,
        }
    }

    /// Takes a datagram that was to leave at `due`. It is better to say when a datagram of a take was due than when it is
    /// sent: then the same take meets the same faults whenever it is played.
    pub fn handle(&mut self, due: Instant, datagram: &[u8]) {
        let start = *self.start.get_or_insert(due);
        self.faults.handle(due.saturating_duration_since(start), datagram);
    }

    /// When [`handle_timeout`](Self::handle_timeout) is next due; `None` while nothing is delayed.
    pub fn timeout(&self) -> Option<Instant> {
        self.start?.checked_add(self.faults.timeout()?)
    }

    /// Lets go what was delayed until `now`.
    pub fn handle_timeout(&mut self, now: Instant) {
        if let Some(start) = self.start {
            self.faults.handle_timeout(now.saturating_duration_since(start));
        }
    }

    /// The next datagram that leaves.
    pub fn poll(&mut self) -> Option<Vec<u8>> {
        self.faults.poll()
    }

    /// The stream ends: lets go everything.
    pub fn finish(&mut self) {
        self.faults.finish();
    }

    /// How often what was done.
    pub fn counts(&self) -> &FaultCounts {
        self.faults.counts()
    }
}
