//! When to do something again.

use std::time::Duration;

use posewire_motion::Stamp;

/// A timer that waits longer each time, up to a limit; with one duration for both it is periodic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Retry {
    next: Option<Stamp>,
    wait: Duration,
    first: Duration,
    longest: Duration,
}

impl Retry {
    /// A timer at rest that waits `first` after its first time, and never more than `longest`.
    pub(crate) fn new(first: Duration, longest: Duration) -> Self {
        // A wait of nothing would be due for ever within one instant.
        let first = first.max(SHORTEST);
        Self {
            next: None,
            wait: first,
            first,
            longest: longest.max(first),
        }
    }

    /// A timer at rest that is due every `period` once it runs.
    pub(crate) fn every(period: Duration) -> Self {
        Self::new(period, period)
    }

    /// Runs from the start: due first at `at`.
    pub(crate) fn start(&mut self, at: Stamp) {
        self.next = Some(at);
        self.wait = self.first;
    }

    pub(crate) fn stop(&mut self) {
        self.next = None;
    }

    pub(crate) const fn next(&self) -> Option<Stamp> {
        self.next
    }

    /// Whether the time has come; if so, the next time is set.
    pub(crate) fn is_due(&mut self, now: Stamp) -> bool {
        let due = self.next.is_some_and(|next| next <= now);
        if due {
            self.next = Some(now.after(self.wait));
            self.wait = (self.wait * 2).min(self.longest);
        }
        due
    }
}

const SHORTEST: Duration = Duration::from_millis(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waits_double_up_to_the_longest() {
        let mut retry = Retry::new(Duration::from_secs(1), Duration::from_secs(3));
        retry.start(Stamp(0));
        let mut due = Vec::new();
        for second in 0..12 {
            if retry.is_due(Stamp::from_parts(second, 0)) {
                due.push(second);
            }
        }
        assert_eq!(due, [0, 1, 3, 6, 9]);
        retry.stop();
        assert!(!retry.is_due(Stamp::from_parts(99, 0)));
    }
}
