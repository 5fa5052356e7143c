//! The streaming reader.

mod blocks;
mod parallel;
mod take;
mod whole;

use crate::calibration::{Calibration, CalibrationKind, read_calibration};
use crate::document::Around;
use crate::error::clip;
use crate::frame::{FrameReader, FrameTag};
use crate::head::{keep_unknown, read_head, read_tail};
use crate::header::Header;
use crate::input::Input;
use crate::section::Layout;
use crate::sections::SectionInfo;
use crate::skeleton::build_subject;
use crate::xml::Xml;
use crate::{Error, Place};
use posewire_motion::{DQuat, Frame, Subject};
use std::fmt;
use std::io::BufRead;
use std::sync::Arc;
pub use take::read_take;

/// Reads an MVNX file of version 3 or 4, plain or gzip-compressed, frame by frame.
///
/// It is an iterator of the file's normal frames in their order, in the canonical convention of [`posewire_motion`]:
/// metres, radians, every orientation the identity in the T-pose, whatever the version of the file. Memory does not grow
/// with the length of the file. The first error ends the iteration.
///
/// | of a frame | is |
/// |---|---|
/// | `sample` | the attribute `index`, or the number of normal frames before when there is none |
/// | `time` | the attribute `time`, whole milliseconds that jitter; `sample` over the frame rate when there is none |
/// | `timecode` | the time of day of `ms`, or `tc` when there is no `ms` |
/// | `events` | the texts of its `marker` elements |
pub struct Reader<R> {
    xml: Xml<R>,
    header: Header,
    subject: Arc<Subject>,
    layout: Layout,
    calibration: Vec<Calibration>,
    frames: FrameReader,
    counts: FrameCounts,
    salvage: bool,
    /// How many threads [`read_take`] uses; as many as there are cores when it is 0.
    threads: usize,
    damage: Option<Error>,
    state: State,
    /// What stands around the frames, to be written again.
    around: Around,
}

/// How many frames of each type were read so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameCounts {
    /// Frames of the recording, which the iterator gives.
    pub normal: u64,
    /// Poses of calibration.
    pub calibration: u64,
    /// Frames of types that this crate does not know, which are passed over: up to 16 types and the count of each.
    pub skipped: Vec<(String, u64)>,
}

/// Where the reader stands.
enum State {
    /// On the start tag of a frame, which was read already.
    Tag(FrameTag),
    /// Between two frames.
    Between,
    /// Behind the last frame that can be read.
    Done,
}

impl<R: BufRead> Reader<R> {
    /// Reads what stands before the first normal frame.
    ///
    /// # Errors
    /// When the bytes are not MVNX of version 3 or 4, when they end too early, or when a definition is missing or makes
    /// no sense.
    pub fn new(bytes: R) -> Result<Self, Error> {
        let mut xml = Xml::new(Input::new(bytes)?);
        Around::begin(&mut xml);
        let mut header = read_head(&mut xml)?;
        let layout = Layout::new(&header);
        let (mut calibration, mut counts) = (Vec::new(), FrameCounts::default());
        let state = read_calibrations(&mut xml, &mut header, &layout, &mut calibration, &mut counts)?;
        let subject = Arc::new(build_subject(&header, &calibration)?);
        let frames = FrameReader::new(layout, corrections(&header, &subject));
        let around = Around::of_head(&mut xml, matches!(state, State::Tag(_)));
        let mut reader = Self {
            xml,
            header,
            subject,
            layout,
            calibration,
            frames,
            counts,
            salvage: false,
            threads: 0,
            damage: None,
            state,
            around,
        };
        if matches!(reader.state, State::Done) {
            reader.read_tail()?;
        }
        Ok(reader)
    }

    /// Whether damage ends the iteration after the last whole frame instead of giving an error.
    ///
    /// [`damage`](Self::damage) then tells of it. Damage before the first frame is always an error.
    #[must_use]
    pub fn salvage(mut self, salvage: bool) -> Self {
        self.salvage = salvage;
        self
    }

    /// How many threads [`read_take`] uses, 8 at most; with 0, which is the usual, one for each core. The result is the
    /// same with any number.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// What stands in the file around its frames.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Whose motion it is.
    ///
    /// Points have their place in the segment's list as id, from 1. Finger segments and finger joints stand behind those
    /// of the body, left before right. Origins come from the `identity` or `npose` frame; those that it does not give follow from
    /// the connectors of the joints, which meet in the null pose, and stay `None` where these do not tell.
    /// A joint whose connector names an undefined point has point 0 there. It has no tags: what else a file
    /// says of its subject, the recorder's folders among it, is in the [`header`](Self::header) and is not to be sent on.
    pub fn subject(&self) -> &Arc<Subject> {
        &self.subject
    }

    /// The poses of calibration, in the order of the file: those before the first normal frame at first.
    pub fn calibration(&self) -> &[Calibration] {
        &self.calibration
    }

    /// The sections of the frames read so far, in the order of their first occurrence; at most 128.
    pub fn sections(&self) -> &[SectionInfo] {
        &self.frames.summary.list
    }

