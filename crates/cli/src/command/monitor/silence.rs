//! When nothing that can be read has come for too long.

use std::time::{Duration, Instant};

/// Tells once of each silence.
pub(super) struct Silence {
    /// How much had been heard when something last came.
    heard: u64,
    since: Instant,
    told: bool,
}

impl Silence {
    pub(super) fn new(now: Instant) -> Self {
        Self {
            heard: 0,
            since: now,
            told: false,
        }
    }

    /// Whether it is time to say that nothing comes; `heard` only ever grows.
    pub(super) fn is_to_be_told(&mut self, heard: u64, now: Instant) -> bool {
        if heard != self.heard {
            *self = Self {
                heard,
                ..Self::new(now)
            };
        }
        let long = now.saturating_duration_since(self.since) >= QUIET_AFTER;
        long && !std::mem::replace(&mut self.told, long)
    }
}

/// How long nothing may come before people are told.
pub(super) const QUIET_AFTER: Duration = Duration::from_secs(3);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_silence_is_told_once() {
        let start = Instant::now();
        let mut silence = Silence::new(start);
        let told = [(0, 2), (0, 3), (0, 4), (7, 5), (7, 7), (7, 8), (7, 9), (9, 20), (9, 24)]
            .map(|(heard, seconds)| silence.is_to_be_told(heard, start + Duration::from_secs(seconds)));
        assert_eq!(told, [false, true, false, false, false, true, false, false, true]);
    }
}
