//! A wish to stop, seen by every thread that holds it.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A flag that ends waits early. Clones share it.
///
/// ```
/// use posewire::stop::Stop;
/// use std::time::Duration;
///
/// let stop = Stop::new();
/// let other = stop.clone();
/// let waiting = std::thread::spawn(move || other.wait(Duration::from_hours(1)));
/// stop.stop();
/// assert!(waiting.join().unwrap());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Stop {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    stopped: Mutex<bool>,
    changed: Condvar,
}

impl Stop {
    /// A flag that is not set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the flag, for good, and ends every wait on it.
    pub fn stop(&self) {
        *self.lock() = true;
        self.shared.changed.notify_all();
    }

    /// Whether the flag is set.
    pub fn is_stopped(&self) -> bool {
        *self.lock()
    }

    /// Waits for `duration`, less if the flag is set before. Gives whether it is set.
    pub fn wait(&self, duration: Duration) -> bool {
        let waited = self
            .shared
            .changed
            .wait_timeout_while(self.lock(), duration, |stopped| !*stopped);
        let (stopped, _) = waited.unwrap_or_else(PoisonError::into_inner);
        *stopped
    }

    /// Waits until `deadline`, less if the flag is set before. Gives whether it is set.
    pub fn wait_until(&self, deadline: Instant) -> bool {
        self.wait(deadline.saturating_duration_since(Instant::now()))
    }

    fn lock(&self) -> MutexGuard<'_, bool> {
        let stopped = self.shared.stopped.lock();
        stopped.unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wait_ends_at_its_time_or_at_the_stop() {
        let stop = Stop::new();
        assert!(!stop.wait(Duration::ZERO));
        assert!(!stop.wait_until(Instant::now()));
        stop.clone().stop();
        assert!(stop.is_stopped());
        assert!(stop.wait(Duration::from_hours(1)));
    }
}
