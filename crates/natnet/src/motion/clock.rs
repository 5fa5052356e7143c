//! Timecodes and timestamps.

use crate::frame::Timecode;
use posewire_motion::Timecode as TimeOfDay;
use std::time::Duration;

/// The time of day of a timecode. Zero, which servers without a timecode generator send, is `None`.
pub(super) fn timecode_in(timecode: Option<Timecode>, rate: f64) -> Option<TimeOfDay> {
    let timecode = timecode.filter(|timecode| *timecode != Timecode::default())?;
    let [hours, minutes, seconds, frame] = timecode.parts().map(u32::from);
    Some(TimeOfDay::from_frame(hours, minutes, seconds, frame, rate))
}

/// The timecode that is nearest to a time of day and not in another second.
pub(super) fn timecode_out(time: Option<TimeOfDay>, rate: f64) -> Option<Timecode> {
    let milliseconds = time?.milliseconds();
    let [hours, minutes, seconds] = [3_600_000, 60_000, 1000].map(|unit| milliseconds / unit);
    let last = (rate.ceil() - 1.0).clamp(0.0, 255.0);
    let frame = (f64::from(milliseconds % 1000) * rate / 1000.0).round().min(last);
    Some(Timecode::new(
        hours as u8,
        (minutes % 60) as u8,
        (seconds % 60) as u8,
        frame as u8,
        0,
    ))
}

/// The source's clock: zero before 2.6, which has no timestamp, and for one that is no time.
pub(super) fn time_in(timestamp: Option<f64>) -> Duration {
    timestamp
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timecode_comes_back_within_its_frame() {
        for text in ["04:17:11.500", "23:59:59.967", "00:00:01.033"] {
            let time: TimeOfDay = text.parse().unwrap();
            assert_eq!(timecode_in(timecode_out(Some(time), 30.0), 30.0), Some(time));
        }
        let late = "00:00:01.999".parse().ok();
        assert_eq!(timecode_out(late, 30.0), Some(Timecode::new(0, 0, 1, 29, 0)));
        assert_eq!(timecode_in(Some(Timecode::default()), 30.0), None);
    }

    #[test]
    fn a_timestamp_that_is_no_time_is_zero() {
        assert_eq!(time_in(Some(1.25)), Duration::from_millis(1250));
        for timestamp in [None, Some(-1.0), Some(f64::NAN), Some(f64::INFINITY)] {
            assert_eq!(time_in(timestamp), Duration::ZERO);
        }
    }
}
