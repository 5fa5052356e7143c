//! How long samples were on their way, as far as clocks can tell.

use std::time::Duration;

use posewire_motion::{Frame, Stamp, Timecode};

use crate::histogram::{DurationHistogram, Summary};

/// How long the samples of a subject were on their way, from their making to the arrival of their first datagram.
///
/// Two clocks are in it, and what can be known depends on what they have in common. The variation needs nothing of that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Transit {
    /// By how much each was longer on its way than the quickest of the ten to twenty seconds before it, by the source's own
    /// clock: its steps are of 1 ms. It begins anew after half a second of silence, and when that clock goes back by more than
    /// a second. `None` while that clock has not moved.
    pub variation: Option<Summary>,
    /// From the time code (type 25) to the arrival, where the time codes are of the present time.
    pub latency: Option<Summary>,
    /// What the time codes have in common with the clock here.
    pub clocks: Clocks,
}

/// What the time codes of a subject have in common with the clock here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Clocks {
    /// There are no time codes, so that nothing is known of the latency.
    #[default]
    NoTimecode,
    /// They are of the present time and the sender is on this machine: there is one clock, and the latency is right to 1 ms.
    /// What a relay passes on has the time codes of where it came from.
    Same,
    /// They are within a second of the clock here and never ahead of it. The latency is as wrong as the two clocks are apart,
    /// which cannot be known.
    Agree,
    /// They are of another time, as those of a recording are, or one of the clocks is not set: nothing is known of the latency.
    Differ,
}

impl Clocks {
    /// Its stable name, in kebab case: `no-timecode`, `same`, `agree` or `differ`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoTimecode => "no-timecode",
            Self::Same => "same",
            Self::Agree => "agree",
            Self::Differ => "differ",
        }
    }

    /// What it means for the latency, in one line.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::NoTimecode => "not known without time codes (type 25)",
            Self::Same => "by this machine's clock",
            Self::Agree => "as far off as the two clocks are",
            Self::Differ => "not known: the time codes are of another time",
        }
    }
}

/// Measures how long the samples of one subject are on their way.
#[derive(Debug, Default)]
pub(super) struct Transits {
    /// Whether the sender is on this machine.
    pub(super) is_here: bool,
    newest: Option<Newest>,
    quickest: Quickest,
    variation: DurationHistogram,
    latency: DurationHistogram,
    /// Time codes, and those that are of another time.
    codes: u64,
    off: u64,
}

#[derive(Clone, Copy, Debug)]
struct Newest {
    received: Stamp,
    time: Duration,
}

impl Transits {
    /// Takes note of a sample.
    pub(super) fn sample(&mut self, frame: &Frame) {
        let Some(received) = frame.received else { return };
        let time = frame.time;
        if self.newest.is_some_and(|newest| newest.is_over(received, time)) {
            self.begin_anew();
        }
        self.vary(received, time);
        if let Some(timecode) = frame.timecode {
            self.compare(received, timecode);
        }
    }

    pub(super) fn report(&self) -> Transit {
        let clocks = self.clocks();
        let is_known = matches!(clocks, Clocks::Same | Clocks::Agree);
        Transit {
            variation: Some(self.variation.summary()).filter(|summary| summary.count > 0),
            latency: is_known.then(|| self.latency.summary()),
            clocks,
        }
    }

    fn clocks(&self) -> Clocks {
        match (self.codes, self.is_here) {
            (0, _) => Clocks::NoTimecode,
            (codes, _) if self.off * MOST_OFF > codes => Clocks::Differ,
            (_, true) => Clocks::Same,
            (_, false) => Clocks::Agree,
        }
    }

    fn begin_anew(&mut self) {
        self.newest = None;
        self.quickest = Quickest::default();
        if self.clocks() == Clocks::Differ {
            self.latency.clear();
            (self.codes, self.off) = (0, 0);
        }
    }

