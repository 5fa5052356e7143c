//! Timecodes and timestamps.

use crate::frame::Timecode;
use posewire_motion::Timecode as TimeOfDay;
use std::time::Duration;

/// The time of day of a timecode, its subframe in milliseconds; a subframe that would reach the next frame ends just before
/// it. Zero, which servers without a timecode generator send, is `None`.
pub(super) fn timecode_in(timecode: Option<Timecode>, rate: f64) -> Option<TimeOfDay> {
    let timecode = timecode.filter(|timecode| *timecode != Timecode::default())?;
    let [hours, minutes, seconds, frame] = timecode.parts().map(u32::from);
    let start = TimeOfDay::from_frame(hours, minutes, seconds, frame, rate);
    let next = begin(frame + 1, rate).min(1000);
    let longest = next.saturating_sub(begin(frame, rate)).saturating_sub(1);
    let milliseconds = start.milliseconds() + timecode.subframe.min(longest);
    Some(TimeOfDay::from_milliseconds(milliseconds.into()))
}

/// The timecode of a time of day: the frame that has begun last, and the milliseconds since then.
pub(super) fn timecode_out(time: Option<TimeOfDay>, rate: f64) -> Option<Timecode> {
    let milliseconds = time?.milliseconds();
    let [hours, minutes, seconds] = [3_600_000, 60_000, 1000].map(|unit| milliseconds / unit);
    let rest = milliseconds % 1000;
    let frame = frame_at(rest, rate);
    Some(Timecode::new(
        hours as u8,
        (minutes % 60) as u8,
        (seconds % 60) as u8,
        frame as u8,
        rest - begin(frame, rate),
    ))
}

/// The last of the frames of a second that has begun by then.
fn frame_at(milliseconds: u32, rate: f64) -> u32 {
    let last = (rate.ceil() - 1.0).clamp(0.0, 255.0);
    // Half a millisecond more, as the beginnings are rounded to whole ones.
    let frame = ((f64::from(milliseconds) + 0.5) * rate / 1000.0).min(last) as u32;
    if begin(frame, rate) > milliseconds {
        frame - 1
    } else {
        frame
    }
}

/// Milliseconds from the second to a frame of it.
fn begin(frame: u32, rate: f64) -> u32 {
    TimeOfDay::from_frame(0, 0, 0, frame, rate).milliseconds()
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
    fn a_timecode_comes_back_to_the_millisecond() {
        for rate in [23.976, 24.0, 25.0, 29.97, 30.0, 60.0, 120.0] {
            for milliseconds in (15_431_000..15_432_000).chain([86_399_999]) {
                let time = TimeOfDay::from_milliseconds(milliseconds);
                let back = timecode_in(timecode_out(Some(time), rate), rate);
                assert_eq!(back, Some(time), "{rate} Hz");
            }
        }
        assert_eq!(timecode_in(Some(Timecode::default()), 30.0), None);
    }

    #[test]
    fn a_subframe_is_milliseconds_since_the_frame() {
        let out = |text: &str| timecode_out(text.parse().ok(), 30.0);
        assert_eq!(out("00:00:01.033"), Some(Timecode::new(0, 0, 1, 1, 0)));
        assert_eq!(out("00:00:01.050"), Some(Timecode::new(0, 0, 1, 1, 17)));
        assert_eq!(out("00:00:01.999"), Some(Timecode::new(0, 0, 1, 29, 32)));
    }

    #[test]
    fn a_subframe_that_is_no_milliseconds_stays_in_its_frame() {
        for (frame, end) in [(0, "00:00:01.032"), (29, "00:00:01.999")] {
            let timecode = Timecode::new(0, 0, 1, frame, u32::MAX);
            assert_eq!(timecode_in(Some(timecode), 30.0), end.parse().ok());
        }
        let extreme = Timecode::new(255, 255, 255, 255, u32::MAX);
        for rate in [f64::NAN, 0.0, -1.0, f64::MIN_POSITIVE, 1e9] {
            assert!(timecode_in(Some(extreme), rate).is_some());
            assert!(timecode_out("23:59:59.999".parse().ok(), rate).is_some());
        }
    }

    #[test]
    fn a_timestamp_that_is_no_time_is_zero() {
        assert_eq!(time_in(Some(1.25)), Duration::from_millis(1250));
        for timestamp in [None, Some(-1.0), Some(f64::NAN), Some(f64::INFINITY)] {
            assert_eq!(time_in(timestamp), Duration::ZERO);
        }
    }
}
