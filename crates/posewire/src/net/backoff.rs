//! How long to wait before the next attempt to connect.

use std::time::Duration;

/// Delays that double from a first one up to a limit.
///
/// ```
/// use posewire::net::Backoff;
///
/// let mut backoff = Backoff::default();
/// let delays: Vec<_> = (0..8).map(|_| backoff.next_delay().as_millis()).collect();
/// assert_eq!(delays, [100, 200, 400, 800, 1600, 3200, 5000, 5000]);
/// backoff.reset();
/// assert_eq!(backoff.next_delay().as_millis(), 100);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Backoff {
    first: Duration,
    limit: Duration,
    next: Duration,
}

impl Backoff {
    /// Delays from `first` up to `limit`.
    pub fn new(first: Duration, limit: Duration) -> Self {
        let first = first.min(limit);
        Self {
            first,
            limit,
            next: first,
        }
    }

    /// The delay before the next attempt; each call doubles the following one.
    pub fn next_delay(&mut self) -> Duration {
        let delay = self.next;
        self.next = delay.saturating_mul(2).min(self.limit);
        delay
    }

    /// Starts from the first delay again, after an attempt that succeeded.
    pub fn reset(&mut self) {
        self.next = self.first;
    }
}

impl Default for Backoff {
    /// 100 ms, doubling up to 5 s.
    fn default() -> Self {
        Self::new(Duration::from_millis(100), Duration::from_secs(5))
    }
}
