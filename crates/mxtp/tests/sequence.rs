//! What a sequence counts is what a disturbed stream lost, doubled and reordered.

use std::collections::HashSet;
use std::time::Duration;

use posewire_motion::Stamp;
use posewire_mxtp::{Observation, Sequence, Tally};
use proptest::prelude::*;

/// A stream whose sender counts evenly, and how the network treats it.
#[derive(Clone, Debug)]
struct Stream {
    start: u32,
    stride: u32,
    length: usize,
    /// Of a thousand samples, how many are lost, doubled and delayed.
    lost: u32,
    doubled: u32,
    delayed: u32,
    seed: u64,
}

impl Stream {
    /// The samples in the order of their arrival, and how many of them were lost.
    fn arrivals(&self) -> (Vec<u32>, u64) {
        let mut random = Random(self.seed);
        let (mut arrivals, mut lost) = (Vec::new(), 0);
        for place in 0..self.length {
            let spared = place < EDGE || place + EDGE >= self.length;
            if !spared && random.below(1000) < self.lost {
                lost += 1;
                continue;
            }
            let sample = self.start.wrapping_add(self.stride.wrapping_mul(place as u32));
            let delay = if random.below(1000) < self.delayed {
                random.below(20)
            } else {
                0
            };
            arrivals.push((2 * place + 2 * delay as usize, sample));
            if random.below(1000) < self.doubled {
                let delay = delay + random.below(20 - delay);
                arrivals.push((2 * place + 2 * delay as usize + 1, sample));
            }
        }
        arrivals.sort_by_key(|(place, _)| *place);
        (arrivals.into_iter().map(|(_, sample)| sample).collect(), lost)
    }

    /// What a sequence must count, found the slow way.
    fn expected(&self) -> Tally {
        let (arrivals, missing) = self.arrivals();
        let mut tally = Tally {
            missing,
            ..Tally::default()
        };
        let (mut seen, mut newest) = (HashSet::new(), None);
        for sample in arrivals {
            let count = sample.wrapping_sub(self.start);
            if !seen.insert(count) {
                tally.duplicate += 1;
            } else if newest.is_some_and(|newest| count < newest) {
                tally.late += 1;
            } else {
                newest = Some(count);
            }
        }
        tally
    }

    fn observed(&self) -> Tally {
        let (mut sequence, mut now) = (Sequence::new(), Stamp(0));
        for sample in self.arrivals().0 {
            sequence.observe(sample, now);
            now = now.after(Duration::from_micros(4167));
        }
        assert_eq!(sequence.stride(), Some(self.stride));
        sequence.tally()
    }
}

/// A small generator, so that a seed names a stream.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut value = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((value >> 32) % u64::from(limit.max(1))) as u32
    }
}

/// Samples at either end that are never lost, so that losses can be told.
const EDGE: usize = 16;

fn streams() -> impl Strategy<Value = Stream> {
    let start = prop_oneof![any::<u32>(), u32::MAX - 5000..=u32::MAX, Just(0)];
    (
        start,
        1..=8_u32,
        40..2000_usize,
        0..150_u32,
        0..100_u32,
        0..100_u32,
        any::<u64>(),
    )
        .prop_map(|(start, stride, length, lost, doubled, delayed, seed)| Stream {
            start,
            stride,
            length,
            lost,
            doubled,
            delayed,
            seed,
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_loss_and_double_is_counted_once(stream in streams()) {
        prop_assert_eq!(stream.observed(), stream.expected());
    }

    #[test]
    fn no_samples_at_any_times_upset_it(samples in prop::collection::vec((any::<u32>(), any::<i64>()), 0..400)) {
        let mut sequence = Sequence::new();
        for (sample, now) in samples {
            let seen = sequence.observe(sample, Stamp(now));
            let behind = sequence.newest().unwrap().wrapping_sub(sample);
            match seen {
                Observation::New { .. } => prop_assert_eq!(behind, 0),
                // The last of the samples that show it may have overtaken another.
                Observation::Reset(_) => prop_assert!(behind < 1 << 31),
                _ => {}
            }
        }
    }

    #[test]
    fn no_long_steps_upset_it(steps in prop::collection::vec(prop_oneof![0..300_u32, any::<u32>()], 0..600)) {
        let (mut sequence, mut sample) = (Sequence::new(), 0_u32);
        for step in steps {
            sample = sample.wrapping_add(step);
            sequence.observe(sample, Stamp(0));
        }
    }
}

#[test]
fn a_minute_at_240_hz_is_counted_exactly() {
    for seed in 0..20 {
        let stream = Stream {
            start: u32::MAX - 3000 * seed as u32,
            stride: 1 + seed as u32 % 8,
            length: 14_400,
            lost: 50,
            doubled: 30,
            delayed: 40,
            seed,
        };
        assert_eq!(stream.observed(), stream.expected(), "{stream:?}");
    }
}
