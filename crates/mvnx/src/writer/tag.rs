//! The start tags of frames that come from no file.

use crate::Document;
use crate::document::MILLISECONDS_PER_DAY;
use posewire_motion::{Frame, Stamp, Timecode};
use std::time::Duration;

/// Makes start tags of frames.
#[derive(Clone, Debug)]
pub(crate) struct Tags {
    rate: Option<f64>,
    /// When the present day began, milliseconds of UTC since 1970.
    midnight: Option<u64>,
    /// The time of the frame before.
    last: u64,
    /// A sample, and its number among the frames of its day: the numbers of those behind it count on from here.
    counted: Option<(u32, i64)>,
}

impl Tags {
    pub(crate) fn new(document: &Document) -> Self {
        Self {
            rate: document.header.frame_rate(),
            midnight: document.around.midnight,
            last: 0,
            counted: None,
        }
    }

    /// The start tag of a normal frame without its brackets: `time` in whole milliseconds, `tc` with the frame's number
    /// within the second, `ms` in milliseconds since 1970.
    ///
    /// `tc` is empty when the time of day is not known, `ms` when the day is not: readers look for both.
    pub(crate) fn of(&mut self, frame: &Frame) -> String {
        let time = (frame.time + Duration::from_micros(500)).as_millis();
        let (index, timecode) = (frame.sample, frame.timecode);
        let clock = timecode.map_or_else(String::new, |timecode| self.clock(timecode, index));
        let ms = timecode.and_then(|timecode| self.epoch(timecode, frame.received));
        let ms = ms.map_or_else(String::new, |ms| ms.to_string());
        format!("frame time=\"{time}\" index=\"{index}\" tc=\"{clock}\" ms=\"{ms}\" type=\"normal\"")
    }

    /// The time of day as `tc` has it. Whole milliseconds would give some frames of a fast take the same number and leave
    /// others out, so frames are counted on by their samples as long as that agrees with the clock.
    fn clock(&mut self, timecode: Timecode, sample: u32) -> String {
        let Some(rate) = self.rate.filter(|rate| rate.is_finite() && *rate > 0.0) else {
            return clock(timecode, self.rate);
        };
        let seconds = timecode.seconds();
        let counted = self
            .counted
            .map(|(first, number)| number + i64::from(sample) - i64::from(first));
        let agrees = |number: &i64| {
            let off = (*number as f64 / rate - seconds + HALF_A_DAY).rem_euclid(2.0 * HALF_A_DAY) - HALF_A_DAY;
            off.abs() <= LARGEST_DISAGREEMENT.max(2.0 / rate)
        };
        let number = counted.filter(agrees).unwrap_or_else(|| {
            // Milliseconds are rounded to the nearest.
            let number = ((seconds + 0.0005) * rate + 1e-9).floor() as i64;
            self.counted = Some((sample, number));
            number
        });
        let second = (number as f64 / rate + 1e-9).floor();
        let frame = number - (second * rate - 1e-6).ceil() as i64;
        print_clock((second as i64).rem_euclid(86_400) as u32, frame.unsigned_abs(), rate)
    }

    /// Milliseconds since 1970 at a time of day: of the day of the frames before, or of the one of its receipt. A time of day
    /// that is far from that of its receipt is of another clock, and nobody knows of which day.
    fn epoch(&mut self, timecode: Timecode, received: Option<Stamp>) -> Option<u64> {
        let of_day = u64::from(timecode.milliseconds());
        if self.midnight.is_none() {
            let received = u64::try_from(received?.nanoseconds() / 1_000_000).ok()?;
            let half_a_day_after = (received + MILLISECONDS_PER_DAY / 2).checked_sub(of_day)?;
            let midnight = half_a_day_after - half_a_day_after % MILLISECONDS_PER_DAY;
            if (midnight + of_day).abs_diff(received) > LONGEST_WAY {
                return None;
            }
            self.midnight = Some(midnight);
        }
        let mut midnight = self.midnight?;
        if midnight + of_day + MILLISECONDS_PER_DAY / 2 < self.last {
            midnight += MILLISECONDS_PER_DAY;
        }
        self.midnight = Some(midnight);
        self.last = midnight + of_day;
        Some(self.last)
    }
}

/// `hours:minutes:seconds:frame`, the frame counted within the second with as many digits as the rate asks for.
pub(crate) fn clock(timecode: Timecode, rate: Option<f64>) -> String {
    let rate = rate.unwrap_or_default();
    let frame = f64::from(timecode.milliseconds() % 1000) * rate / 1000.0 + 1e-9;
    print_clock(timecode.milliseconds() / 1000, frame as u64, rate)
}

fn print_clock(seconds: u32, frame: u64, rate: f64) -> String {
    let digits = if rate > 100.0 { 3 } else { 2 };
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{hours:02}:{minutes:02}:{seconds:02}:{frame:0digits$}")
}