    /// How many frames were read so far.
    pub fn counts(&self) -> &FrameCounts {
        &self.counts
    }

    /// With [`salvage`](Self::salvage): the error that ended the iteration, if one did.
    pub fn damage(&self) -> Option<&Error> {
        self.damage.as_ref()
    }

    /// How far the file was read.
    pub fn place(&self) -> Place {
        self.xml.place()
    }

    /// The next normal frame, `None` behind the last one.
    fn next_frame(&mut self) -> Result<Option<Frame>, Error> {
        loop {
            let tag = match std::mem::replace(&mut self.state, State::Done) {
                State::Done => return Ok(None),
                State::Tag(tag) => tag,
                State::Between => {
                    let Some(tag) = next_tag(&mut self.xml, &mut self.header)? else {
                        self.read_tail()?;
                        return Ok(None);
                    };
                    tag
                }
            };
            self.state = State::Between;
            if tag.is_normal() {
                return self.read_frame(&tag).map(Some);
            }
            let to = &mut self.calibration;
            read_other(&mut self.xml, &tag, &self.layout, to, &mut self.counts)?;
        }
    }

    /// Reads from the end tag of the frames to the end of the file.
    fn read_tail(&mut self) -> Result<(), Error> {
        Around::begin_tail(&mut self.xml);
        read_tail(&mut self.xml, &mut self.header)?;
        self.around.end_tail(&mut self.xml);
        Ok(())
    }

    fn read_frame(&mut self, tag: &FrameTag) -> Result<Frame, Error> {
        let mut frame = Frame::new(Arc::clone(&self.subject));
        self.frames.read(&mut self.xml, tag, self.counts.normal, &mut frame)?;
        self.counts.normal += 1;
        Ok(frame)
    }
}

impl<R: BufRead> Iterator for Reader<R> {
    type Item = Result<Frame, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.next_frame() {
            Ok(frame) => frame.map(Ok),
            Err(error) => {
                self.state = State::Done;
                if self.salvage {
                    self.damage = Some(error);
                    return None;
                }
                Some(Err(error))
            }
        }
    }
}

impl<R> fmt::Debug for Reader<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reader")
            .field("subject", &self.subject.name)
            .field("counts", &self.counts)
            .field("damage", &self.damage)
            .finish_non_exhaustive()
    }
}

impl FrameTag {
    fn is_normal(&self) -> bool {
        self.kind == "normal"
    }
}

/// Reads the frames before the first normal one.
fn read_calibrations<R: BufRead>(
    xml: &mut Xml<R>,
    header: &mut Header,
    layout: &Layout,
    calibration: &mut Vec<Calibration>,
    counts: &mut FrameCounts,
) -> Result<State, Error> {
    while let Some(tag) = next_tag(xml, header)? {
        if tag.is_normal() {
            return Ok(State::Tag(tag));
        }
        read_other(xml, &tag, layout, calibration, counts)?;
    }
    Ok(State::Done)
}

/// Goes to the start tag of the next frame; `None` at the end tag of the frames.
fn next_tag<R: BufRead>(xml: &mut Xml<R>, header: &mut Header) -> Result<Option<FrameTag>, Error> {
    while xml.child()? {
        if xml.name() == "frame" {
            return FrameTag::read(xml, header.frame_rate()).map(Some);
        }
        keep_unknown(xml, header)?;
    }
    Ok(None)
}

/// Reads a frame that is not a normal one.
fn read_other<R: BufRead>(
    xml: &mut Xml<R>,
    tag: &FrameTag,
    layout: &Layout,
    calibration: &mut Vec<Calibration>,
    counts: &mut FrameCounts,
) -> Result<(), Error> {
    match CalibrationKind::of(&tag.kind) {
        Some(kind) if calibration.len() < MAX_CALIBRATIONS => {
            let pose = read_calibration(xml, kind, layout)?;
            calibration.push(pose);
            counts.calibration += 1;
            Ok(())
        }
        _ => {
            counts.skip(clip(&tag.kind));
            xml.skip()
        }
    }
}

impl FrameCounts {
    fn skip(&mut self, kind: String) {
        if let Some((_, count)) = self.skipped.iter_mut().find(|(known, _)| *known == kind) {
            *count += 1;
        } else if self.skipped.len() < MAX_TYPES {
            self.skipped.push((kind, 1));
        }
    }
}

/// Version 3 gives arms in ISB axes: `orientation * isb^-1` is the canonical orientation.
fn corrections(header: &Header, subject: &Subject) -> Vec<(usize, DQuat)> {
    let segments = subject.skeleton.segments.iter().enumerate();
    let turned = segments.filter(|(_, segment)| header.version == 3 && segment.isb != DQuat::IDENTITY);
    turned
        .map(|(place, segment)| (place, segment.isb.conjugate()))
        .collect()
}

const MAX_CALIBRATIONS: usize = 16;
const MAX_TYPES: usize = 16;
