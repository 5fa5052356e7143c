//! Durations counted in bounded memory, for percentiles.

use std::fmt;
use std::time::Duration;

use hdrhistogram::Histogram;

/// Counts durations from 1 µs to 60 s with two significant digits, in about 30 KiB whatever the
/// number of them.
///
/// Percentiles are right to 1 %; the maximum is exact, even above 60 s.
///
/// ```
/// use posewire::histogram::DurationHistogram;
/// use std::time::Duration;
///
/// let mut intervals = DurationHistogram::new();
/// for millis in 1..=100 {
///     intervals.record(Duration::from_millis(millis));
/// }
/// let summary = intervals.summary();
/// assert_eq!(summary.max, Duration::from_millis(100));
/// assert!(summary.p50.as_millis().abs_diff(50) <= 1);
/// ```
#[derive(Clone, Debug)]
pub struct DurationHistogram {
    // Absent only if the library refused the constant bounds below, which it does not.
    nanoseconds: Option<Histogram<u64>>,
    max: Duration,
}

/// What a [`DurationHistogram`] holds, in four numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// How many durations were recorded.
    pub count: u64,
    /// Half of them were this long or shorter.
    pub p50: Duration,
    /// 99 of 100 of them were this long or shorter.
    pub p99: Duration,
    /// The longest.
    pub max: Duration,
}

impl DurationHistogram {
    /// An empty histogram.
    pub fn new() -> Self {
        Self {
            nanoseconds: Histogram::new_with_bounds(SHORTEST, LONGEST, 2).ok(),
            max: Duration::ZERO,
        }
    }

    /// Counts one duration.
    pub fn record(&mut self, duration: Duration) {
        self.max = self.max.max(duration);
        if let Some(histogram) = &mut self.nanoseconds {
            histogram.saturating_record(u64::try_from(duration.as_nanos()).unwrap_or(LONGEST));
        }
    }

    /// The numbers over everything recorded since the start or the last [`clear`](Self::clear).
    pub fn summary(&self) -> Summary {
        let Some(histogram) = &self.nanoseconds else {
            return Summary::default();
        };
        let quantile = |q| Duration::from_nanos(histogram.value_at_quantile(q)).min(self.max);
        Summary {
            count: histogram.len(),
            p50: quantile(0.50),
            p99: quantile(0.99),
            max: self.max,
        }
    }

    /// Forgets everything recorded.
    pub fn clear(&mut self) {
        self.max = Duration::ZERO;
        if let Some(histogram) = &mut self.nanoseconds {
            histogram.reset();
        }
    }
}

impl Default for DurationHistogram {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Display for Summary {
    /// `p50 0.17 ms, p99 0.30 ms, max 1.20 ms`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let millis = |duration: Duration| duration.as_secs_f64() * 1e3;
        write!(
            f,
            "p50 {:.2} ms, p99 {:.2} ms, max {:.2} ms",
            millis(self.p50),
            millis(self.p99),
            millis(self.max)
        )
    }
}

const SHORTEST: u64 = 1_000;
const LONGEST: u64 = 60_000_000_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bounds_are_accepted_and_small() {
        let histogram = DurationHistogram::new().nanoseconds.unwrap();
        assert!(histogram.distinct_values() * size_of::<u64>() < 40_000);
    }

    #[test]
    fn an_outlier_beyond_the_range_is_the_maximum() {
        let mut histogram = DurationHistogram::new();
        histogram.record(Duration::from_hours(1));
        histogram.record(Duration::ZERO);
        let summary = histogram.summary();
        assert_eq!(summary.count, 2);
        assert_eq!(summary.max, Duration::from_hours(1));
        assert!(summary.p50 <= Duration::from_micros(1));
    }

    #[test]
    fn clearing_starts_afresh() {
        let mut histogram = DurationHistogram::new();
        histogram.record(Duration::from_secs(1));
        histogram.clear();
        assert_eq!(histogram.summary(), Summary::default());
    }
}
