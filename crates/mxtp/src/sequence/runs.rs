//! Samples in a row that tell of a new stride or of a rewind.

use super::{HALF, LESSON, Tally};

/// Equal steps in a row that are not the stride.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EqualSteps {
    step: u32,
    count: usize,
}

impl EqualSteps {
    /// Adds a step; says how many in a row are equal.
    pub(super) fn extend(&mut self, step: u32) -> usize {
        self.count = if step == self.step { self.count + 1 } else { 1 };
        self.step = step;
        self.count
    }
}

/// Samples that are not new, in increasing order, with no new one between them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct OldRun {
    samples: [u32; LESSON],
    count: usize,
    /// How many came again right after themselves.
    again: u64,
    /// The tally before the first of them.
    before: Tally,
}

impl OldRun {
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// The tally if all of them are new: none of them is late or duplicate but those that came again.
    pub(super) fn tally(&self) -> Tally {
        Tally {
            duplicate: self.before.duplicate + self.again,
            ..self.before
        }
    }

    pub(super) fn samples(&self) -> &[u32] {
        &self.samples[..self.count]
    }

    /// Adds a sample; true when there are enough to see that the counter went back.
    pub(super) fn extend(&mut self, sample: u32, tally: Tally) -> bool {
        let step = self
            .count
            .checked_sub(1)
            .map(|last| sample.wrapping_sub(self.samples[last]));
        match step {
            Some(0) => {
                self.again += 1;
                return false;
            }
            Some(1..HALF) => {}
            _ => (self.count, self.again, self.before) = (0, 0, tally),
        }
        self.samples[self.count] = sample;
        self.count += 1;
        self.count == LESSON
    }
}
