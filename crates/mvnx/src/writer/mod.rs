//! The streaming writer.

mod escape;
mod fixed;
mod left_out;
mod numbers;
mod piece;
mod poses;
mod printer;
mod tag;
mod version;

pub(crate) use escape::{attribute, text};
pub use left_out::{LeftOut, Reason};
pub(crate) use piece::ONLY_IN_4;
pub(crate) use poses::{Poses, write_poses};
pub(crate) use printer::{Printer, Style};
pub(crate) use tag::clock;
pub use version::Version;

use crate::markup::{Kind, Piece, Pieces};
use crate::section::{Layout, Section};
use crate::{Document, Error, Remainder};
use left_out::Omissions;
use numbers::{Found, Numbers, check};
use posewire_motion::{DQuat, Frame, Skeleton};
use std::fmt;
use std::io::Write;
use tag::Tags;

/// Writes an MVNX file of version 3 or 4 in MVN's own layout, frame by frame: tabs, one element a line, six decimals.
///
/// What [`Reader::read_whole`](crate::Reader::read_whole) gave is written as it stood, so that a file of MVN's comes out
/// byte for byte. In the other version than the document's, the arms' axes, the poses of calibration and the points'
/// elements become those of that version, and what it has no place for is left out and told by
/// [`finish`](Self::finish). Sections of sensors that MVN writes in version 3 only are kept in version 4: readers find
/// sections by their names, and so nothing is lost on the way there and back.
///
/// Memory does not grow with the length of the file. Writes of the destination are of 64 KiB and more.
///
/// ```
/// use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
/// use posewire_mvnx::{Document, Version, Writer};
/// use std::sync::Arc;
///
/// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
/// let document = Document::describe(&subject, 240.0, Version::V4)?;
/// let mut writer = Writer::new(Vec::new(), &document, Version::V4)?;
/// let mut frame = Frame::new(subject);
/// frame.orientation = vec![Some(DQuat::IDENTITY); 23];
/// frame.position = vec![Some(DVec3::new(0.1, 0.2, 0.95)); 23];
/// writer.write(&frame)?;
/// let (file, left_out) = writer.finish(&document)?;
///
/// assert!(left_out.is_empty());
/// assert_eq!(posewire_mvnx::Reader::new(&file[..])?.count(), 1);
/// # Ok::<(), posewire_mvnx::Error>(())
/// ```
pub struct Writer<W> {
    printer: Printer<W>,
    numbers: Numbers,
    version: Version,
    /// Whether the document is of the other version.
    converts: bool,
    /// Whether MVN's code for the file does not hold for what is written.
    changed: bool,
    tags: Tags,
    left_out: Omissions,
    frames: u64,
}

impl<W: Write> Writer<W> {
    /// Writes what stands before the first normal frame.
    ///
    /// # Errors
    /// [`Error::Write`] when the destination fails.
    pub fn new(to: W, document: &Document, version: Version) -> Result<Self, Error> {
        let skeleton = &document.subject.skeleton;
        let mut writer = Self {
            printer: Printer::new(to),
            numbers: Numbers::new(Layout::new(&document.header), turns(skeleton, version)),
            version,
            converts: document.version() != version,
            changed: document.version() != version,
            tags: Tags::new(document),
            left_out: Omissions::default(),
            frames: 0,
        };
        writer.write_markup(&document.around.head)?;
        if writer.converts {
            writer.write_converted_poses(document)?;
        }
        Ok(writer)
    }

    /// Says that the frames are not those of the document's file: fewer, or with other numbers. MVN's code for that file,
    /// `securityCode`, is left empty then, and told by [`finish`](Self::finish).
    pub fn frames_changed(&mut self) {
        self.changed = true;
    }

    /// Writes a frame of any source. Its attributes follow from its sample number and times.
    ///
    /// A section of which not all is tracked is left out of the frame, and a frame without the position and orientation
    /// of every segment of the body is left out of the file: the format has no word for what is not known.
    ///
    /// # Errors
    /// [`Error::Misfit`] when a section has another number of entries than the document defines, before anything is
    /// written of the frame; [`Error::Write`] when the destination fails.
    pub fn write(&mut self, frame: &Frame) -> Result<(), Error> {
        check(frame, &self.numbers.layout, self.version)?;
        let tag = self.tags.of(frame);
        if self.begin_frame(frame, &tag) {
            self.end_frame(frame, 0, 0)?;
        }
        Ok(())
    }

    /// Writes a frame with all that stood in the file that it was read from, in the same order: with its attributes as they
    /// were, its comments and unknown elements, and what stood before it.
    ///
    /// Sections that the frame has no more are left out, those that were added to it stand behind the others.
    ///
    /// # Errors
    /// Those of [`write`](Self::write).
    pub fn write_whole(&mut self, frame: &Frame, remainder: &Remainder) -> Result<(), Error> {
        check(frame, &self.numbers.layout, self.version)?;
        self.left_out.too_large(&remainder.markup);
        let mut pieces = remainder.markup.pieces();
        while pieces.place() < remainder.frame
            && let Some(piece) = pieces.next()
        {
            self.write_piece(piece, &mut pieces)?;
        }
        match pieces.next() {
            Some(tag) if tag.kind == Kind::Start => {
                if self.begin_frame(frame, tag.text) {
                    self.write_content(frame, remainder, pieces)?;
                }
                Ok(())
            }
            _ => self.write(frame),
        }
    }

