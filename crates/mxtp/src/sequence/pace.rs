//! How fast a counter goes up.

use posewire_motion::Stamp;

/// How fast the counter goes up in receive time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    pub(super) newest: Stamp,
    nanoseconds_per_count: f64,
    steps: u32,
}

impl Pace {
    /// Follows the mean slowly, so that bursts even out; a pause of the sender counts little.
    pub(super) fn advance(&mut self, step: u32, now: Stamp) {
        let measured = now.since(self.newest).as_nanos() as f64 / f64::from(step);
        let limit = match self.steps {
            0 => f64::INFINITY,
            _ => (8.0 * self.nanoseconds_per_count).max(1e6),
        };
        self.steps = (self.steps + 1).min(64);
        self.nanoseconds_per_count += (measured.min(limit) - self.nanoseconds_per_count) / f64::from(self.steps);
        self.newest = now;
    }

    /// How far the counter should have gone since the newest sample; 0 when the receive times say nothing.
    pub(super) fn counts_until(&self, now: Stamp) -> f64 {
        if self.nanoseconds_per_count > 0.0 {
            now.since(self.newest).as_nanos() as f64 / self.nanoseconds_per_count
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// A pace that has seen steps, each of so many counts in so many microseconds.
    fn paced(steps: impl IntoIterator<Item = (u32, u64)>) -> Pace {
        let mut pace = Pace::default();
        for (step, time) in steps {
            pace.advance(step, pace.newest.after(Duration::from_micros(time)));
        }
        pace
    }

    fn microseconds_per_count(pace: &Pace) -> f64 {
        1e6 / pace.counts_until(pace.newest.after(Duration::from_secs(1)))
    }

    fn assert_pace(steps: impl IntoIterator<Item = (u32, u64)>, expected: f64) {
        let found = microseconds_per_count(&paced(steps));
        assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
    }

    #[test]
    fn the_first_steps_are_averaged() {
        assert_pace([(1, 16_000)], 16_000.0);
        assert_pace([(4, 16_000)], 4_000.0);
        assert_pace([(1, 4_000), (1, 8_000), (1, 6_000)], 6_000.0);
    }

    #[test]
    fn a_pause_counts_as_eight_times_the_pace_and_at_least_a_millisecond() {
        assert_pace([(1, 16_000), (1, 1_000_000)], f64::midpoint(16_000.0, 128_000.0));
        assert_pace([(1, 10), (1, 1_000_000)], f64::midpoint(10.0, 1_000.0));
    }

    #[test]
    fn later_steps_change_it_by_a_64th() {
        let even = std::iter::repeat_n((1, 4_000), 200);
        assert_pace(even.chain([(1, 8_000)]), 4_000.0 + 4_000.0 / 64.0);
    }

    #[test]
    fn without_a_pace_nothing_can_be_expected() {
        let later = Stamp::default().after(Duration::from_secs(1));
        let nothing = |pace: Pace| pace.counts_until(later).abs() < f64::EPSILON;
        assert!(nothing(Pace::default()));
        assert!(nothing(paced([(1, 0), (1, 0)])));
    }
}
