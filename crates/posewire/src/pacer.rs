//! Keeps a stream to its timetable.

use std::thread;
use std::time::{Duration, Instant};

use crate::histogram::{DurationHistogram, Summary};
use crate::stop::Stop;
use crate::{Error, Result};

/// Waits for absolute deadlines: `start + offset / speed`.
///
/// A sleep that ends late does not delay the next deadline, so errors never add up. What each wait
/// overshoots is recorded.
///
/// ```
/// use posewire::{pacer::Pacer, stop::Stop};
/// use std::time::{Duration, Instant};
///
/// let period = Duration::from_secs(1) / 240;
/// let mut pacer = Pacer::new(Instant::now(), 1.0, Stop::new())?;
/// for sample in 0..3 {
///     if !pacer.wait(period * sample) {
///         break; // asked to stop
///     }
/// }
/// assert_eq!(pacer.lateness().count, 3);
/// # Ok::<(), posewire::Error>(())
/// ```
#[derive(Debug)]
pub struct Pacer {
    start: Instant,
    speed: f64,
    stop: Stop,
    lateness: DurationHistogram,
}

impl Pacer {
    /// A timetable from `start`, run `speed` times as fast as recorded; `stop` ends a wait early.
    ///
    /// # Errors
    /// [`Error::Speed`] unless `speed` is finite and above 0.
    pub fn new(start: Instant, speed: f64, stop: Stop) -> Result<Self> {
        if !speed.is_finite() || speed <= 0.0 {
            return Err(Error::Speed {
                found: speed.to_string(),
            });
        }
        Ok(Self {
            start,
            speed,
            stop,
            lateness: DurationHistogram::new(),
        })
    }

    /// When the sample at `offset` from the start of the take is due; `None` beyond the range of
    /// the clock.
    pub fn deadline(&self, offset: Duration) -> Option<Instant> {
        self.start.checked_add(scaled(offset, self.speed)?)
    }

    /// Waits until the sample at `offset` is due, not at all if that is past. Gives `false`, at
    /// once or within 20 ms, when asked to stop.
    pub fn wait(&mut self, offset: Duration) -> bool {
        let Some(deadline) = self.deadline(offset) else {
            return self.wait_for_ever();
        };
        if !sleep_until(deadline, &self.stop) {
            return false;
        }
        let late = Instant::now().saturating_duration_since(deadline);
        self.lateness.record(late);
        true
    }

    /// Begins the timetable anew at `start`.
    pub fn restart(&mut self, start: Instant) {
        self.start = start;
    }

    /// Moves all deadlines back by the length of a pause.
    pub fn put_off(&mut self, by: Duration) {
        self.start = self.start.checked_add(by).unwrap_or(self.start);
    }

    /// Waits for `duration`, less when asked to stop. Gives whether it was.
    pub fn pause(&self, duration: Duration) -> bool {
        self.stop.wait(duration)
    }

    /// Whether a wait would end early.
    pub fn is_stopped(&self) -> bool {
        self.stop.is_stopped()
    }

    /// How late the waits ended.
    pub fn lateness(&self) -> Summary {
        self.lateness.summary()
    }

    fn wait_for_ever(&self) -> bool {
        while !self.stop.wait(Duration::from_hours(1)) {}
        false
    }
}

/// `offset / speed`, exact at speed 1.
fn scaled(offset: Duration, speed: f64) -> Option<Duration> {
    if speed.to_bits() == 1f64.to_bits() {
        return Some(offset);
    }
    Duration::try_from_secs_f64(offset.as_secs_f64() / speed).ok()
}

/// The far part of the wait listens for the stop; the last part is the most precise sleep that the
/// system has, which cannot be interrupted.
fn sleep_until(deadline: Instant, stop: &Stop) -> bool {
    let left = deadline.saturating_duration_since(Instant::now());
    if stop.wait(left.saturating_sub(PRECISE)) {
        return false;
    }
    let left = deadline.saturating_duration_since(Instant::now());
    if !left.is_zero() {
        thread::sleep(left);
    }
    true
}

const PRECISE: Duration = Duration::from_millis(20);

#[cfg(test)]
mod tests {
    use super::*;

    fn pacer(start: Instant, speed: f64) -> Pacer {
        Pacer::new(start, speed, Stop::new()).unwrap()
    }

    #[test]
    fn deadlines_are_absolute_and_do_not_drift() {
        let start = Instant::now();
        let hour = Duration::from_hours(1);
        assert_eq!(pacer(start, 1.0).deadline(hour), Some(start + hour));
        assert_eq!(pacer(start, 2.0).deadline(hour), Some(start + hour / 2));
        assert_eq!(pacer(start, 0.5).deadline(hour), Some(start + hour * 2));
        assert_eq!(pacer(start, 1e-300).deadline(hour), None);
    }

    #[test]
    fn a_speed_that_is_no_speed_is_refused() {
        for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(
                Pacer::new(Instant::now(), speed, Stop::new()).err(),
                Some(Error::Speed {
                    found: speed.to_string()
                })
            );
        }
    }

    #[test]
    fn a_missed_deadline_is_passed_at_once_and_counted_late() {
        let Some(start) = Instant::now().checked_sub(Duration::from_secs(2)) else {
            return;
        };
        let mut pacer = pacer(start, 1.0);
        assert!(pacer.wait(Duration::from_secs(1)));
        assert!(pacer.lateness().max >= Duration::from_secs(1));
    }

    #[test]
    fn no_wait_ends_early() {
        let start = Instant::now();
        let mut pacer = pacer(start, 1.0);
        for millis in [1, 2, 25] {
            let offset = Duration::from_millis(millis);
            assert!(pacer.wait(offset));
            assert!(start.elapsed() >= offset);
        }
        assert_eq!(pacer.lateness().count, 3);
    }

    #[test]
    fn a_pause_moves_the_deadlines_and_a_restart_forgets_it() {
        let start = Instant::now();
        let mut pacer = pacer(start, 2.0);
        pacer.put_off(Duration::from_secs(3));
        assert_eq!(
            pacer.deadline(Duration::from_secs(2)),
            Some(start + Duration::from_secs(4))
        );
        pacer.restart(start);
        assert_eq!(pacer.deadline(Duration::ZERO), Some(start));
    }

    #[test]
    fn a_stop_ends_a_long_wait() {
        let stop = Stop::new();
        let mut pacer = Pacer::new(Instant::now(), 1.0, stop.clone()).unwrap();
        let waiting = thread::spawn(move || pacer.wait(Duration::from_hours(1)));
        stop.stop();
        assert!(!waiting.join().unwrap());
    }
}
