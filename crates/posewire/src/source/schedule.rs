//! When the samples of a playback are due.

use super::playback::PlaybackOptions;
use crate::Result;
use crate::pacer::Pacer;
use crate::stop::Stop;
use posewire_motion::{Frame, Timecode};
use std::time::{Duration, Instant};

/// When the samples of a playback are due, over all rounds, pauses and jumps.
#[derive(Debug)]
pub(super) struct Schedule {
    pacer: Pacer,
    timeline: Timeline,
    /// Samples a second to let through; all of them if absent.
    rate_hz: Option<f64>,
    ends: Option<Instant>,
}

impl Schedule {
    /// From now on, for samples that were captured at `captured_hz`.
    pub(super) fn new(captured_hz: f64, options: &PlaybackOptions, stop: &Stop) -> Result<Self> {
        let begun = Instant::now();
        Ok(Self {
            pacer: Pacer::new(begun, options.speed, stop.clone())?,
            timeline: Timeline::new(captured_hz),
            rate_hz: options.rate_hz,
            ends: options.duration.and_then(|duration| begun.checked_add(duration)),
        })
    }

    /// When a sample is due, counted from the start; `None` for one that is left out. Samples come here in their order.
    pub(super) fn offset(&mut self, first: &Frame) -> Option<Duration> {
        let place = self.timeline.place(first);
        let is_kept = self.timeline.keeps(place, self.rate_hz);
        is_kept.then(|| self.timeline.offset(place))
    }

    /// Whether what is due then comes after the end. What is due before it is sent even when that is a little late, but a
    /// machine that cannot keep up does not go on for ever.
    pub(super) fn ends_before(&self, offset: Duration) -> bool {
        let Some(ends) = self.ends else { return false };
        let due = self.due(offset);
        due.is_none_or(|due| due >= ends) || Instant::now().saturating_duration_since(ends) >= GRACE
    }

    /// Whether the end has come, for one that sends nothing.
    pub(super) fn is_past(&self) -> bool {
        self.ends.is_some_and(|ends| Instant::now() >= ends)
    }

    /// When what has this offset is due.
    pub(super) fn due(&self, offset: Duration) -> Option<Instant> {
        self.pacer.deadline(offset)
    }

    /// Waits until then; `false` when asked to stop.
    pub(super) fn wait(&mut self, offset: Duration) -> bool {
        self.pacer.wait(offset)
    }

    /// Waits for so long; `true` when asked to stop.
    pub(super) fn pause(&self, duration: Duration) -> bool {
        self.pacer.pause(duration)
    }

    /// Makes everything due so much later.
    pub(super) fn put_off(&mut self, by: Duration) {
        self.pacer.put_off(by);
    }

    /// Makes the next sample due now, with its own number.
    pub(super) fn begin_anew(&mut self) {
        self.timeline = Timeline::new(self.timeline.rate_hz);
        self.pacer.restart(Instant::now());
    }

    /// Begins a new round; `false` when the last one had no sample.
    pub(super) fn next_round(&mut self) -> bool {
        self.timeline.next_round()
    }

    /// Numbers a frame of a later round on from the last round.
    pub(super) fn carry_on(&self, frame: &mut Frame) {
        self.timeline.carry_on(frame);
    }
}

/// Where a sample stands on the clock, over all rounds of a loop.
#[derive(Debug)]
struct Timeline {
    rate_hz: f64,
    /// The number that the first sample of all had. A round that begins with a jump has not the first of its take.
    origin: Option<u32>,
    /// The first number of this round.
    first_sample: Option<u32>,
    /// What is added to the numbers of this round so that they go on from the last one.
    shift: u64,
    /// Samples of the rounds before this one.
    past_samples: u64,
    /// The furthest place of this round.
    last_place: u64,
}

