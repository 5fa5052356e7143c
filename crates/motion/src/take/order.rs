//! Samples put in the order of their numbers.

use super::Take;
use crate::Frame;
use std::sync::Arc;

/// What [`Take::put_in_order`] found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reordered {
    /// How many samples stood behind one of a higher number.
    pub moved: usize,
    /// How many samples were there already, equal in everything but the time of receipt. They are left out.
    pub doubles: usize,
    /// How many samples have the number of another, but another content. When there is any, nothing was changed: the
    /// numbers may have begun anew, and then they tell no order.
    pub conflicts: usize,
}

impl Reordered {
    /// Whether all samples were in order, no number twice.
    pub fn is_nothing(self) -> bool {
        self == Self::default()
    }
}

impl Take {
    /// Puts the samples in the order of their numbers and leaves doubles out, so that a sample's place tells its time.
    ///
    /// ```
    /// use posewire_motion::{Frame, Skeleton, Subject, Take};
    /// use std::sync::Arc;
    ///
    /// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
    /// let mut take = Take::new(subject.clone(), 240.0);
    /// for sample in [0, 2, 1, 3, 3] {
    ///     take.push(&Frame { sample, ..Frame::new(subject.clone()) })?;
    /// }
    /// let reordered = take.put_in_order();
    /// assert_eq!(take.samples(), [0, 1, 2, 3]);
    /// assert_eq!((reordered.moved, reordered.doubles), (1, 1));
    /// # Ok::<(), posewire_motion::Error>(())
    /// ```
    pub fn put_in_order(&mut self) -> Reordered {
        if self.samples.is_sorted_by(|a, b| a < b) {
            return Reordered::default();
        }
        let mut places: Vec<_> = (0..self.len()).collect();
        places.sort_by_key(|&place| self.samples[place]);
        let (mut doubled, mut conflicts) = (vec![false; self.len()], 0);
        for same in places.chunk_by(|&a, &b| self.samples[a] == self.samples[b]) {
            let first = self.content(same[0]);
            for &place in &same[1..] {
                doubled[place] = self.content(place) == first;
                conflicts += usize::from(!doubled[place]);
            }
        }
        let reordered = Reordered {
            moved: self.behind_higher(&doubled),
            doubles: doubled.iter().filter(|doubled| **doubled).count(),
            conflicts,
        };
        if conflicts == 0 {
            places.retain(|&place| !doubled[place]);
            *self = self.at_places(&places);
        }
        reordered
    }

    /// The frame at a place without the time of its receipt.
    fn content(&self, place: usize) -> Frame {
        let received = None;
        Frame {
            received,
            ..self.frame(place)
        }
    }

    /// How many samples stand behind one of a higher number, doubles not counted.
    fn behind_higher(&self, doubled: &[bool]) -> usize {
        let mut highest = 0;
        let late = self.samples.iter().zip(doubled).filter(|&(&sample, doubled)| {
            let is_late = sample < highest && !doubled;
            highest = highest.max(sample);
            is_late
        });
        late.count()
    }

    /// A take of the samples at these places.
    fn at_places(&self, places: &[usize]) -> Self {
        let mut take = Self::with_capacity(Arc::clone(&self.subject), self.rate, places.len());
        let mut frame = Frame::new(Arc::clone(&self.subject));
        for &place in places {
            self.read_frame(place, &mut frame);
            // It came out of a take with the same columns.
            let _ = take.push(&frame);
        }
        take
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DVec3, Skeleton, Stamp, Subject};

    /// Samples of these numbers at these places along X.
    fn take(samples: &[(u32, f64)]) -> Take {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        for (received, &(sample, x)) in samples.iter().enumerate() {
            let mut frame = Frame::new(Arc::clone(&subject));
            frame.sample = sample;
            frame.received = Some(Stamp(received as i64));
            frame.position = vec![Some(DVec3::X * x); 23];
            frame.events = vec![format!("at {sample}")];
            take.push(&frame).unwrap();
        }
        take
    }

    #[test]
    fn late_samples_go_to_their_places_with_all_they_have() {
        let mut found = take(&[(4, 4.0), (6, 6.0), (5, 5.0), (7, 7.0), (6, 6.0), (3, 3.0)]);
        let reordered = found.put_in_order();
        assert_eq!(
            reordered,
            Reordered {
                moved: 2,
                doubles: 1,
                conflicts: 0
            }
        );
        assert_eq!(found.samples(), [3, 4, 5, 6, 7]);
        let event = |place: usize| found.events()[place].1.as_str();
        assert_eq!((event(0), event(2)), ("at 3", "at 5"));
        assert_eq!(found.frame(2).position[0], Some(DVec3::X * 5.0));
        assert!(found.put_in_order().is_nothing());
    }

    #[test]
    fn numbers_that_begin_anew_tell_no_order() {
        let mut found = take(&[(0, 0.0), (1, 1.0), (0, 5.0), (1, 6.0)]);
        let as_it_was = found.clone();
        assert_eq!(found.put_in_order().conflicts, 2);
        assert_eq!(found, as_it_was);
    }
}
