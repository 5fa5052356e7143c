//! What a take tells: columns, and frames made of them.

use super::{CONTACTS, Take, bit};
use crate::time::seconds;
use crate::{Column, Frame, Marker, Section, Timecode};
use std::iter::FusedIterator;
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

impl Take {
    /// How many samples there are.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Per frame: the source's number of the sample.
    pub fn samples(&self) -> &[u32] {
        &self.samples
    }

    /// Per frame: the source's clock.
    pub fn times(&self) -> &[Duration] {
        &self.times
    }

    /// Per frame: the source's clock in seconds, as the numbers nearest to it. Whole milliseconds are what they are divided by 1000.
    pub fn seconds(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.times.iter().copied().map(seconds)
    }

    /// Per frame: the time of day, UTC, where the source says.
    pub fn timecodes(&self) -> &[Option<Timecode>] {
        &self.timecodes
    }

    /// The sections that any frame has, in the order of [`Section::ALL`].
    pub fn sections(&self) -> impl Iterator<Item = Section> {
        let sections = Section::ALL.iter().copied();
        sections.filter(|&section| self.column(section).is_some())
    }

    /// A section of all frames; `None` when no frame has it.
    pub fn column(&self, section: Section) -> Option<&Column> {
        let column = self.columns[section as usize].as_ref();
        column.filter(|column| !column.values().is_empty())
    }

    /// Whether the frame at a place has a section, be it that none of it is tracked.
    ///
    /// # Panics
    /// When the take has no such frame.
    pub fn has(&self, frame: usize, section: Section) -> bool {
        self.present[frame] & bit(section) != 0
    }

    /// Per contact of the skeleton: whether it touches the ground in the frame at a place. Empty when the frame does not
    /// say.
    ///
    /// # Panics
    /// When the take has no such frame.
    pub fn contacts(&self, frame: usize) -> &[bool] {
        if self.present[frame] & CONTACTS == 0 {
            return &[];
        }
        self.contacts.row(frame)
    }

    /// The points that the source sent on their own with the frame at a place.
    ///
    /// # Panics
    /// When the take has no such frame.
    pub fn markers(&self, frame: usize) -> &[Marker] {
        assert!(frame < self.len(), "the take has no frame {frame}");
        self.markers.of(frame)
    }

    /// Names of events that the operator set, each with the place of its frame, in the order of the frames.
    pub fn events(&self) -> &[(usize, String)] {
        &self.events
    }

    /// The frame at a place.
    ///
    /// # Panics
    /// When the take has no such frame.
    pub fn frame(&self, place: usize) -> Frame {
        let mut frame = Frame::new(Arc::clone(&self.subject));
        self.read_frame(place, &mut frame);
        frame
    }

    /// Makes `frame` the one at a place. Its lists keep their memory.
    ///
    /// # Panics
    /// When the take has no such frame.
    pub fn read_frame(&self, place: usize, frame: &mut Frame) {
        frame.clear();
        if !Arc::ptr_eq(&frame.subject, &self.subject) {
            frame.subject = Arc::clone(&self.subject);
        }
        frame.sample = self.samples[place];
        frame.time = self.times[place];
        frame.received = self.received[place];
        frame.timecode = self.timecodes[place];
        for column in self.columns.iter().flatten() {
            if self.has(place, column.section()) {
                frame.set_entries(column.section(), column.row(place));
            }
        }
        frame.contacts.extend_from_slice(self.contacts(place));
        frame.markers.extend_from_slice(self.markers(place));
        let first = self.events.partition_point(|(at, _)| *at < place);
        let events = self.events[first..].iter().take_while(|(at, _)| *at == place);
        frame.events.extend(events.map(|(_, name)| name.clone()));
    }

    /// The frames in order, each made anew; [`read_frame`](Self::read_frame) uses the memory of one again.
    pub fn frames(&self) -> Frames<'_> {
        let places = 0..self.len();
        Frames { take: self, places }
    }
}

/// The frames of a [`Take`] in order.
#[derive(Clone, Debug)]
pub struct Frames<'a> {
    take: &'a Take,
    places: Range<usize>,
}

impl Iterator for Frames<'_> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        self.places.next().map(|place| self.take.frame(place))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.places.size_hint()
    }
}

impl DoubleEndedIterator for Frames<'_> {
    fn next_back(&mut self) -> Option<Frame> {
        self.places.next_back().map(|place| self.take.frame(place))
    }
}

impl ExactSizeIterator for Frames<'_> {}

impl FusedIterator for Frames<'_> {}
