//! All that stands around the frames of a file.

use crate::header::Header;
use crate::input::MAX_PIECE;
use crate::markup::{Kind, Markup, Piece};
use crate::xml::Xml;
use crate::{Calibration, Error, Place, Version};
use posewire_motion::Subject;
use std::io::BufRead;
use std::sync::Arc;

/// All that stands around the frames of a file, so that a [`Writer`](crate::Writer) can write it again: the definitions, the
/// poses of calibration, and every attribute, comment and unknown element in its place.
///
/// It comes from a file by [`Reader::document`](crate::Reader::document), or from a subject of any other source by
/// [`Document::describe`].
#[derive(Clone, Debug)]
pub struct Document {
    pub(crate) header: Header,
    pub(crate) subject: Arc<Subject>,
    pub(crate) calibration: Vec<Calibration>,
    pub(crate) around: Around,
}

impl Document {
    /// What the file says, unconverted.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The version of the format that the file is, or was described for.
    pub fn version(&self) -> Version {
        if self.header.version == 3 {
            Version::V3
        } else {
            Version::V4
        }
    }

    /// Whose motion it is, in the canonical convention.
    pub fn subject(&self) -> &Arc<Subject> {
        &self.subject
    }

    /// Says that the frames come at another rate, samples a second, than those that were read.
    ///
    /// # Errors
    /// [`Error::Value`] when no file can have this rate; nothing changes then.
    pub fn set_rate(&mut self, rate: f64) -> Result<(), Error> {
        if !(0.001..1e6).contains(&rate) {
            return Err(Error::Value {
                at: Place { line: 1, offset: 0 },
                what: "subject frameRate",
                expected: "samples a second",
                found: rate.to_string(),
            });
        }
        let value = rate.to_string();
        self.around.head = self.around.head.with_attribute("subject", "frameRate", &value);
        let attributes = &mut self.header.subject;
        match attributes.iter_mut().find(|(name, _)| name == "frameRate") {
            Some((_, old)) => *old = value,
            None => attributes.push(("frameRate".to_owned(), value)),
        }
        Arc::make_mut(&mut self.subject).rate = Some(rate);
        Ok(())
    }

    /// The poses of calibration.
    pub fn calibration(&self) -> &[Calibration] {
        &self.calibration
    }
}

/// The markup of a file before its first normal frame and behind its last one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Around {
    /// Ends within `<frames>`.
    pub(crate) head: Markup,
    /// Begins within `<frames>`; empty until the file is read to its end.
    pub(crate) tail: Markup,
    /// Milliseconds of UTC since 1970 at which the day of the first frame began.
    pub(crate) midnight: Option<u64>,
}

impl Around {
    /// Begins to keep what is read.
    pub(crate) fn begin<R: BufRead>(xml: &mut Xml<R>) {
        xml.record(Markup::new(MAX_AROUND));
    }

    /// Ends the head. The reader stands on the start tag of a frame, or on the end tag of the frames.
    pub(crate) fn of_head<R: BufRead>(xml: &mut Xml<R>, on_frame: bool) -> Self {
        let mut head = xml.recorded().unwrap_or_default();
        head.take_back(if on_frame { Kind::Start } else { Kind::End });
        Self {
            head,
            tail: Markup::default(),
            midnight: on_frame.then(|| midnight(xml.tag())).flatten(),
        }
    }

    /// Begins the tail. The reader stands on the end tag of the frames.
    pub(crate) fn begin_tail<R: BufRead>(xml: &mut Xml<R>) {
        let tail = xml.recorded().unwrap_or_else(|| {
            let mut tail = Markup::new(MAX_AROUND);
            tail.push(Kind::End, "");
            tail
        });
        xml.record(tail);
    }

    /// Ends the tail with the file.
    pub(crate) fn end_tail<R: BufRead>(&mut self, xml: &mut Xml<R>) {
        self.tail = xml.recorded().unwrap_or_default();
    }
}

/// When the day began on which the frame of this start tag was recorded.
fn midnight(tag: &str) -> Option<u64> {
    let milliseconds: u64 = Piece::start(tag).attribute("ms")?.trim().parse().ok()?;
    (milliseconds > 0).then(|| milliseconds - milliseconds % MILLISECONDS_PER_DAY)
}

pub(crate) const MILLISECONDS_PER_DAY: u64 = 86_400_000;
/// More than the reader's own bound of the head.
const MAX_AROUND: usize = 32 * MAX_PIECE;
