//! Chance that can be had again.

use super::FaultKind;

/// What chance says of one datagram. Each question has an answer of its own, whichever others are asked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draw {
    seed: u64,
    index: u64,
}

impl Draw {
    /// What chance says of the datagram at this place in the stream.
    pub(super) const fn new(seed: u64, index: u64) -> Self {
        Self { seed, index }
    }

    /// Whether a fault that meets so many of a hundred datagrams meets this one.
    pub(super) fn meets(self, kind: FaultKind, percent: f64) -> bool {
        // 53 bits are all that a double holds.
        let share = (self.number(2 * kind as u64) >> 11) as f64 / (1_u64 << 53) as f64;
        100.0 * share < percent
    }

    /// A detail of a fault: a number below `limit`, 0 when that is 0.
    pub(super) fn below(self, kind: FaultKind, limit: u64) -> u64 {
        let number = u128::from(self.number(2 * kind as u64 + 1));
        ((number * u128::from(limit)) >> 64) as u64
    }

    fn number(self, question: u64) -> u64 {
        mixed(mixed(mixed(self.seed).wrapping_add(question)).wrapping_add(self.index))
    }
}

/// One step of `SplitMix64` (Steele, Lea and Flood 2014).
const fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_meets_as_many_as_it_is_to() {
        for (percent, expected) in [
            (0.0, 0..=0),
            (1.0, 900..=1100),
            (50.0, 49_500..=50_500),
            (100.0, 100_000..=100_000),
        ] {
            for seed in 0..3 {
                let draws = (0..100_000).map(|index| Draw::new(seed, index));
                let met = draws.filter(|draw| draw.meets(FaultKind::Loss, percent)).count();
                assert!(
                    expected.contains(&met),
                    "{percent} % met {met} of 100000 with seed {seed}"
                );
            }
        }
    }

    #[test]
    fn details_are_below_their_limit_and_reach_all_of_it() {
        let mut found = [0; 7];
        for index in 0..1000 {
            found[Draw::new(7, index).below(FaultKind::Flip, 7) as usize] += 1;
        }
        assert!(found.iter().all(|count| (100..200).contains(count)), "{found:?}");
        assert_eq!(Draw::new(7, 0).below(FaultKind::Flip, 0), 0);
    }
}
