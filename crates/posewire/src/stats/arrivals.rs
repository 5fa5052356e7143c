//! When messages arrived: their rate and the time between them.

use std::time::Duration;

use posewire_motion::Stamp;

use super::{Counters, DatagramKind, StreamStatistics};
use crate::histogram::DurationHistogram;

/// When the messages of one stream arrived.
#[derive(Debug, Default)]
pub(super) struct Arrivals {
    interval: DurationHistogram,
    count: u64,
    first: Option<Stamp>,
    last: Option<Stamp>,
    /// The time between the last two.
    step: Duration,
    /// The last arrival, and how many there were, at the report before; after a pause the first.
    before: Option<(Stamp, u64)>,
}

impl Arrivals {
    /// Takes note of one more.
    pub(super) fn arrived(&mut self, at: Stamp) {
        let step = self.last.map(|last| at.since(last));
        self.first.get_or_insert(at);
        self.last = Some(at);
        self.count += 1;
        if let Some(step) = step {
            self.interval.record(step);
            if step > PAUSE.max(self.step * 10) {
                self.before = Some((at, self.count));
            }
            self.step = step;
        }
    }

    /// The numbers that go with what was counted. Rates are those since the last report, or overall at the end.
    pub(super) fn report(&mut self, kind: DatagramKind, counters: Counters, ended: bool) -> StreamStatistics {
        StreamStatistics {
            kind,
            rate_hz: if ended { self.overall_rate() } else { self.recent_rate() },
            counters,
            interval: self.interval.summary(),
        }
    }

    /// Messages a second between the last arrival of the report before and the last one of this; a pause between them
    /// is none of the stream's.
    fn recent_rate(&mut self) -> f64 {
        let (Some(first), Some(last)) = (self.first, self.last) else {
            return 0.0;
        };
        let (since, count) = self.before.unwrap_or((first, 1));
        self.before = Some((last, self.count));
        per_second(self.count - count, last.since(since))
    }

    fn overall_rate(&self) -> f64 {
        let (Some(first), Some(last)) = (self.first, self.last) else {
            return 0.0;
        };
        per_second(self.count.saturating_sub(1), last.since(first))
    }
}

fn per_second(count: u64, time: Duration) -> f64 {
    if time.is_zero() {
        0.0
    } else {
        count as f64 / time.as_secs_f64()
    }
}

/// How long nothing comes at least while a stream pauses.
const PAUSE: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_measured_from_arrival_to_arrival() {
        let mut arrivals = Arrivals::default();
        let period = Duration::from_micros(16_667);
        let at = |count: u32| Stamp(1_000_000_000).after(period * count);
        assert!(arrivals.recent_rate().abs() < f64::EPSILON);
        (0..61).for_each(|count| arrivals.arrived(at(count)));
        assert!((arrivals.recent_rate() - 60.0).abs() < 0.01);
        (61..100).for_each(|count| arrivals.arrived(at(count)));
        assert!((arrivals.recent_rate() - 60.0).abs() < 0.01);
        assert!(arrivals.recent_rate().abs() < f64::EPSILON, "nothing has arrived since");
        assert!((arrivals.overall_rate() - 60.0).abs() < 0.01);
        assert_eq!(arrivals.interval.summary().count, 99);
    }

    #[test]
    fn a_pause_is_none_of_the_rate_of_what_comes_after_it() {
        let mut arrivals = Arrivals::default();
        let period = Duration::from_millis(4);
        let at = |count: u32| Stamp(1_000_000_000).after(period * count);
        (0..250).for_each(|count| arrivals.arrived(at(count)));
        arrivals.recent_rate();
        (2000..2100).for_each(|count| arrivals.arrived(at(count)));
        assert!((arrivals.recent_rate() - 250.0).abs() < 0.01);
        let mut slow = Arrivals::default();
        (0..3).for_each(|count| slow.arrived(at(count * 1250)));
        assert!((slow.recent_rate() - 0.2).abs() < 0.01, "a slow stream does not pause");
    }
}
