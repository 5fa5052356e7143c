//! Steps in a row that tell of a new stride.

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
