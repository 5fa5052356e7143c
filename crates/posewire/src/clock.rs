//! The time: UTC for stamps, a steady clock for everything that measures durations.

use std::time::{Duration, Instant, SystemTime};

use posewire_motion::Stamp;

/// Gives UTC stamps, and ties the steady clock of [`Instant`] to them.
///
/// Kernel stamps of received datagrams come from the same UTC clock as [`Clock::now`], so the two
/// compare. UTC steps when someone sets the clock; [`Clock::steady`] never does, and drifts from
/// UTC by as much as the system's clock is corrected after the `Clock` was made.
///
/// ```
/// let clock = posewire::clock::Clock::new();
/// let first = clock.steady();
/// assert!(clock.steady() >= first);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    origin: Instant,
    origin_utc: Stamp,
}

impl Clock {
    /// A clock whose steady stamps start from UTC as it is now.
    pub fn new() -> Self {
        Self {
            origin: Instant::now(),
            origin_utc: now(),
        }
    }

    /// UTC as the system has it, in nanoseconds.
    pub fn now(&self) -> Stamp {
        now()
    }

    /// A stamp that never goes back: UTC at the clock's making plus the time since.
    pub fn steady(&self) -> Stamp {
        self.stamp_of(Instant::now())
    }

    /// The steady stamp of an instant; one before the clock's making gives an earlier stamp.
    pub fn stamp_of(&self, instant: Instant) -> Stamp {
        let before = self.origin.saturating_duration_since(instant).as_nanos();
        let before = i64::try_from(before).unwrap_or(i64::MAX);
        let after = instant.saturating_duration_since(self.origin);
        Stamp(self.origin_utc.after(after).nanoseconds().saturating_sub(before))
    }

    /// The steady stamp of what arrived a moment ago, by its UTC stamp. One that is longer ago than `longest`, which is at
    /// least a second, or in the future, is of a clock that was set meanwhile.
    pub(crate) fn arrival(&self, utc: Stamp, longest: Duration) -> Stamp {
        let waited = self.now().since(utc).min(longest.max(SHORTEST_LIMIT));
        let waited = i64::try_from(waited.as_nanos()).unwrap_or_default();
        Stamp(self.steady().nanoseconds() - waited)
    }
}

impl Default for Clock {
    fn default() -> Self {
        Self::new()
    }
}

/// UTC as the system has it, in nanoseconds.
pub(crate) fn now() -> Stamp {
    Stamp::from(SystemTime::now())
}

/// A kernel stamp, as `SO_TIMESTAMPNS` gives it.
/// The instant that UTC stamps of what has happened stand for. One in the future, or longer ago than an hour, is of a clock that
/// was set meanwhile: it is now, or an hour ago.
pub(crate) fn instant_of(utc: Stamp) -> Instant {
    let at = Instant::now();
    at.checked_sub(now().since(utc).min(LONGEST_AGO)).unwrap_or(at)
}

#[cfg(target_os = "linux")]
pub(crate) fn stamp_of_kernel(time: nix::sys::time::TimeSpec) -> Stamp {
    Stamp::from_parts(time.tv_sec(), time.tv_nsec())
}

const LONGEST_AGO: Duration = Duration::from_hours(1);
const SHORTEST_LIMIT: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrival_is_as_long_ago_on_the_steady_clock_unless_utc_was_set() {
        const SECOND: i64 = 1_000_000_000;
        let mut clock = Clock::new();
        clock.origin_utc = Stamp(0);
        for (ago, limit, longest, shortest) in [
            (SECOND / 2, 0, SECOND, SECOND / 2),
            (100 * SECOND, 0, SECOND, SECOND),
            (100 * SECOND, 200, 101 * SECOND, 100 * SECOND),
            (-100 * SECOND, 200, 0, 0),
        ] {
            let before = clock.steady();
            let arrival = clock.arrival(Stamp(clock.now().nanoseconds() - ago), Duration::from_secs(limit));
            let after = clock.steady();
            assert!((before.0 - longest..=after.0 - shortest).contains(&arrival.0), "{ago}");
        }
    }

    #[test]
    fn steady_stamps_follow_instants_both_ways() {
        let clock = Clock::new();
        let hour = Duration::from_hours(1);
        let origin = clock.stamp_of(clock.origin);
        assert_eq!(clock.stamp_of(clock.origin + hour) - origin, 3_600_000_000_000);
        if let Some(earlier) = clock.origin.checked_sub(Duration::from_millis(5)) {
            assert_eq!(clock.stamp_of(earlier) - origin, -5_000_000);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_kernel_stamp_is_utc_nanoseconds() {
        let time = nix::sys::time::TimeSpec::new(1_700_000_000, 123_456_789);
        assert_eq!(stamp_of_kernel(time), Stamp(1_700_000_000_123_456_789));
    }
}
