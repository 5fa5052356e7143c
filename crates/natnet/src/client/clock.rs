//! The server's clock, seen from here.

use std::collections::VecDeque;
use std::time::Duration;

use posewire_motion::Stamp;

use crate::command::EchoResponse;

/// What the server's clock showed at some instant, and how sure that is.
///
/// The server reads its clock somewhere between the sending of an echo request and the arrival of the
/// answer. The middle is at most half the round trip wrong, and one part in ten thousand of the time since
/// then, which is more than two quartz clocks drift apart. Of the echoes of the last 30 seconds the one
/// counts that is least wrong by this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockEstimate {
    /// Ticks of the server's clock in a second.
    pub frequency: u64,
    /// What the server's clock showed.
    pub ticks: u64,
    /// When it did, on the client's clock.
    pub at: Stamp,
    /// How much earlier or later than `at` that can have been.
    pub uncertainty: Duration,
    /// The time from the question for it to the answer.
    pub round_trip: Duration,
}

impl ClockEstimate {
    /// When the server's clock showed `ticks`, on the client's clock. This turns host stamps of frames
    /// into stamps of the client.
    pub fn stamp_of(&self, ticks: u64) -> Stamp {
        let since = i128::from(ticks) - i128::from(self.ticks);
        let nanoseconds = since * NANOSECONDS / i128::from(self.frequency.max(1));
        Stamp(clamp(i128::from(self.at.0) + nanoseconds))
    }

    /// Nanoseconds that the client's clock is ahead of the server's, which counts from its zero.
    pub fn offset(&self) -> i64 {
        self.stamp_of(0).0
    }
}

/// The echoes of a while.
#[derive(Debug, Default)]
pub(super) struct ServerClock {
    frequency: u64,
    asked: VecDeque<Stamp>,
    echoes: VecDeque<Echo>,
    /// Whether the connection was lost since the last echo, and the server may have begun anew.
    doubted: bool,
}

#[derive(Clone, Copy, Debug)]
struct Echo {
    sent: Stamp,
    received: Stamp,
    ticks: u64,
}

impl ServerClock {
    /// A clock of which nothing is known but its frequency.
    pub(super) fn new(frequency: u64) -> Self {
        Self {
            frequency,
            ..Self::default()
        }
    }

    /// The connection is lost. What was known of the clock counts again when an echo agrees with it.
    pub(super) fn doubt(&mut self) {
        self.asked.clear();
        self.doubted = true;
    }

    /// The clock of a server that has answered again, which now says that it has this frequency.
    pub(super) fn resume(&mut self, frequency: u64) {
        if frequency != self.frequency {
            *self = Self::new(frequency);
        }
        self.doubt();
    }

    /// Remembers a question, and gives the ticks that go with it.
    pub(super) fn ask(&mut self, now: Stamp) -> u64 {
        if self.asked.len() == MAX_ASKED {
            self.asked.pop_front();
        }
        self.asked.push_back(now);
        now.0 as u64
    }

    /// Takes an answer. One to no question, or a second one, says nothing.
    pub(super) fn answer(&mut self, now: Stamp, response: EchoResponse) -> Option<ClockEstimate> {
        let place = self
            .asked
            .iter()
            .position(|sent| sent.0 as u64 == response.client_ticks)?;
        let sent = self.asked.remove(place)?;
        if self.frequency == 0 || now < sent {
            return None;
        }
        let echo = Echo {
            sent,
            received: now,
            ticks: response.server_ticks,
        };
        self.remember(echo);
        self.estimate(now)
    }

    /// The best that is known at `now`.
    pub(super) fn estimate(&self, now: Stamp) -> Option<ClockEstimate> {
        self.best(now).filter(|_| !self.doubted)
    }

    fn best(&self, now: Stamp) -> Option<ClockEstimate> {
        let estimates = self.echoes.iter().map(|echo| echo.estimate(now, self.frequency));
        estimates.min_by_key(|estimate| estimate.uncertainty)
    }

    /// An echo that contradicts the ones before is from a clock that was set, or began anew.
    fn remember(&mut self, echo: Echo) {
        let new = echo.estimate(echo.received, self.frequency);
        let agrees = self.best(echo.received).is_none_or(|old| agree(&old, &new));
        if !agrees {
            self.echoes.clear();
        }
        let recent = |old: &Echo| echo.received.since(old.received) < WINDOW;
        self.echoes.retain(recent);
        if self.echoes.len() == MAX_ECHOES {
            self.echoes.pop_front();
        }
        self.echoes.push_back(echo);
        self.doubted = false;
    }
}

impl Echo {
    fn estimate(&self, now: Stamp, frequency: u64) -> ClockEstimate {
        let round_trip = self.received.since(self.sent);
        let half = round_trip / 2;
        ClockEstimate {
            frequency,
            ticks: self.ticks,
            at: self.sent.after(half),
            uncertainty: half.saturating_add(now.since(self.received) / DRIFT_DIVISOR),
            round_trip,
        }
    }
}

fn agree(old: &ClockEstimate, new: &ClockEstimate) -> bool {
    let apart = old.stamp_of(new.ticks).0.abs_diff(new.at.0);
    let allowed = old.uncertainty.saturating_add(new.uncertainty).saturating_add(SLACK);
    u128::from(apart) <= allowed.as_nanos()
}

fn clamp(nanoseconds: i128) -> i64 {
    nanoseconds.clamp(i64::MIN.into(), i64::MAX.into()) as i64
}

