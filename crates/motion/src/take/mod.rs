//! A recorded take.

mod contacts;
mod markers;
mod order;
mod read;
mod unused;

use crate::{Column, Error, Frame, Section, Stamp, Subject, Timecode};
use contacts::Contacts;
use markers::Markers;
pub use order::Reordered;
pub use read::Frames;
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

/// A recorded take of one subject: its samples in order, held in columns.
///
/// Each [`Section`] that any frame has is one contiguous array, a [`Column`]. A frame that is pushed reads back equal, with
/// these exceptions: its subject is the take's, and an entry of which every component is NaN reads as not tracked. Which
/// frames have which sections is remembered, so that "not sent" (an empty list) and "nothing tracked" (a list of `None`)
/// stay apart, although both are NaN in the column.
///
/// ```
/// use posewire_motion::{DVec3, Frame, Section, Skeleton, Subject, Take};
/// use std::sync::Arc;
///
/// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
/// let mut take = Take::new(subject.clone(), 240.0);
/// let mut frame = Frame::new(subject);
/// frame.position = vec![Some(DVec3::new(0.1, 0.2, 0.95)); 23];
/// take.push(&frame)?;
///
/// let positions = take.column(Section::Position).expect("a frame has positions");
/// assert_eq!(positions.shape(), [1, 23, 3]);
/// assert_eq!(positions.values()[2], 0.95);
/// assert_eq!(take.frame(0), frame);
/// # Ok::<(), posewire_motion::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Take {
    /// Who was recorded.
    pub subject: Arc<Subject>,
    /// Samples a second.
    pub rate: f64,
    samples: Vec<u32>,
    times: Vec<Duration>,
    received: Vec<Option<Stamp>>,
    timecodes: Vec<Option<Timecode>>,
    /// Per frame: a bit for each section that it has, and one for its contacts.
    present: Vec<u32>,
    /// In the order of [`Section::ALL`].
    columns: [Option<Column>; COLUMNS],
    contacts: Contacts,
    markers: Markers,
    events: Vec<(usize, String)>,
    /// How many frames a new column is to have room for.
    reserved: usize,
}

impl Take {
    /// An empty take; `rate` is in samples a second.
    pub fn new(subject: Arc<Subject>, rate: f64) -> Self {
        Self {
            subject,
            rate,
            samples: Vec::new(),
            times: Vec::new(),
            received: Vec::new(),
            timecodes: Vec::new(),
            present: Vec::new(),
            columns: [const { None }; COLUMNS],
            contacts: Contacts::default(),
            markers: Markers::default(),
            events: Vec::new(),
            reserved: 0,
        }
    }

    /// An empty take with room for `frames`: as long as no more are pushed, only the first frame that has a section
    /// allocates memory for it.
    pub fn with_capacity(subject: Arc<Subject>, rate: f64, frames: usize) -> Self {
        let mut take = Self::new(subject, rate);
        take.reserve(frames);
        take
    }

    /// Makes room for so many frames more.
    pub fn reserve(&mut self, frames: usize) {
        self.reserved = self.len() + frames;
        self.samples.reserve(frames);
        self.times.reserve(frames);
        self.received.reserve(frames);
        self.timecodes.reserve(frames);
        self.present.reserve(frames);
        for column in self.columns.iter_mut().flatten() {
            let width = column.width();
            column.values_mut().reserve(frames * width);
        }
        self.contacts.reserve(self.reserved);
    }

    /// Adds a sample at the end. Its subject is not kept; its sections must fit the take's.
    ///
    /// # Errors
    /// [`Error::SectionLength`] when a section does not fit the take's skeleton; nothing is added then.
    pub fn push(&mut self, frame: &Frame) -> Result<(), Error> {
        self.check(frame)?;
        let (place, mut present) = (self.len(), 0);
        for &section in Section::ALL {
            let entries = frame.entries(section);
            if !entries.is_empty() {
                entries.write(self.column_mut(section, entries.len()).values_mut());
                present |= bit(section);
            } else if let Some(column) = self.filled_mut(section) {
                column.pad(place + 1);
            }
        }
        if self.contacts.push(place, &frame.contacts) {
            present |= CONTACTS;
        }
        self.markers.push(place, &frame.markers);
        self.events
            .extend(frame.events.iter().map(|name| (place, name.clone())));
        self.samples.push(frame.sample);
        self.times.push(frame.time);
        self.received.push(frame.received);
        self.timecodes.push(frame.timecode);
        self.present.push(present);
        Ok(())
    }

    /// Moves the samples of another take to the end of this one. The other is empty then and keeps its memory.
    ///
    /// # Errors
    /// [`Error::SectionLength`] when one of its sections has another number of entries than here; nothing is moved then.
    pub fn append(&mut self, other: &mut Self) -> Result<(), Error> {
        self.check_columns(other)?;
        let (place, frames) = (self.len(), other.len());
        for &section in Section::ALL {
            if let Some(theirs) = other.filled_mut(section) {
                let column = self.column_mut(section, theirs.entries());
                column.values_mut().append(theirs.values_mut());
            } else if let Some(column) = self.filled_mut(section) {
                column.pad(place + frames);
            }
        }
        self.contacts.append(place, &mut other.contacts, frames);
        self.markers.append(place, &mut other.markers, frames);
        let events = other.events.drain(..);
        self.events.extend(events.map(|(frame, name)| (place + frame, name)));
        self.samples.append(&mut other.samples);
        self.times.append(&mut other.times);
        self.received.append(&mut other.received);
        self.timecodes.append(&mut other.timecodes);
        self.present.append(&mut other.present);
        Ok(())
    }