    /// Writes what stands behind the frames, hands on all that is not yet written, and gives the destination back with
    /// a list of what the file does not hold.
    ///
    /// The document is the one that the writer began with, or the same one read to its end.
    ///
    /// # Errors
    /// [`Error::Write`] when the destination fails. The file is not whole then, and neither is that of a writer which
    /// never got here.
    pub fn finish(mut self, document: &Document) -> Result<(W, Vec<LeftOut>), Error> {
        self.write_markup(&document.around.tail)?;
        while self.printer.depth() > 0 {
            self.printer.end()?;
        }
        Ok((self.printer.finish()?, self.left_out.into_list()))
    }

    /// Begins a frame that the format can hold; tells of another.
    fn begin_frame(&mut self, frame: &Frame, tag: &str) -> bool {
        let mandatory = [Section::Orientation, Section::Position];
        let whole = mandatory
            .into_iter()
            .all(|section| matches!(self.numbers.of(frame, section), Found::All(_)));
        self.frames += 1;
        if whole {
            self.printer.start(tag, Style::Lines);
            self.left_out.no_place(frame, &self.numbers.layout);
        } else {
            self.left_out.add("frame", Reason::Untracked);
        }
        whole
    }

    /// Writes the elements of a frame in the order that they were read in, and its end.
    fn write_content(&mut self, frame: &Frame, remainder: &Remainder, mut pieces: Pieces<'_>) -> Result<(), Error> {
        let inside = self.printer.depth();
        let (mut written, mut events) = (0, 0);
        while let Some(piece) = pieces.next() {
            let child = self.printer.depth() == inside;
            match piece.kind {
                Kind::End | Kind::EndOfEmpty if child => break,
                Kind::Start if child && piece.name() == "marker" => {
                    self.write_marker(piece, &mut pieces, frame.events.get(events))?;
                    events += 1;
                }
                Kind::Start if child && let Some(section) = self.numbers.layout.section(piece.name()) => {
                    pieces.skip_element();
                    written |= section.bit();
                    self.write_section(piece.text, section, frame, Some(remainder))?;
                }
                _ => self.write_piece(piece, &mut pieces)?,
            }
        }
        self.end_frame(frame, written, events)
    }

    /// Writes the sections and events of a frame that are not yet written, and its end.
    fn end_frame(&mut self, frame: &Frame, written: u32, events: usize) -> Result<(), Error> {
        for section in Section::all().filter(|section| written & section.bit() == 0) {
            self.write_section(section.name(), section, frame, None)?;
        }
        for event in frame.events.iter().skip(events) {
            self.printer.leaf("marker", |to| text(to, event))?;
        }
        self.printer.end()
    }

    /// Writes a section as far as the frame and the version have it; `file` is where it was read from.
    fn write_section(
        &mut self,
        tag: &str,
        section: Section,
        frame: &Frame,
        file: Option<&Remainder>,
    ) -> Result<(), Error> {
        let as_it_was = file.filter(|_| !self.converts);
        let reason = match self.numbers.of(frame, section) {
            Found::None => return Ok(()),
            Found::All(_) if as_it_was.is_none() && !section.is_in(self.version) => Reason::Version(self.version),
            Found::All(numbers) => {
                let zeros = as_it_was.into_iter().flat_map(|file| &file.negative_zeros);
                for &(_, place) in zeros.filter(|zero| zero.0 == section) {
                    restore_negative_zero(numbers.get_mut(place));
                }
                return self.printer.numbers(tag, section, numbers);
            }
            Found::Part => Reason::Untracked,
        };
        self.left_out.add(section.name(), reason);
        Ok(())
    }

    /// Writes an event: as it stood when the frame still has it so.
    fn write_marker(&mut self, tag: Piece<'_>, pieces: &mut Pieces<'_>, event: Option<&String>) -> Result<(), Error> {
        let mut content = pieces.clone();
        pieces.skip_element();
        let Some(event) = event else { return Ok(()) };
        if content.text_content().as_deref().map(str::trim) != Some(event) {
            return self.printer.leaf(tag.text, |to| text(to, event));
        }
        self.write_piece(tag, &mut content)?;
        while content.place() < pieces.place()
            && let Some(piece) = content.next()
        {
            self.write_piece(piece, &mut content)?;
        }
        Ok(())
    }
}

impl<W> fmt::Debug for Writer<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Writer")
            .field("version", &self.version)
            .field("frames", &self.frames)
            .field("left_out", &self.left_out)
            .finish_non_exhaustive()
    }
}

/// What turns canonical orientations to those of this version.
fn turns(skeleton: &Skeleton, version: Version) -> Vec<(usize, DQuat)> {
    let segments = skeleton.segments.iter().enumerate();
    let turned = segments.filter(|(_, segment)| version == Version::V3 && segment.isb != DQuat::IDENTITY);
    turned.map(|(place, segment)| (place, segment.isb)).collect()
}

fn restore_negative_zero(number: Option<&mut f64>) {
    if let Some(number) = number.filter(|number| number.abs() < 5e-7) {
        *number = -0.0;
    }
}

impl Section {
    /// Whether a version has a place for it.
    fn is_in(self, version: Version) -> bool {
        version == Version::V4 || !matches!(self, Self::FootContacts | Self::SensorFreeAcceleration)
    }
}
