//! Instants and times of day.

use crate::Error;
use std::fmt;
use std::ops::Sub;
use std::str::FromStr;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// An instant: nanoseconds of UTC since 1970, as the kernel stamps a received datagram.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stamp(pub i64);

impl Stamp {
    /// The instant `seconds` and `nanoseconds` after 1970 began.
    pub const fn from_parts(seconds: i64, nanoseconds: i64) -> Self {
        Self(seconds.saturating_mul(1_000_000_000).saturating_add(nanoseconds))
    }

    /// Nanoseconds of UTC since 1970.
    pub const fn nanoseconds(self) -> i64 {
        self.0
    }

    /// This instant moved by `duration`.
    #[must_use]
    pub fn after(self, duration: Duration) -> Self {
        Self(
            self.0
                .saturating_add(i64::try_from(duration.as_nanos()).unwrap_or(i64::MAX)),
        )
    }

    /// The time from `earlier` to this instant, zero when `earlier` is later.
    pub fn since(self, earlier: Self) -> Duration {
        Duration::from_nanos(u64::try_from(self.0.saturating_sub(earlier.0)).unwrap_or(0))
    }
}

impl From<SystemTime> for Stamp {
    fn from(time: SystemTime) -> Self {
        match time.duration_since(UNIX_EPOCH) {
            Ok(after) => Self(i64::try_from(after.as_nanos()).unwrap_or(i64::MAX)),
            Err(before) => Self(i64::try_from(before.duration().as_nanos()).map_or(i64::MIN, |nanos| -nanos)),
        }
    }
}

impl Sub for Stamp {
    type Output = i64;

    /// Signed nanoseconds from `other` to `self`.
    fn sub(self, other: Self) -> i64 {
        self.0.saturating_sub(other.0)
    }
}

/// A time of day in UTC with milliseconds, as MVN prints it: `HH:MM:SS.mmm`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Timecode(u32);

impl Timecode {
    /// The timecode that many milliseconds after midnight. Whole days are dropped.
    pub const fn from_milliseconds(milliseconds: u64) -> Self {
        Self((milliseconds % MILLISECONDS_PER_DAY) as u32)
    }

    /// The time of day of an instant.
    pub const fn of_day(stamp: Stamp) -> Self {
        Self(stamp.0.div_euclid(1_000_000).rem_euclid(MILLISECONDS_PER_DAY as i64) as u32)
    }

    /// The timecode of `frame` within a second that holds `rate` frames: MVNX counts frames in its last field.
    pub fn from_frame(hours: u32, minutes: u32, seconds: u32, frame: u32, rate: f64) -> Self {
        let milliseconds = if rate > 0.0 {
            (f64::from(frame) * 1000.0 / rate).round()
        } else {
            0.0
        };
        let whole = (u64::from(hours) * 60 + u64::from(minutes)) * 60 + u64::from(seconds);
        Self::from_milliseconds((whole * 1000).saturating_add(milliseconds as u64))
    }

    /// Milliseconds since midnight, less than 86,400,000.
    pub const fn milliseconds(self) -> u32 {
        self.0
    }

    /// Seconds since midnight, less than 86,400: the number nearest to its milliseconds.
    pub fn seconds(self) -> f64 {
        f64::from(self.0) / 1000.0
    }
}

impl fmt::Display for Timecode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = self.0 / 1000;
        let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
        write!(f, "{hours:02}:{minutes:02}:{:02}.{:03}", seconds % 60, self.0 % 1000)
    }
}

impl FromStr for Timecode {
    type Err = Error;

    /// Reads `HH:MM:SS.mmm`.
    fn from_str(text: &str) -> Result<Self, Error> {
        let bad = || Error::Timecode { found: text.to_owned() };
        let (clock, milliseconds) = text.split_once('.').ok_or_else(bad)?;
        let fields = clock
            .split(':')
            .map(|field| digits(field, 2))
            .collect::<Option<Vec<_>>>();
        let fields = fields.ok_or_else(bad)?;
        let milliseconds = digits(milliseconds, 3).ok_or_else(bad)?;
        let &[hours, minutes, seconds] = fields.as_slice() else {
            return Err(bad());
        };
        if hours > 23 || minutes > 59 || seconds > 60 {
            return Err(bad());
        }
        Ok(Self::from_milliseconds(
            ((hours * 60 + minutes) * 60 + seconds) * 1000 + milliseconds,
        ))
    }
}

fn digits(text: &str, count: usize) -> Option<u64> {
    let exact = text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit());
    exact.then(|| text.parse().ok()).flatten()
}

/// The number of seconds that is nearest to a time, so that whole milliseconds are what they are divided by 1000.
pub(crate) fn seconds(time: Duration) -> f64 {
    // Seconds and nanoseconds by themselves would be rounded twice. Of 100 days, nanoseconds are whole numbers of f64.
    time.as_nanos() as f64 / 1e9
}

const MILLISECONDS_PER_DAY: u64 = 86_400_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timecode_reads_what_it_prints() {
        for milliseconds in [0, 1, 999, 27_837, 86_399_999] {
            let code = Timecode::from_milliseconds(milliseconds);
            assert_eq!(code.to_string().parse(), Ok(code));
        }
        assert_eq!(Timecode::from_milliseconds(45_296_789).to_string(), "12:34:56.789");
        assert_eq!(
            Timecode::from_milliseconds(45_296_789).seconds().to_bits(),
            45_296.789_f64.to_bits()
        );
    }

    #[test]
    fn text_that_is_no_timecode_is_refused() {
        for text in [
            "",
            "12:34:56",
            "24:00:00.000",
            "12:60:00.000",
            "1:2:3.4",
            "12:34:56.78x",
            "-1:00:00.000",
        ] {
            assert_eq!(
                text.parse::<Timecode>(),
                Err(Error::Timecode { found: text.to_owned() })
            );
        }
    }

    #[test]
    fn a_frame_number_becomes_milliseconds() {
        assert_eq!(Timecode::from_frame(4, 17, 11, 30, 60.0).to_string(), "04:17:11.500");
        assert_eq!(
            Timecode::from_frame(4, 17, 11, 30, f64::NAN).to_string(),
            "04:17:11.000"
        );
        let most = Timecode::from_frame(u32::MAX, u32::MAX, u32::MAX, u32::MAX, f64::MIN_POSITIVE);
        assert!(u64::from(most.milliseconds()) < MILLISECONDS_PER_DAY);
    }

    #[test]
    fn an_instant_before_1970_has_a_time_of_day() {
        assert_eq!(Timecode::of_day(Stamp(-1_000_000)).to_string(), "23:59:59.999");
    }
}
