//! The samples that are remembered.

use super::HALF;
use std::collections::VecDeque;

/// The latest samples of a session, oldest first, each once.
#[derive(Clone, Debug, Default)]
pub(super) struct Window(VecDeque<u32>);

impl Window {
    pub(super) fn newest(&self) -> Option<u32> {
        self.0.back().copied()
    }

    pub(super) fn oldest(&self) -> Option<u32> {
        self.0.front().copied()
    }

    /// Steps from each sample to the next.
    pub(super) fn steps(&self) -> impl Iterator<Item = u32> {
        let pairs = self.0.iter().zip(self.0.iter().skip(1));
        pairs.map(|(older, newer)| newer.wrapping_sub(*older))
    }

    pub(super) fn is_full(&self) -> bool {
        self.0.len() == Self::SIZE
    }

    pub(super) fn contains(&self, sample: u32) -> bool {
        self.0.contains(&sample)
    }

    /// Forgets all and begins with these.
    pub(super) fn restart(&mut self, samples: &[u32]) {
        self.0.clear();
        self.0.extend(samples);
    }

    /// Adds a sample that is newer than all.
    pub(super) fn push(&mut self, sample: u32) {
        let leaves = |oldest: &u32| sample.wrapping_sub(*oldest) >= HALF;
        while self.is_full() || self.0.front().is_some_and(leaves) {
            self.0.pop_front();
        }
        self.0.push_back(sample);
    }

    /// Adds a sample that is not newer than all, and gives its neighbours: the one before it, if there is one, and the
    /// one after it. `None` when it is there already.
    pub(super) fn insert(&mut self, sample: u32) -> Option<(Option<u32>, u32)> {
        let newest = self.newest()?;
        let behind = newest.wrapping_sub(sample);
        let compare = |seen: &u32| behind.cmp(&newest.wrapping_sub(*seen));
        let place = self.0.binary_search_by(compare).err()?;
        let neighbours = (place.checked_sub(1).map(|place| self.0[place]), self.0[place]);
        self.0.insert(place, sample);
        if self.0.len() > Self::SIZE {
            self.0.pop_front();
        }
        Some(neighbours)
    }

    /// The most common step between the few samples of a session that has just begun, and how many steps are like it;
    /// of equally common ones the smallest.
    pub(super) fn most_common_step(&self) -> (Option<u32>, usize) {
        let count = |step: u32| self.steps().filter(|other| *other == step).count();
        let most = self.steps().max_by_key(|step| (count(*step), u32::MAX - step));
        (most, most.map_or(0, count))
    }

    /// How many samples are remembered.
    pub(super) const SIZE: usize = 256;
}

/// How many samples are missing between two that are `step` apart.
pub(super) fn missing_in(step: u32, stride: Option<u32>) -> u32 {
    stride.map_or(0, |stride| (step / stride).saturating_sub(1))
}

/// How many samples fewer are missing with `sample` between its neighbours. Less than none when it shows that there are
/// more, as it can where steps are not whole strides.
pub(super) fn found_by(sample: u32, (older, newer): (Option<u32>, u32), stride: Option<u32>) -> i64 {
    let missing = |from: u32, to: u32| i64::from(missing_in(to.wrapping_sub(from), stride));
    match older {
        Some(older) => missing(older, newer) - missing(older, sample) - missing(sample, newer),
        None => -missing(sample, newer),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(samples: impl IntoIterator<Item = u32>) -> Window {
        Window(samples.into_iter().collect())
    }

    #[test]
    fn the_oldest_sample_goes_when_there_is_no_room_for_one_more() {
        let mut almost_full = of((0..255).map(|n| 2 * n));
        assert_eq!(almost_full.insert(3), Some((Some(2), 4)));
        assert_eq!((almost_full.oldest(), almost_full.is_full()), (Some(0), true));
        assert_eq!(almost_full.insert(5), Some((Some(4), 6)));
        assert_eq!((almost_full.oldest(), almost_full.is_full()), (Some(2), true));
    }

    #[test]
    fn of_equally_common_steps_the_smallest_is_taken() {
        let steps = of([0, 2_000_000_000, 4_100_000_000]);
        assert_eq!(steps.most_common_step(), (Some(2_000_000_000), 1));
    }

    #[test]
    fn what_a_sample_finds_is_what_its_two_gaps_lack_less_than_the_one_before() {
        assert_eq!(found_by(5, (Some(0), 10), Some(1)), 1);
        assert_eq!(found_by(7, (None, 10), Some(1)), -2);
        assert_eq!(found_by(7, (None, 10), None), 0);
    }
}