const NANOSECONDS: i128 = 1_000_000_000;
const WINDOW: Duration = Duration::from_secs(30);
const DRIFT_DIVISOR: u32 = 10_000;
/// Coarse ticks and stamps of another clock than the one that sent.
const SLACK: Duration = Duration::from_micros(100);
const MAX_ASKED: usize = 8;
const MAX_ECHOES: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;

    const MILLISECOND: i64 = 1_000_000;

    /// Asks at `at` a 10 MHz clock that began 50 ms after 0.
    fn echo(clock: &mut ServerClock, at: i64, there: i64, back: i64) -> Option<ClockEstimate> {
        let client_ticks = clock.ask(Stamp(at));
        let server_ticks = (at + there - 50 * MILLISECOND) as u64 / 100;
        let response = EchoResponse {
            client_ticks,
            server_ticks,
        };
        clock.answer(Stamp(at + there + back), response)
    }

    #[test]
    fn the_shortest_round_trip_counts_and_the_truth_is_within_its_uncertainty() {
        let mut clock = ServerClock::new(10_000_000);
        let trips = [(3, 9), (1, 2), (20, 1), (8, 8)];
        let estimates = trips.into_iter().enumerate().map(|(n, (there, back))| {
            let at = 1000 * MILLISECOND + n as i64 * 500 * MILLISECOND;
            echo(&mut clock, at, there * MILLISECOND, back * MILLISECOND).unwrap()
        });
        for estimate in estimates {
            let error = (estimate.offset() - 50 * MILLISECOND).unsigned_abs();
            assert!(u128::from(error) <= estimate.uncertainty.as_nanos() + 100);
        }
        let now = Stamp(3000 * MILLISECOND);
        let best = clock.estimate(now).unwrap();
        assert_eq!(best.uncertainty.as_micros(), 1500 + 149);
    }

    #[test]
    fn a_clock_that_drifts_stays_within_its_uncertainty() {
        let mut clock = ServerClock::new(10_000_000);
        for second in 1..600_i64 {
            let sent = second * 1000 * MILLISECOND;
            let read = sent + MILLISECOND;
            // 50 parts in a million too fast.
            let server_ticks = (read + read / 20_000) as u64 / 100;
            let client_ticks = clock.ask(Stamp(sent));
            let response = EchoResponse {
                client_ticks,
                server_ticks,
            };
            let estimate = clock.answer(Stamp(read + MILLISECOND / 2), response).unwrap();
            let error = (estimate.stamp_of(server_ticks) - Stamp(read)).unsigned_abs();
            assert!(u128::from(error) <= estimate.uncertainty.as_nanos() + 100);
            assert!(estimate.uncertainty <= Duration::from_millis(1));
        }
    }

    #[test]
    fn an_estimate_grows_uncertain_with_time() {
        let mut clock = ServerClock::new(10_000_000);
        let fresh = echo(&mut clock, 1000 * MILLISECOND, MILLISECOND, MILLISECOND).unwrap();
        let later = clock.estimate(Stamp(11_002 * MILLISECOND)).unwrap();
        assert_eq!(later.uncertainty, fresh.uncertainty + Duration::from_millis(1));
    }

    #[test]
    fn a_clock_that_begins_anew_is_read_anew() {
        let mut clock = ServerClock::new(10_000_000);
        echo(&mut clock, 5000 * MILLISECOND, 1000, 1000).unwrap();
        let client_ticks = clock.ask(Stamp(6000 * MILLISECOND));
        let response = EchoResponse {
            client_ticks,
            server_ticks: 7,
        };
        let estimate = clock.answer(Stamp(6010 * MILLISECOND), response).unwrap();
        assert_eq!((estimate.ticks, estimate.at), (7, Stamp(6005 * MILLISECOND)));
    }

    #[test]
    fn a_good_echo_outlives_a_lost_connection_and_a_slow_answer_after_it() {
        let mut clock = ServerClock::new(10_000_000);
        let good = echo(&mut clock, 1000 * MILLISECOND, MILLISECOND, MILLISECOND).unwrap();
        clock.doubt();
        assert_eq!(clock.estimate(Stamp(2000 * MILLISECOND)), None);
        clock.resume(10_000_000);
        let slow = echo(&mut clock, 5000 * MILLISECOND, 900 * MILLISECOND, 20 * MILLISECOND).unwrap();
        assert_eq!((slow.at, slow.round_trip), (good.at, good.round_trip));
        clock.resume(1_000_000);
        assert_eq!(clock.estimate(Stamp(6000 * MILLISECOND)), None);
    }

    #[test]
    fn answers_to_no_question_say_nothing() {
        let mut clock = ServerClock::new(10_000_000);
        let asked = clock.ask(Stamp(9));
        let response = |client_ticks| EchoResponse {
            client_ticks,
            server_ticks: 1,
        };
        assert_eq!(clock.answer(Stamp(10), response(8)), None);
        assert!(clock.answer(Stamp(10), response(asked)).is_some());
        assert_eq!(clock.answer(Stamp(11), response(asked)), None);
    }

    #[test]
    fn extreme_ticks_do_not_overflow() {
        let estimate = ClockEstimate {
            frequency: 1,
            ticks: u64::MAX,
            at: Stamp(i64::MIN),
            uncertainty: Duration::ZERO,
            round_trip: Duration::ZERO,
        };
        assert_eq!(estimate.stamp_of(0), Stamp(i64::MIN));
        assert_eq!(estimate.stamp_of(u64::MAX), Stamp(i64::MIN));
    }
}
