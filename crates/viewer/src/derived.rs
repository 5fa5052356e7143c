//! Numbers that a stream does not send and its poses tell: velocities and accelerations of positions.

use posewire_motion::{Frame, Section};

/// The section whose differences a section is, and how many times they are taken.
pub(crate) fn differences_of(section: Section) -> Option<(Section, Order)> {
    match section {
        Section::Velocity => Some((Section::Position, Order::First)),
        Section::Acceleration => Some((Section::Position, Order::Second)),
        _ => None,
    }
}

/// How many times differences are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// Of a position the velocity.
    First,
    /// Of a position the acceleration.
    Second,
}

/// The central difference of three samples at equal distances, told of the middle one when the third has come.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Difference {
    before: [Option<Sample>; 2],
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    number: u32,
    time_s: f64,
    value: f64,
}

impl Difference {
    /// Takes the value of a frame, of which there are `rate` samples a second, and gives the time of the frame before and
    /// its difference; nothing across a gap.
    pub(crate) fn take(&mut self, frame: &Frame, value: f64, rate: Option<f64>, order: Order) -> Option<(f64, f64)> {
        let last = Sample {
            number: frame.sample,
            time_s: frame.time.as_secs_f64(),
            value,
        };
        let [first, middle] = self.before;
        self.before = [middle, Some(last)];
        let ((first, middle), rate) = first.zip(middle).zip(rate)?;
        let step = last.number.checked_sub(middle.number)?;
        if step == 0 || middle.number.checked_sub(first.number) != Some(step) {
            return None;
        }
        let step_s = f64::from(step) / rate;
        let difference = match order {
            Order::First => (last.value - first.value) / (2.0 * step_s),
            Order::Second => (last.value - 2.0 * middle.value + first.value) / (step_s * step_s),
        };
        Some((middle.time_s, difference))
    }
}

/// Samples a second by the source's clock, whose milliseconds tell it only over a while.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SampleRate {
    first: Option<(u32, f64)>,
    last: (u32, f64),
}

impl SampleRate {
    /// Takes the number and the time of a frame.
    pub(crate) fn take(&mut self, frame: &Frame) {
        let now = (frame.sample, frame.time.as_secs_f64());
        if self.first.is_none() || now.0 < self.last.0 || now.1 < self.last.1 {
            self.first = Some(now);
        }
        self.last = now;
    }

    /// The rate, once it is known; a whole number where it is near one.
    pub(crate) fn rate(&self) -> Option<f64> {
        let (sample, time) = self.first?;
        let elapsed = self.last.1 - time;
        let rate = f64::from(self.last.0 - sample) / elapsed;
        let whole = rate.round();
        let near = (rate - whole).abs() <= rate * CLOCK_STEP / elapsed;
        (elapsed >= ENOUGH && rate > 0.0).then_some(if near { whole } else { rate })
    }
}

/// How far off the time between two samples can be, s.
const CLOCK_STEP: f64 = 0.002;
/// How long it takes to know the rate well, s.
const ENOUGH: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use std::sync::Arc;
    use std::time::Duration;

    /// A frame of a stream at 240 Hz whose clock has milliseconds.
    fn frame(sample: u32) -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        frame.sample = sample;
        frame.time = Duration::from_millis(u64::from(sample) * 1000 / 240);
        frame
    }

    #[test]
    fn differences_do_not_suffer_from_a_clock_of_milliseconds() {
        let (mut first, mut second) = (Difference::default(), Difference::default());
        for sample in 0..100 {
            let at = f64::from(sample) / 240.0;
            let velocity = first.take(&frame(sample), at * at, Some(240.0), Order::First);
            let acceleration = second.take(&frame(sample), at * at, Some(240.0), Order::Second);
            assert_eq!(velocity.is_some(), sample >= 2);
            if let Some(((time, velocity), (_, acceleration))) = velocity.zip(acceleration) {
                assert!((time - (at - 1.0 / 240.0)).abs() < 0.0011);
                assert!((velocity - 2.0 * (at - 1.0 / 240.0)).abs() < 1e-9);
                assert!((acceleration - 2.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn nothing_is_told_across_a_gap() {
        let mut difference = Difference::default();
        let samples = [0, 4, 8, 16, 20, 24, 3, 7, 7, 11, 15];
        let told = samples.map(|sample| {
            difference
                .take(&frame(sample), 0.0, Some(240.0), Order::First)
                .is_some()
        });
        let expected = [false, false, true, false, false, true, false, false, false, false, true];
        assert_eq!(told, expected);
        assert_eq!(difference.take(&frame(19), 0.0, None, Order::First), None);
    }

    #[test]
    fn a_rate_is_known_after_a_while_and_anew_when_the_counter_starts_over() {
        let mut rate = SampleRate::default();
        (0..60).for_each(|sample| rate.take(&frame(sample * 4)));
        assert_eq!(rate.rate(), Some(240.0));
        rate.take(&frame(0));
        assert_eq!(rate.rate(), None);
    }
}
