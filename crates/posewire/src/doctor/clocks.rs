//! The sender's clock, its time of day and ours.

use super::Check;
use super::finding::{Finding, plural};
use crate::stats::Clocks;
use posewire_motion::{Frame, Stamp, Timecode};
use std::time::Duration;

/// The clock of one subject's samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SampleClock {
    last: Option<(u32, Duration)>,
    jumps: u64,
    /// The largest, s; below 0 when the clock went back.
    largest: f64,
    /// By how much the sender's time of day is ahead of ours, ms.
    ahead: Option<i64>,
}

impl SampleClock {
    /// `has_utc` says whether the sender's timecode is the time of day in UTC.
    pub(super) fn sample(&mut self, frame: &Frame, has_utc: bool) {
        let now = (frame.sample, frame.time);
        if let Some(before) = self.last.replace(now) {
            self.step(before, now);
        }
        if let (true, Some(timecode), Some(received)) = (has_utc, frame.timecode, frame.received) {
            self.ahead = Some(ahead(timecode, received));
        }
    }

    /// Samples that go on take their time, and no more. Those that do not are counted elsewhere.
    fn step(&mut self, (sample_before, before): (u32, Duration), (sample, now): (u32, Duration)) {
        let samples = sample
            .checked_sub(sample_before)
            .filter(|samples| (1..=MOST_MISSING).contains(samples));
        let Some(samples) = samples else {
            return;
        };
        let step = now.as_secs_f64() - before.as_secs_f64();
        if step < 0.0 || step > LEAP + f64::from(samples) * SLOWEST {
            self.jumps += 1;
            if step.abs() > self.largest.abs() {
                self.largest = step;
            }
        }
    }

    pub(super) fn of_jumps(&self) -> Option<Finding> {
        let way = if self.largest < 0.0 { "back" } else { "forward" };
        let what = format!(
            "The clock of the samples leapt {}, at most {:.3} s {way}, while their numbers went on.",
            plural(self.jumps, "time"),
            self.largest.abs()
        );
        (self.jumps > 0).then(|| Finding::new(Check::ClockJump, what))
    }

    /// By what the statistics say of the two clocks: one sample that was long on its way is no difference.
    pub(super) fn of_difference(&self, clocks: Clocks) -> Option<Finding> {
        let ahead = self.ahead.filter(|_| clocks == Clocks::Differ)?;
        let way = if ahead < 0 { "behind" } else { "ahead of" };
        let what = format!(
            "The sender's time of day is {:.3} s {way} that of this machine, in UTC.",
            ahead.unsigned_abs() as f64 / 1000.0
        );
        Some(Finding::new(Check::ClocksDiffer, what))
    }
}

/// By how many milliseconds a time of day is ahead of an instant's, the shorter way round the day.
fn ahead(timecode: Timecode, received: Stamp) -> i64 {
    let of = |timecode: Timecode| i64::from(timecode.milliseconds());
    let difference = of(timecode) - of(Timecode::of_day(received));
    (difference + DAY / 2).rem_euclid(DAY) - DAY / 2
}

/// Our own clock, by the stamps of what arrived.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct OwnClock {
    last: Option<Stamp>,
    back: Duration,
}

impl OwnClock {
    pub(super) fn stamp(&mut self, at: Stamp) {
        if let Some(last) = self.last.replace(at) {
            self.back = self.back.max(last.since(at));
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let what = format!(
            "The clock of this machine was set back by {:.3} s.",
            self.back.as_secs_f64()
        );
        let finding = || Finding::new(Check::ClockJump, what).at("this machine");
        (self.back > OUT_OF_ORDER).then(finding)
    }
}

/// How much longer than samples can take is a leap, s.
const LEAP: f64 = 0.25;
/// The longest time from one sample to the next, s.
const SLOWEST: f64 = 0.1;
/// What goes on further than that is a jump of the numbers.
const MOST_MISSING: u32 = 256;
const DAY: i64 = 86_400_000;
/// Two sockets, or peers, are read one after the other.
const OUT_OF_ORDER: Duration = Duration::from_millis(500);

#[cfg(test)]
mod tests {
    use super::super::test::upright;
    use super::*;

    fn clock(times: &[(u32, u64)]) -> Option<String> {
        let mut clock = SampleClock::default();
        for &(sample, milliseconds) in times {
            let mut frame = upright();
            (frame.sample, frame.time) = (sample, Duration::from_millis(milliseconds));
            clock.sample(&frame, true);
        }
        clock.of_jumps().map(|finding| finding.what)
    }

    #[test]
    fn a_leap_of_the_clock_is_told_from_samples_that_are_missing() {
        assert_eq!(clock(&[(0, 0), (1, 4), (2, 8), (50, 208)]), None);
        let forward = clock(&[(0, 0), (1, 4), (2, 5000), (3, 5004)]).unwrap();
        assert!(forward.contains("1 time, at most 4.996 s forward"), "{forward}");
        let back = clock(&[(0, 5000), (1, 4), (2, 8)]).unwrap();
        assert!(back.contains("4.996 s back"), "{back}");
        assert_eq!(clock(&[(100, 5000), (0, 0), (1, 4)]), None, "a new numbering");
    }

    #[test]
    fn times_of_day_are_compared_round_midnight() {
        let mut frame = upright();
        frame.received = Some(Stamp::from_parts(86_400 * 20_000 + 1, 0));
        frame.timecode = Some(Timecode::from_milliseconds(86_399_000));
        let mut clock = SampleClock::default();
        clock.sample(&frame, true);
        let what = clock.of_difference(Clocks::Differ).unwrap().what;
        assert!(what.contains("2.000 s behind"), "{what}");
        assert_eq!(clock.of_difference(Clocks::Agree), None, "it was long on its way");
    }

    #[test]
    fn a_timecode_that_is_no_time_of_day_is_not_compared() {
        let mut frame = upright();
        (frame.received, frame.timecode) = (Some(Stamp(0)), Some(Timecode::from_milliseconds(5_000_000)));
        let mut clock = SampleClock::default();
        clock.sample(&frame, false);
        assert_eq!(clock.of_difference(Clocks::Differ), None);
    }

    #[test]
    fn our_own_clock_may_be_set_back() {
        let mut clock = OwnClock::default();
        for seconds in [10, 11, 10] {
            clock.stamp(Stamp::from_parts(seconds, 0));
        }
        assert_eq!(clock.finding().unwrap().place.as_deref(), Some("this machine"));
    }
}