    /// A copy of the samples at these places. Sections that none of them has are absent.
    ///
    /// # Panics
    /// When the take has no such samples.
    #[must_use]
    pub fn slice(&self, places: Range<usize>) -> Self {
        let mut part = Self::with_capacity(Arc::clone(&self.subject), self.rate, places.len());
        part.samples.extend_from_slice(&self.samples[places.clone()]);
        part.times.extend_from_slice(&self.times[places.clone()]);
        part.received.extend_from_slice(&self.received[places.clone()]);
        part.timecodes.extend_from_slice(&self.timecodes[places.clone()]);
        part.present.extend_from_slice(&self.present[places.clone()]);
        let any = part.present.iter().fold(0, |any, present| any | present);
        for column in self.columns.iter().flatten() {
            if any & bit(column.section()) != 0 {
                part.columns[column.section() as usize] = Some(column.slice(places.clone()));
            }
        }
        for (to, place) in places.clone().enumerate() {
            part.contacts.push(to, self.contacts(place));
            part.markers.push(to, self.markers.of(place));
        }
        let events = self.events.iter().filter(|(place, _)| places.contains(place));
        part.events
            .extend(events.map(|(place, name)| (place - places.start, name.clone())));
        part
    }

    /// Gives every sample the numbers of a section, in the place of those it had: for what was computed from others.
    ///
    /// `values` is frames x entries x components, as in a [`Column`]; NaN where not tracked. A section for which the
    /// skeleton has no entries stays absent.
    ///
    /// # Errors
    /// [`Error::ColumnLength`] when there are more or fewer numbers.
    pub fn set_column(&mut self, section: Section, values: Vec<f64>) -> Result<(), Error> {
        let entries = section.entries(&self.subject.skeleton);
        let width = entries * section.components();
        if values.len() != self.len() * width {
            return Err(Error::ColumnLength {
                section: section.name(),
                frames: self.len(),
                width,
                expected: self.len() * width,
                found: values.len(),
            });
        }
        if values.is_empty() {
            return Ok(());
        }
        let mut column = Column::new(section, entries);
        *column.values_mut() = values;
        self.columns[section as usize] = Some(column);
        self.present.iter_mut().for_each(|present| *present |= bit(section));
        Ok(())
    }

    /// Takes a section out of every sample, and gives its column.
    pub fn remove_column(&mut self, section: Section) -> Option<Column> {
        self.present.iter_mut().for_each(|present| *present &= !bit(section));
        let column = self.columns[section as usize].take();
        column.filter(|column| !column.values().is_empty())
    }

    fn check(&self, frame: &Frame) -> Result<(), Error> {
        let wrong = |section, expected, found| Error::SectionLength {
            section,
            sample: frame.sample,
            expected,
            found,
        };
        for &section in Section::ALL {
            let (expected, found) = (self.entries(section), frame.entries(section).len());
            if found != 0 && found != expected {
                return Err(wrong(section.name(), expected, found));
            }
        }
        let (expected, found) = (self.contact_count(), frame.contacts.len());
        if found != 0 && found != expected {
            return Err(wrong("contacts", expected, found));
        }
        Ok(())
    }

    fn check_columns(&self, other: &Self) -> Result<(), Error> {
        let sample = other.samples.first().copied().unwrap_or_default();
        let sections = other.sections().map(|section| {
            let found = other.entries(section);
            (section.name(), self.entries(section), found)
        });
        let contacts = other.contacts.width();
        let contacts = contacts.map(|found| ("contacts", self.contact_count(), found));
        let wrong = sections.chain(contacts).find(|(_, expected, found)| expected != found);
        wrong.map_or(Ok(()), |(section, expected, found)| {
            Err(Error::SectionLength {
                section,
                sample,
                expected,
                found,
            })
        })
    }

    /// Entries of a section: as its column has them, so that another subject does no harm.
    fn entries(&self, section: Section) -> usize {
        let column = self.column(section).map(Column::entries);
        column.unwrap_or_else(|| section.entries(&self.subject.skeleton))
    }

    fn contact_count(&self) -> usize {
        self.contacts.width().unwrap_or(self.subject.skeleton.contacts.len())
    }

    /// The column of a section, which has rows for all samples so far.
    fn column_mut(&mut self, section: Section, entries: usize) -> &mut Column {
        let (frames, reserved) = (self.len(), self.reserved);
        let slot = &mut self.columns[section as usize];
        if slot.as_ref().is_none_or(|column| column.entries() != entries) {
            let mut column = Column::new(section, entries);
            let width = column.width();
            column.values_mut().reserve(reserved * width);
            *slot = Some(column);
        }
        let column = slot.get_or_insert_with(|| Column::new(section, entries));
        if column.values().is_empty() {
            column.pad(frames);
        }
        column
    }

    /// A column that any sample has. One without rows is memory only.
    fn filled_mut(&mut self, section: Section) -> Option<&mut Column> {
        let column = self.columns[section as usize].as_mut();
        column.filter(|column| !column.values().is_empty())
    }
}

impl PartialEq for Take {
    /// Compares what was recorded, not the memory reserved; not tracked equals not tracked.
    fn eq(&self, other: &Self) -> bool {
        self.subject == other.subject
            && self.rate.to_bits() == other.rate.to_bits()
            && (&self.samples, &self.times) == (&other.samples, &other.times)
            && (&self.received, &self.timecodes) == (&other.received, &other.timecodes)
            && (&self.present, &self.contacts) == (&other.present, &other.contacts)
            && (&self.markers, &self.events) == (&other.markers, &other.events)
            && Section::ALL
                .iter()
                .all(|&section| self.column(section) == other.column(section))
    }
}

const fn bit(section: Section) -> u32 {
    1 << section as u32
}

const COLUMNS: usize = Section::ALL.len();
/// The bit of a sample that has contacts.
const CONTACTS: u32 = 1 << COLUMNS;