    /// A clock that stands still says nothing.
    fn vary(&mut self, received: Stamp, time: Duration) {
        let newest = self.newest.get_or_insert(Newest { received, time });
        if newest.time == time {
            return;
        }
        if time > newest.time {
            *newest = Newest { received, time };
        }
        let elapsed = i64::try_from(time.as_nanos()).unwrap_or(i64::MAX);
        let offset = received.nanoseconds().saturating_sub(elapsed);
        let longer = offset.saturating_sub(self.quickest.of(received, offset));
        self.variation
            .record(Duration::from_nanos(longer.try_into().unwrap_or_default()));
    }

    fn compare(&mut self, received: Stamp, timecode: Timecode) {
        let latency = since_code(received, timecode);
        let longest = if self.is_here { LONGEST_HERE } else { LONGEST_ELSEWHERE };
        self.codes += 1;
        self.off += u64::from(!(-MILLISECOND..=longest).contains(&latency));
        self.latency
            .record(Duration::from_nanos(latency.try_into().unwrap_or_default()));
    }
}

impl Newest {
    /// Whether what comes now has nothing to do with it any more.
    fn is_over(&self, received: Stamp, time: Duration) -> bool {
        received.since(self.received) > SILENCE || time + BACK < self.time
    }
}

/// The smallest offset of late. Two clocks drift apart by milliseconds in a minute, so that an older one is no measure.
#[derive(Debug, Default)]
struct Quickest {
    since: Stamp,
    now: Option<i64>,
    before: Option<i64>,
}

impl Quickest {
    /// The smallest one, with this one taken in.
    fn of(&mut self, received: Stamp, offset: i64) -> i64 {
        if self.now.is_none() || received.since(self.since) >= SPAN {
            self.since = received;
            self.before = self.now.take();
        }
        let now = self.now.map_or(offset, |now| now.min(offset));
        self.now = Some(now);
        self.before.map_or(now, |before| before.min(now))
    }
}

/// Nanoseconds from a time of day to a stamp, at most half a day either way.
fn since_code(received: Stamp, timecode: Timecode) -> i64 {
    let code = i64::from(timecode.milliseconds()) * MILLISECOND;
    let apart = (received.nanoseconds().rem_euclid(DAY) - code).rem_euclid(DAY);
    if apart > DAY / 2 { apart - DAY } else { apart }
}

