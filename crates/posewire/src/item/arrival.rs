//! When a sample arrived.

use super::Item;
use crate::clock;
use std::time::Instant;

impl Item {
    /// When the sample in it arrived, by the clock that nobody sets: what is live when its first datagram came to this machine,
    /// however long something of it was waited for since. What is played is as new as this moment, and so is what says nothing
    /// of its arrival.
    ///
    /// Where the system's time was set between the arrival and now, one that seems to come yet has come now, and none has come
    /// more than an hour ago.
    pub fn arrived(&self) -> Instant {
        let received = match self {
            Self::Frame { frame, due: None } | Self::Ahead { frame, due: None } => frame.received,
            _ => None,
        };
        received.map_or_else(Instant::now, clock::instant_of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Frame, Skeleton, Stamp, Subject};
    use std::sync::Arc;
    use std::time::Duration;

    /// How long ago a sample arrived that has the stamp of so many seconds ago.
    fn age(seconds: i64, due: Option<Instant>) -> Duration {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        frame.received = Some(Stamp(clock::now().nanoseconds() - seconds * 1_000_000_000));
        let frame = Arc::new(frame);
        let item = Item::Frame {
            frame: Arc::clone(&frame),
            due,
        };
        let of_ahead = Item::Ahead { frame, due }.arrived().elapsed();
        let of_turn = item.arrived().elapsed();
        assert!(of_turn.abs_diff(of_ahead) < Duration::from_millis(500));
        of_turn
    }

    #[test]
    fn a_live_sample_is_as_old_as_its_arrival_however_long_it_was_held() {
        for seconds in [0, 1, 5, 600] {
            let age = age(seconds, None).as_secs_f64() - seconds as f64;
            assert!((0.0..0.5).contains(&age), "{seconds} {age}");
        }
    }

    #[test]
    fn what_is_played_is_new_whatever_it_says_of_its_recording() {
        for seconds in [0, 1, 1_000_000] {
            assert!(age(seconds, Some(Instant::now())) < Duration::from_millis(500));
        }
    }

    #[test]
    fn a_clock_that_was_set_makes_nothing_older_than_an_hour_or_yet_to_come() {
        assert!(age(-1_000_000, None) < Duration::from_millis(500));
        assert!(age(1_000_000_000, None) < Duration::from_secs(3601));
    }
}
