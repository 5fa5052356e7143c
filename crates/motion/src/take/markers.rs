//! The markers of all samples of a take.

use crate::Marker;

/// As many markers for each sample as it has, side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Markers {
    markers: Vec<Marker>,
    /// Per sample: where its markers end. Empty as long as no sample has markers.
    ends: Vec<usize>,
}

impl Markers {
    /// Adds those of the sample at a place, which is the next one.
    pub(super) fn push(&mut self, place: usize, markers: &[Marker]) {
        if markers.is_empty() && self.ends.is_empty() {
            return;
        }
        self.ends.resize(place, self.markers.len());
        self.markers.extend_from_slice(markers);
        self.ends.push(self.markers.len());
    }

    /// Moves those of `frames` samples here, the first of which has this place.
    pub(super) fn append(&mut self, place: usize, other: &mut Self, frames: usize) {
        if other.ends.is_empty() && self.ends.is_empty() {
            return;
        }
        let before = self.markers.len();
        self.ends.resize(place, before);
        self.ends.extend(other.ends.drain(..).map(|end| before + end));
        self.markers.append(&mut other.markers);
        self.ends.resize(place + frames, self.markers.len());
    }

    /// Those of the sample at a place.
    pub(super) fn of(&self, place: usize) -> &[Marker] {
        let Some(&end) = self.ends.get(place) else { return &[] };
        let begin = place.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.markers[begin..end]
    }
}
