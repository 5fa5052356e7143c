//! The time of day of samples against their numbers.

use super::super::Largest;
use crate::{Frame, Timecode};

/// How evenly the times of day of samples follow their numbers.
///
/// It keeps 16 bytes of every sample that has a time of day. Samples may go through midnight.
#[derive(Clone, Debug, PartialEq)]
pub struct ClockCheck {
    rate: f64,
    last: Option<Timecode>,
    /// Milliseconds of the clock since the first sample.
    elapsed: i64,
    points: Vec<Point>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    sample: u32,
    /// How much later the clock is than `(sample - first) / rate`, ms.
    late: f64,
}

/// What a clock did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockReport {
    /// Samples with a time of day.
    pub samples: u64,
    /// By how much the clock is faster than the sample numbers at the stated rate, in millionths: the slope of the straight line that
    /// fits best. `None` of fewer than three samples.
    pub drift_ppm: Option<f64>,
    /// The standard error of that drift: whole milliseconds over a short take tell little.
    pub drift_error_ppm: Option<f64>,
    /// How far half of the samples are off that line at most, ms. Half a millisecond is the rounding of the clock.
    pub p50_ms: f64,
    /// The same of 99 in 100 samples.
    pub p99_ms: f64,
    /// The sample that is farthest off, ms.
    pub largest_ms: Largest,
}

impl ClockCheck {
    /// Of samples whose numbers count `rate` a second, which must be above zero.
    pub fn new(rate: f64) -> Self {
        Self {
            rate,
            last: None,
            elapsed: 0,
            points: Vec::new(),
        }
    }

    /// Takes a sample into account, if it has a time of day.
    pub fn add(&mut self, frame: &Frame) {
        let Some(now) = frame.timecode else { return };
        if let Some(last) = self.last.replace(now) {
            let step = i64::from(now.milliseconds()) - i64::from(last.milliseconds());
            self.elapsed += (step + DAY / 2).rem_euclid(DAY) - DAY / 2;
        }
        let first = self.points.first().map_or(frame.sample, |point| point.sample);
        let expected = self.milliseconds(frame.sample, first);
        self.points.push(Point {
            sample: frame.sample,
            late: self.elapsed as f64 - expected,
        });
    }

    /// What the clock did so far; `None` when no sample has a time of day or the rate tells nothing.
    pub fn report(&self) -> Option<ClockReport> {
        let first = self.points.first()?.sample;
        if !(self.rate.is_finite() && self.rate > 0.0) {
            return None;
        }
        let line = Line::through(
            self.points
                .iter()
                .map(|point| (self.milliseconds(point.sample, first), point.late)),
        );
        let off = |point: &Point| (point.late - line.at(self.milliseconds(point.sample, first))).abs();
        let mut largest = None;
        for point in &self.points {
            Largest::update(&mut largest, off(point), point.sample);
        }
        let mut off: Vec<f64> = self.points.iter().map(off).collect();
        off.sort_unstable_by(f64::total_cmp);
        let enough = line.error.is_some();
        Some(ClockReport {
            samples: off.len() as u64,
            drift_ppm: enough.then_some(line.slope * 1e6),
            drift_error_ppm: line.error.map(|error| error * 1e6),
            p50_ms: percentile(&off, 50),
            p99_ms: percentile(&off, 99),
            largest_ms: largest?,
        })
    }

    fn milliseconds(&self, sample: u32, first: u32) -> f64 {
        (f64::from(sample) - f64::from(first)) / self.rate * 1000.0
    }
}

/// The straight line nearest to points.
struct Line {
    middle: (f64, f64),
    slope: f64,
    /// The standard error of the slope; `None` when the points tell none.
    error: Option<f64>,
}

impl Line {
    fn through(points: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let count = points.clone().count() as f64;
        let (x, y) = points
            .clone()
            .fold((0.0, 0.0), |(x, y), point| (x + point.0, y + point.1));
        let middle = (x / count, y / count);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (x, y) in points {
            let (x, y) = (x - middle.0, y - middle.1);
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        }
        if count < 3.0 || xx <= 0.0 {
            return Self {
                middle,
                slope: 0.0,
                error: None,
            };
        }
        let slope = xy / xx;
        let scatter = ((yy - slope * xy) / (count - 2.0)).max(ROUNDING);
        Self {
            middle,
            slope,
            error: Some((scatter / xx).sqrt()),
        }
    }

    fn at(&self, x: f64) -> f64 {
        self.middle.1 + self.slope * (x - self.middle.0)
    }
}

/// Of sorted values: the least that so many per cent do not exceed.
fn percentile(sorted: &[f64], percent: usize) -> f64 {
    let place = (sorted.len() * percent).div_ceil(100).saturating_sub(1);
    sorted.get(place).copied().unwrap_or(0.0)
}

const DAY: i64 = 86_400_000;
/// The variance of what rounding to whole milliseconds adds, ms².
const ROUNDING: f64 = 1.0 / 12.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Skeleton, Subject};
    use std::sync::Arc;

    fn report(rate: f64, times: impl IntoIterator<Item = (u32, f64)>) -> Option<ClockReport> {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        let mut clock = ClockCheck::new(rate);
        clock.add(&frame);
        for (sample, milliseconds) in times {
            frame.sample = sample;
            frame.timecode = Some(Timecode::from_milliseconds(milliseconds.round() as u64));
            clock.add(&frame);
        }
        clock.report()
    }

    #[test]
    fn a_clock_that_runs_fast_drifts_and_does_not_jitter() {
        // 200 millionths fast over ten minutes, through midnight.
        let times = (0..36_000).map(|sample| (sample, 86_300_000.0 + f64::from(sample) * 1000.0 / 60.0 * 1.0002));
        let report = report(60.0, times).unwrap();
        let (drift, error) = (report.drift_ppm.unwrap(), report.drift_error_ppm.unwrap());
        assert!((drift - 200.0).abs() < 3.0 * error && error < 0.1, "{drift} {error}");
        assert!(report.largest_ms.value < 0.6 && report.p50_ms > 0.2, "{report:?}");
        assert_eq!(report.samples, 36_000);
    }

    #[test]
    fn a_sample_that_came_late_is_named() {
        let times = (0..1000).map(|sample| {
            (
                sample,
                1000.0 + f64::from(sample) * 10.0 + if sample == 700 { 40.0 } else { 0.0 },
            )
        });
        let report = report(100.0, times).unwrap();
        assert_eq!(report.largest_ms.sample, 700);
        assert!((report.largest_ms.value - 40.0).abs() < 0.2);
        assert!(report.p99_ms < 0.2);
    }

    #[test]
    fn two_samples_tell_no_drift_and_none_tell_nothing() {
        assert_eq!(report(100.0, [(0, 10.0), (1, 20.0)]).unwrap().drift_ppm, None);
        assert_eq!(report(100.0, []), None);
        assert_eq!(report(0.0, [(0, 10.0), (1, 20.0)]), None);
        assert_eq!(report(100.0, [(7, 10.0); 5]).unwrap().drift_ppm, None);
    }

    #[test]
    fn percentiles_are_values_of_the_list() {
        let list: Vec<f64> = (1..=200).map(f64::from).collect();
        let found = [percentile(&list, 50), percentile(&list, 99), percentile(&[4.0], 99)];
        assert_eq!(found.map(|value| value as i64), [100, 198, 4]);
    }
}
