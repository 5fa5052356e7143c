//! How much is told of what is refused: whoever sends rubbish cannot fill the screen with it.

use std::time::{Duration, Instant};

/// Some refusals in a second are told each; of the others, how many there were.
#[derive(Debug, Default)]
pub(super) struct Refusals {
    /// The second that runs.
    since: Option<Instant>,
    told: u32,
    untold: u64,
}

impl Refusals {
    /// Whether the one that comes now is told. It is counted when it is not.
    pub(super) fn is_to_be_told(&mut self, now: Instant) -> bool {
        self.since.get_or_insert(now);
        let is_told = self.told < MOST;
        if is_told {
            self.told += 1;
        } else {
            self.untold += 1;
        }
        is_told
    }

    /// How many were not told, once their second is over.
    pub(super) fn more(&mut self, now: Instant) -> Option<u64> {
        let since = self.since?;
        if now.saturating_duration_since(since) < SPAN {
            return None;
        }
        self.rest()
    }

    /// How many were not told so far; another second begins with the next one.
    pub(super) fn rest(&mut self) -> Option<u64> {
        let refused = std::mem::take(self).untold;
        (refused > 0).then_some(refused)
    }
}

/// So many lines in a second can be read, and are more than a program sends by mistake.
const MOST: u32 = 10;
const SPAN: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_ones_of_a_second_are_told_and_the_others_counted() {
        let start = Instant::now();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        let mut refusals = Refusals::default();
        assert_eq!(refusals.more(at(0)), None);
        let told = (0..500).filter(|n| refusals.is_to_be_told(at(*n))).count();
        assert_eq!((told, refusals.more(at(999))), (10, None));
        assert_eq!(refusals.more(at(1000)), Some(490));
        assert_eq!(refusals.more(at(3000)), None);
        assert!(refusals.is_to_be_told(at(3001)));
        assert_eq!((refusals.more(at(4001)), refusals.rest()), (None, None));
    }
}
