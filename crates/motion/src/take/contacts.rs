//! The contacts of all samples of a take.

/// An array of samples x contacts. It is empty as long as no sample has contacts.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    width: usize,
    values: Vec<bool>,
    /// How many samples there is to be room for.
    reserved: usize,
}

impl Contacts {
    /// Contacts of a sample, when any sample has them.
    pub(super) fn width(&self) -> Option<usize> {
        (!self.values.is_empty()).then_some(self.width)
    }

    /// Makes room for so many samples in all.
    pub(super) fn reserve(&mut self, frames: usize) {
        self.reserved = frames;
        let length = self.values.len();
        self.values.reserve((frames * self.width).saturating_sub(length));
    }

    /// Adds those of the sample at a place, which is the next one; whether it has any.
    pub(super) fn push(&mut self, place: usize, contacts: &[bool]) -> bool {
        if !contacts.is_empty() {
            self.begin(place, contacts.len());
            self.values.extend_from_slice(contacts);
        } else if !self.values.is_empty() {
            self.pad(place + 1);
        }
        !contacts.is_empty()
    }

    /// Moves those of `frames` samples here, the first of which has this place.
    pub(super) fn append(&mut self, place: usize, other: &mut Self, frames: usize) {
        if !other.values.is_empty() {
            self.begin(place, other.width);
            self.values.append(&mut other.values);
        } else if !self.values.is_empty() {
            self.pad(place + frames);
        }
    }

    /// Those of a sample; nothing is touched in one that lacks them.
    pub(super) fn row(&self, place: usize) -> &[bool] {
        self.values
            .get(place * self.width..(place + 1) * self.width)
            .unwrap_or_default()
    }

    /// Makes sure that the samples before `place` have rows.
    fn begin(&mut self, place: usize, width: usize) {
        if self.values.is_empty() {
            self.width = width;
            self.values.reserve(self.reserved * width);
            self.pad(place);
        }
    }

    fn pad(&mut self, frames: usize) {
        self.values.resize(frames * self.width, false);
    }
}

impl PartialEq for Contacts {
    fn eq(&self, other: &Self) -> bool {
        (self.width(), &self.values) == (other.width(), &other.values)
    }
}
