//! Cuts a file into blocks of whole frames, each of which can be parsed on its own.

use crate::elements::Elements;
use crate::frame::{FrameReader, FrameTag};
use crate::rewind::Rewind;
use crate::scan::Scan;
use crate::sections::SectionSummary;
use crate::xml::Xml;
use crate::{Error, Place};
use memchr::memmem;
use posewire_motion::{Frame, Subject, Take};
use std::io::BufRead;
use std::sync::Arc;

/// Some frames of a file as text, and what was parsed of them.
pub(super) struct Block {
    /// How many blocks are before it.
    pub(super) number: u64,
    /// Where its first byte stands.
    pub(super) place: Place,
    pub(super) bytes: Vec<u8>,
    pub(super) take: Take,
    pub(super) sections: SectionSummary,
    /// Whether it was parsed and held normal, numbered frames and nothing else.
    pub(super) plain: bool,
}

/// Cuts the text between two frames and all that follows into blocks.
pub(super) struct Cutter {
    /// Bytes of a block; more when a frame is longer.
    length: usize,
    number: u64,
    place: Place,
    /// What was read and is in no block yet.
    rest: Vec<u8>,
}

impl Cutter {
    /// Begins at a place between two frames.
    pub(super) fn new(place: Place, length: usize) -> Self {
        Self {
            length,
            number: 0,
            place,
            rest: Vec::new(),
        }
    }

    /// Makes `block` the next one; `false` when no more can be cut off.
    ///
    /// It ends where a frame seems to end. Whether one does is seen when the block is parsed.
    pub(super) fn cut(&mut self, bytes: &mut Rewind<impl BufRead>, block: &mut Block) -> bool {
        let mut length = self.length;
        loop {
            let more = bytes.take_bytes(&mut self.rest, length);
            if let Some(end) = memmem::rfind(&self.rest, END) {
                self.give(end + END.len(), block);
                return true;
            }
            length *= 2;
            if !more || length > MAX_BLOCK {
                return false;
            }
        }
    }

    /// What is in no block, and where it stands.
    pub(super) fn into_rest(self) -> (Vec<u8>, Place) {
        (self.rest, self.place)
    }

    fn give(&mut self, end: usize, block: &mut Block) {
        block.bytes.clear();
        block.bytes.extend_from_slice(&self.rest[end..]);
        std::mem::swap(&mut block.bytes, &mut self.rest);
        block.bytes.truncate(end);
        (block.number, block.place) = (self.number, self.place);
        self.number += 1;
        self.place.line += memchr::memchr_iter(b'\n', &block.bytes).count() as u64;
        self.place.offset += end as u64;
    }
}

/// Parses blocks as the reader of the file would.
pub(super) struct BlockParser {
    frames: FrameReader,
    frame: Frame,
}

impl BlockParser {
    pub(super) fn new(frames: FrameReader, subject: &Arc<Subject>) -> Self {
        let frame = Frame::new(Arc::clone(subject));
        Self { frames, frame }
    }

    pub(super) fn parse(&mut self, block: &mut Block) {
        let (bytes, place) = (&block.bytes, block.place);
        let mut scan = Scan::new(bytes, place);
        block.plain = self
            .read_frames(&mut scan, bytes.len(), &mut block.take)
            .unwrap_or(false);
        if !block.plain {
            self.frames.summary = SectionSummary::default();
            block.take = Take::new(Arc::clone(&self.frame.subject), 0.0);
            let xml = Xml::within(AROUND, bytes, place);
            let read = xml.and_then(|mut xml| self.read_frames(&mut xml, bytes.len(), &mut block.take));
            block.plain = read.unwrap_or(false);
        }
        block.sections = std::mem::take(&mut self.frames.summary);
    }

    /// Reads all frames of a block of `length` bytes that holds nothing else; `false` or an error when it does.
    fn read_frames(&mut self, xml: &mut impl Elements, length: usize, take: &mut Take) -> Result<bool, Error> {
        let end = xml.offset() + length as u64;
        while xml.offset() < end {
            if !xml.child()? || xml.name() != "frame" {
                return Ok(false);
            }
            let tag = FrameTag::read(xml, self.frame.subject.rate)?;
            if !tag.is_normal() || !tag.is_numbered() {
                return Ok(false);
            }
            self.frame.clear();
            self.frames.read(xml, &tag, 0, &mut self.frame)?;
            if take.push(&self.frame).is_err() {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// More than any frame.
const MAX_BLOCK: usize = 16 << 20;
const END: &[u8] = b"</frame>";
/// A frame stands as deep in a block as in the file.
const AROUND: &str = "<mvnx><subject><frames>";