impl Timeline {
    fn new(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            origin: None,
            first_sample: None,
            shift: 0,
            past_samples: 0,
            last_place: 0,
        }
    }

    /// How many samples after the playback's start this one is; one from before the first of its take is due with it.
    fn place(&mut self, frame: &Frame) -> u64 {
        let first = self.first_sample.unwrap_or_else(|| self.begin_round(frame.sample));
        let ahead = frame.sample.wrapping_sub(first) as i32;
        let place = self.past_samples + u64::from(ahead.max(0).unsigned_abs());
        self.last_place = self.last_place.max(place);
        place
    }

    fn begin_round(&mut self, first: u32) -> u32 {
        let origin = *self.origin.get_or_insert(first);
        self.shift = self.past_samples + u64::from(origin.saturating_sub(first));
        *self.first_sample.insert(first)
    }

    /// Whether a stream of `rate_hz` has this sample: the first one at or after each of its own instants.
    fn keeps(&self, place: u64, rate_hz: Option<f64>) -> bool {
        let Some(rate_hz) = rate_hz else { return true };
        let instant = |place: u64| (place as f64 * rate_hz / self.rate_hz + ROUNDING).floor();
        place == 0 || instant(place) > instant(place - 1)
    }

    fn offset(&self, place: u64) -> Duration {
        Duration::from_secs_f64(place as f64 / self.rate_hz)
    }

    /// Numbers a frame of a later round on from the last round.
    fn carry_on(&self, frame: &mut Frame) {
        frame.sample = frame.sample.wrapping_add(self.shift as u32);
        let past = self.offset(self.shift);
        frame.time += past;
        let later = |code: Timecode| u64::from(code.milliseconds()).saturating_add(past.as_millis() as u64);
        frame.timecode = frame.timecode.map(|code| Timecode::from_milliseconds(later(code)));
    }

    /// Begins a new round; `false` when the last one had no sample.
    fn next_round(&mut self) -> bool {
        let any = self.first_sample.take().is_some() && self.last_place >= self.past_samples;
        self.past_samples = self.last_place + 1;
        any
    }
}

/// How much later than asked a playback may end to send what was due before.
const GRACE: Duration = Duration::from_secs(1);
/// Keeps 30 of 60 from missing a sample because of the last bit of a division.
const ROUNDING: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use std::sync::Arc;

    fn kept(captured_hz: f64, rate_hz: f64, samples: u64) -> Vec<u64> {
        let timeline = Timeline::new(captured_hz);
        (0..samples)
            .filter(|place| timeline.keeps(*place, Some(rate_hz)))
            .collect()
    }

    #[test]
    fn a_quarter_of_the_rate_keeps_every_fourth_sample() {
        assert_eq!(kept(240.0, 60.0, 13), [0, 4, 8, 12]);
        assert_eq!(kept(240.0, 240.0, 3), [0, 1, 2]);
    }

    #[test]
    fn an_uneven_rate_is_kept_on_average() {
        assert_eq!(kept(60.0, 25.0, 13), [0, 3, 5, 8, 10, 12]);
        assert_eq!(kept(60.0, 25.0, 6000).len(), 2500);
    }

    #[test]
    fn a_second_round_goes_on_counting() {
        let mut timeline = Timeline::new(60.0);
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        for (sample, place) in [(7, 0), (8, 1), (10, 3)] {
            frame.sample = sample;
            assert_eq!(timeline.place(&frame), place);
        }
        assert!(timeline.next_round());
        frame.sample = 7;
        assert_eq!(timeline.place(&frame), 4);
        timeline.carry_on(&mut frame);
        assert_eq!(frame.sample, 11);
        assert_eq!(timeline.offset(60), Duration::from_secs(1));
    }

    #[test]
    fn a_round_that_began_with_a_jump_is_followed_by_a_whole_one() {
        let mut timeline = Timeline::new(60.0);
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        let mut numbers = Vec::new();
        for (sample, place) in [(2, 0), (3, 1), (0, 2), (1, 3), (2, 4), (3, 5), (0, 6)] {
            if sample == 0 {
                assert!(timeline.next_round());
            }
            frame.sample = sample;
            assert_eq!(timeline.place(&frame), place);
            timeline.carry_on(&mut frame);
            numbers.push(frame.sample);
        }
        assert_eq!(numbers, [2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn a_take_out_of_order_is_not_waited_for() {
        let mut timeline = Timeline::new(60.0);
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        for (sample, place) in [(5, 0), (6, 1), (2, 0), (3, 0), (7, 2), (6, 1)] {
            frame.sample = sample;
            assert_eq!(timeline.place(&frame), place);
        }
        assert!(timeline.next_round());
        frame.sample = 5;
        assert_eq!(
            timeline.place(&frame),
            3,
            "the next round begins after the furthest sample"
        );
    }
}