/// Seconds.
const HALF_A_DAY: f64 = 43_200.0;
/// How far counted frames may be from the clock, s: clocks of live streams jitter.
const LARGEST_DISAGREEMENT: f64 = 0.02;
/// How far the receipt of a frame may be from its timecode for both to be of one clock, ms: time zones are further apart.
const LONGEST_WAY: u64 = 600_000;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use std::sync::Arc;

    const DAY: u64 = 17_848 * MILLISECONDS_PER_DAY;

    fn frame(timecode: u64, received: Option<u64>) -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        frame.timecode = Some(Timecode::from_milliseconds(timecode));
        frame.received = received.map(|received| Stamp(received as i64 * 1_000_000));
        frame
    }

    fn tags(midnight: Option<u64>) -> Tags {
        Tags {
            rate: Some(60.0),
            midnight,
            last: 0,
            counted: None,
        }
    }

    fn ms(tag: &str) -> Option<u64> {
        let (_, rest) = tag.split_once(" ms=\"")?;
        rest.split_once('"')?.0.parse().ok()
    }

    #[test]
    fn a_clock_has_the_frame_within_the_second() {
        let code = Timecode::from_milliseconds(15_431_842);
        assert_eq!(clock(code, Some(60.0)), "04:17:11:50");
        assert_eq!(clock(code, Some(240.0)), "04:17:11:202");
        assert_eq!(clock(code, Some(100.0)), "04:17:11:84");
        assert_eq!(clock(code, None), "04:17:11:00");
    }

    #[test]
    fn a_tag_has_all_attributes_in_order() {
        let mut frame = frame(15_431_842, None);
        (frame.sample, frame.time) = (7, Duration::from_micros(16_667));
        assert_eq!(
            tags(Some(DAY)).of(&frame),
            "frame time=\"17\" index=\"7\" tc=\"04:17:11:50\" ms=\"1542082631842\" type=\"normal\""
        );
        frame.timecode = None;
        assert_eq!(
            tags(Some(DAY)).of(&frame),
            "frame time=\"17\" index=\"7\" tc=\"\" ms=\"\" type=\"normal\"",
            "nothing is known of the time of day"
        );
    }

    #[test]
    fn time_goes_on_over_midnight() {
        let mut tags = tags(Some(DAY));
        assert_eq!(ms(&tags.of(&frame(86_399_990, None))), Some(DAY + 86_399_990));
        assert_eq!(ms(&tags.of(&frame(7, None))), Some(DAY + 86_400_007));
        assert_eq!(ms(&tags.of(&frame(3, None))), Some(DAY + 86_400_003));
    }

    #[test]
    fn frames_are_counted_within_the_second_at_any_rate() {
        for rate in [59.94, 60.0, 100.0, 144.0, 240.0, 1000.0, 2500.0] {
            let mut tags = Tags {
                rate: Some(rate),
                ..tags(None)
            };
            let mut before: Option<(u64, u64)> = None;
            for sample in 0..6000_u32 {
                let milliseconds = 41_000_412.0 + f64::from(sample) * 1000.0 / rate;
                let code = Timecode::from_milliseconds(milliseconds.round() as u64);
                let clock = tags.clock(code, sample);
                let fields: Vec<u64> = clock.split(':').map(|field| field.parse().unwrap()).collect();
                let now = (fields[2], fields[3]);
                if let Some((second, frame)) = before {
                    let follows = now == (second, frame + 1) || now == ((second + 1) % 60, 0);
                    assert!(
                        follows,
                        "{rate} Hz, sample {sample}: {now:?} behind {:?}",
                        (second, frame)
                    );
                }
                assert!((now.1 as f64) < rate + 1.0);
                before = Some(now);
            }
        }
    }

    #[test]
    fn a_clock_goes_with_the_timecode_where_samples_do_not() {
        let mut tags = tags(None);
        assert_eq!(tags.clock(Timecode::from_milliseconds(86_399_984), 10), "23:59:59:59");
        assert_eq!(tags.clock(Timecode::from_milliseconds(0), 11), "00:00:00:00");
        assert_eq!(
            tags.clock(Timecode::from_milliseconds(50), 14),
            "00:00:00:03",
            "missing samples"
        );
        assert_eq!(
            tags.clock(Timecode::from_milliseconds(2000), 15),
            "00:00:02:00",
            "a pause"
        );
        assert_eq!(
            tags.clock(Timecode::from_milliseconds(2017), 3),
            "00:00:02:01",
            "a restart"
        );
    }

    #[test]
    fn a_received_frame_is_of_the_day_of_its_receipt() {
        assert_eq!(ms(&tags(None).of(&frame(10, None))), None);
        for (received, expected) in [(DAY + 20, DAY + 10), (DAY - 20, DAY + 10), (DAY + 590_000, DAY + 10)] {
            assert_eq!(ms(&tags(None).of(&frame(10, Some(received)))), Some(expected));
        }
        let late = frame(86_399_990, Some(DAY + 20));
        assert_eq!(ms(&tags(None).of(&late)), Some(DAY - 10));
    }

    #[test]
    fn a_timecode_of_another_clock_has_no_day() {
        let since_the_start = frame(700, Some(DAY + 47_220_000));
        assert_eq!(
            tags(None).of(&since_the_start),
            "frame time=\"0\" index=\"0\" tc=\"00:00:00:42\" ms=\"\" type=\"normal\""
        );
    }
}
