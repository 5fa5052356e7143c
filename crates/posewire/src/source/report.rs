//! When a live source looks at the clock, reports and ends.

use std::time::{Duration, Instant};

/// When statistics are due: once a second.
#[derive(Debug)]
pub(super) struct Reports {
    next: Instant,
}

impl Reports {
    pub(super) fn new() -> Self {
        Self {
            next: Instant::now() + REPORT_EVERY,
        }
    }

    /// Whether a report is due; if so, the next one is set.
    pub(super) fn is_due(&mut self) -> bool {
        let now = Instant::now();
        let due = now >= self.next;
        if due {
            self.next = report_after(self.next, now);
        }
        due
    }
}

/// When the next report is due after one that was due and is given now. Those missed in a stall are left out.
fn report_after(due: Instant, now: Instant) -> Instant {
    let next = due + REPORT_EVERY;
    if next > now { next } else { now + REPORT_EVERY }
}

/// The longest that a source waits before it looks at the clock.
pub(super) const TICK: Duration = Duration::from_millis(20);
/// How long a source goes on at the stop with what has arrived by then.
pub(super) const DRAIN_LIMIT: Duration = Duration::from_millis(100);
const REPORT_EVERY: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_missed_in_a_stall_are_left_out() {
        let due = Instant::now();
        let late = |milliseconds| due + Duration::from_millis(milliseconds);
        assert_eq!(report_after(due, late(20)), late(1000));
        assert_eq!(report_after(due, late(1000)), late(2000));
        assert_eq!(report_after(due, late(60_500)), late(61_500));
    }
}