const MILLISECOND: i64 = 1_000_000;
const SECOND: i64 = 1_000 * MILLISECOND;
const DAY: i64 = 86_400 * SECOND;
/// The longest that a sample is on its way within a machine, and from another one.
const LONGEST_HERE: i64 = 10 * SECOND;
const LONGEST_ELSEWHERE: i64 = SECOND;
/// One time code of so many may be off.
const MOST_OFF: u64 = 100;
const SILENCE: Duration = Duration::from_millis(500);
const BACK: Duration = Duration::from_secs(1);
const SPAN: Duration = Duration::from_secs(10);

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use std::sync::Arc;

    /// Noon of some day.
    const NOON: i64 = 19_000 * DAY + DAY / 2;

    /// A sample at a time of the source's clock, which arrives so many milliseconds later than the quickest could.
    fn sample(time_ms: u64, delay_ms: i64) -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        frame.time = Duration::from_millis(time_ms);
        frame.received = Some(Stamp(NOON + (time_ms as i64 + delay_ms) * MILLISECOND));
        frame
    }

    fn coded(time_ms: u64, delay_ms: i64, code_ms: i64) -> Frame {
        let mut frame = sample(time_ms, delay_ms);
        let code = Timecode::from_milliseconds((NOON / MILLISECOND + time_ms as i64 + code_ms) as u64);
        frame.timecode = Some(code);
        frame
    }

    fn of(frames: impl IntoIterator<Item = Frame>) -> Transits {
        let mut transits = Transits::default();
        frames.into_iter().for_each(|frame| transits.sample(&frame));
        transits
    }

    fn max_variation(frames: impl IntoIterator<Item = Frame>) -> u128 {
        let summary = of(frames).report().variation.expect("the clock has moved");
        summary.max.as_millis()
    }

    #[test]
    fn what_varies_is_the_time_beyond_that_of_the_quickest() {
        let transit = of((0..1000).map(|n| sample(n * 4, if n % 100 == 99 { 37 } else { 30 }))).report();
        let variation = transit.variation.unwrap();
        assert_eq!((variation.count, variation.max), (999, Duration::from_millis(7)));
        assert!(variation.p50 <= Duration::from_micros(1));
        assert_eq!((transit.latency, transit.clocks), (None, Clocks::NoTimecode));
    }

    #[test]
    fn clocks_that_drift_apart_are_no_variation() {
        // 100 ppm for an hour are 360 ms.
        let drifting = (0..36_000).map(|n| sample(n * 100, (n / 100) as i64));
        assert!(max_variation(drifting) <= 2);
    }

    #[test]
    fn a_pause_a_jump_and_a_recording_wound_back_are_no_variation() {
        let at = |from: u64, delay| (0..100).map(move |n| sample(from + n * 4, delay));
        assert_eq!(max_variation(at(0, 0).chain(at(400, 5_000))), 0, "paused");
        assert_eq!(max_variation(at(0, 0).chain(at(9_000, -8_600))), 0, "wound forward");
        assert_eq!(max_variation(at(9_000, 0).chain(at(0, 9_400))), 0, "wound back");
        assert_eq!(max_variation(at(0, 0).chain([sample(300, 110)])), 110, "late");
    }

    #[test]
    fn a_clock_that_stands_still_says_nothing() {
        let frames = (0..100).map(|n| Frame {
            time: Duration::ZERO,
            ..sample(n * 4, 0)
        });
        assert_eq!(of(frames).report().variation, None);
    }

    #[test]
    fn a_latency_is_known_where_the_time_codes_are_of_the_present_time() {
        let codes = |code: i64| (0..200).map(move |n| coded(n * 4, 8, code));
        let known = of(codes(0)).report();
        assert_eq!(known.latency.unwrap().max, Duration::from_millis(8));
        assert_eq!(known.clocks, Clocks::Agree);
        for code in [-3_000, 10, 3_600_000, DAY / MILLISECOND / 2] {
            let transit = of(codes(code)).report();
            assert_eq!((transit.latency, transit.clocks), (None, Clocks::Differ), "{code}");
        }
    }

    #[test]
    fn on_one_machine_a_latency_of_seconds_is_believed() {
        let mut transits = Transits {
            is_here: true,
            ..Transits::default()
        };
        transits.sample(&coded(0, 0, -3_000));
        let transit = transits.report();
        assert_eq!(transit.latency.unwrap().max, Duration::from_secs(3));
        assert_eq!(transit.clocks, Clocks::Same);
    }

    #[test]
    fn one_stall_of_many_samples_is_a_latency_and_no_other_clock() {
        let stalled = (0..200).map(|n| coded(n * 4, if n == 50 { 1_400 } else { 3 }, 0));
        assert_eq!(of(stalled).report().latency.unwrap().max.as_millis(), 1_400);
    }

    #[test]
    fn a_live_stream_after_a_recording_is_judged_anew() {
        let recording = (0..100).map(|n| coded(n * 4, 0, -7_200_000));
        let live = (0..100).map(|n| coded(5_000 + n * 4, 2, 0));
        let transit = of(recording.chain(live)).report();
        assert_eq!(transit.latency.unwrap().count, 100);
    }

    #[test]
    fn midnight_lies_between_two_times_of_day() {
        let midnight = Stamp(20_000 * DAY + 3 * MILLISECOND);
        let before = Timecode::from_milliseconds((DAY / MILLISECOND - 2) as u64);
        assert_eq!(since_code(midnight, before), 5 * MILLISECOND);
        let after = Timecode::from_milliseconds(4);
        assert_eq!(since_code(midnight, after), -MILLISECOND);
    }
}
