//! One section of a whole take.

use crate::Section;
use glam::{DQuat, DVec3};
use std::ops::Range;

/// One section of a whole take: an array of frames x entries x components, row-major.
///
/// An entry is a segment, joint, angle or sensor, as [`Section::per`] says; its components are those of
/// [`Section::axes`], in the units of [`Section::unit`]. An entry that is not tracked has NaN in all its components, and so
/// has every entry of a frame that lacks the section.
#[derive(Clone, Debug)]
pub struct Column {
    section: Section,
    entries: usize,
    values: Vec<f64>,
}

impl Column {
    /// A column without frames; `entries` is at least 1.
    pub(crate) fn new(section: Section, entries: usize) -> Self {
        let values = Vec::new();
        Self {
            section,
            entries,
            values,
        }
    }

    /// What it holds.
    pub fn section(&self) -> Section {
        self.section
    }

    /// How many frames, entries of a frame, and components of an entry it has.
    pub fn shape(&self) -> [usize; 3] {
        [
            self.values.len() / self.width(),
            self.entries,
            self.section.components(),
        ]
    }

    /// All its numbers: those of a frame side by side, in it those of an entry.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The numbers of the frame at a place of the take.
    ///
    /// # Panics
    /// When the take has no such frame.
    pub fn row(&self, frame: usize) -> &[f64] {
        &self.values[frame * self.width()..][..self.width()]
    }

    /// The numbers of each frame.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.width())
    }

    /// The vector of an entry of a frame; `None` when it is not tracked, and when the column holds quaternions or has no
    /// such frame or entry.
    pub fn vector(&self, frame: usize, entry: usize) -> Option<DVec3> {
        vector(self.entry(frame, entry)?)
    }

    /// The quaternion of an entry of a frame; `None` when it is not tracked, and when the column holds vectors or has no
    /// such frame or entry.
    pub fn quaternion(&self, frame: usize, entry: usize) -> Option<DQuat> {
        quaternion(self.entry(frame, entry)?)
    }

    /// A copy of the rows at these places.
    pub(crate) fn slice(&self, places: Range<usize>) -> Self {
        let width = self.width();
        Self {
            values: self.values[places.start * width..places.end * width].to_vec(),
            ..*self
        }
    }

    fn entry(&self, frame: usize, entry: usize) -> Option<&[f64]> {
        let components = self.section.components();
        let row = self.rows().nth(frame)?;
        row.chunks_exact(components).nth(entry)
    }

    /// Numbers of a frame.
    pub(crate) fn width(&self) -> usize {
        self.entries * self.section.components()
    }

    /// Entries of a frame.
    pub(crate) fn entries(&self) -> usize {
        self.entries
    }

    /// The numbers, to which only whole rows may be added.
    pub(crate) fn values_mut(&mut self) -> &mut Vec<f64> {
        &mut self.values
    }

    /// Adds frames that lack the section until there are `frames`.
    pub(crate) fn pad(&mut self, frames: usize) {
        self.values.resize(frames * self.width(), f64::NAN);
    }
}

impl PartialEq for Column {
    /// Not tracked equals not tracked.
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&f64, &f64)| a == b || (a.is_nan() && b.is_nan());
        (self.section, self.entries, self.values.len()) == (other.section, other.entries, other.values.len())
            && self.values.iter().zip(&other.values).all(same)
    }
}

/// The vector of an entry, when there are three numbers and not all are NaN.
pub(crate) fn vector(entry: &[f64]) -> Option<DVec3> {
    let vector = DVec3::from_array(entry.try_into().ok()?);
    (!vector.is_nan_mask().all()).then_some(vector)
}

/// The quaternion of an entry, when there are four numbers and not all are NaN.
pub(crate) fn quaternion(entry: &[f64]) -> Option<DQuat> {
    let [w, x, y, z] = entry.try_into().ok()?;
    let tracked = !(w.is_nan() && x.is_nan() && y.is_nan() && z.is_nan());
    tracked.then(|| DQuat::from_xyzw(x, y, z, w))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_an_array_of_frames_entries_and_components() {
        let mut column = Column::new(Section::Orientation, 2);
        column.values_mut().extend([1.0, 0.0, 0.0, 0.0, 0.5, 0.5, -0.5, 0.5]);
        column.pad(2);
        assert_eq!(column.shape(), [2, 2, 4]);
        assert_eq!(column.row(0)[4..], [0.5, 0.5, -0.5, 0.5]);
        assert_eq!(column.quaternion(0, 1), Some(DQuat::from_xyzw(0.5, -0.5, 0.5, 0.5)));
        assert_eq!(column.quaternion(1, 1), None, "not tracked");
        assert_eq!((column.quaternion(0, 2), column.quaternion(2, 0)), (None, None));
        assert_eq!(column.vector(0, 0), None, "no vectors");
        assert_eq!(column, column.clone());
    }

    #[test]
    fn a_vector_that_is_partly_not_a_number_is_kept() {
        assert!(vector(&[f64::NAN, 1.0, 2.0]).is_some());
        assert_eq!(vector(&[f64::NAN; 3]), None);
    }
}
