//! The start tags of frames that come from no file.

use crate::Document;
use crate::document::MILLISECONDS_PER_DAY;
use posewire_motion::{Frame, Stamp, Timecode};
use std::time::Duration;

/// Makes start tags of frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tags {
    rate: Option<f64>,
    /// When the present day began, milliseconds of UTC since 1970.
    midnight: Option<u64>,
    /// The time of the frame before.
    last: u64,
}

impl Tags {
    pub(crate) fn new(document: &Document) -> Self {
        Self {
            rate: document.header.frame_rate(),
            midnight: document.around.midnight,
            last: 0,
        }
    }

    /// The start tag of a normal frame without its brackets: `time` in whole milliseconds, `tc` with the frame's number
    /// within the second, `ms` in milliseconds since 1970, 0 when the day is not known.
    pub(crate) fn of(&mut self, frame: &Frame) -> String {
        let time = (frame.time + Duration::from_micros(500)).as_millis();
        let ms = frame.timecode.and_then(|timecode| self.epoch(timecode, frame.received));
        // So MVN says that no clock was running.
        let ms = ms.unwrap_or_default();
        let clock = clock(frame.timecode.unwrap_or_default(), self.rate);
        let index = frame.sample;
        format!("frame time=\"{time}\" index=\"{index}\" tc=\"{clock}\" ms=\"{ms}\" type=\"normal\"")
    }

    /// Milliseconds since 1970 at a time of day: of the day of the frames before, or the one nearest to its receipt.
    fn epoch(&mut self, timecode: Timecode, received: Option<Stamp>) -> Option<u64> {
        let of_day = u64::from(timecode.milliseconds());
        if self.midnight.is_none() {
            let received = u64::try_from(received?.nanoseconds() / 1_000_000).ok()?;
            let noon_before = (received + MILLISECONDS_PER_DAY / 2).checked_sub(of_day)?;
            self.midnight = Some(noon_before - noon_before % MILLISECONDS_PER_DAY);
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
    let (seconds, milliseconds) = (timecode.milliseconds() / 1000, timecode.milliseconds() % 1000);
    let frame = (f64::from(milliseconds) * rate / 1000.0 + 1e-9).floor() as u64;
    let digits = if rate > 100.0 { 3 } else { 2 };
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{hours:02}:{minutes:02}:{seconds:02}:{frame:0digits$}")
}

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
            "frame time=\"17\" index=\"7\" tc=\"00:00:00:00\" ms=\"0\" type=\"normal\""
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
    fn a_received_frame_is_of_the_day_that_lies_nearest() {
        assert_eq!(ms(&tags(None).of(&frame(10, None))), Some(0));
        for (received, expected) in [(DAY + 20, DAY + 10), (DAY - 20, DAY + 10), (DAY + 43_000_000, DAY + 10)] {
            assert_eq!(ms(&tags(None).of(&frame(10, Some(received)))), Some(expected));
        }
        let late = frame(86_399_990, Some(DAY + 20));
        assert_eq!(ms(&tags(None).of(&late)), Some(DAY - 10));
    }
}
