//! What sections the frames of a file hold, for `inspect`.

use crate::elements::Elements;
use crate::error::clip;
use crate::number::count_words;
use crate::section::Section;
use crate::{Error, Place};

/// A section as the frames of a file hold it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SectionInfo {
    /// Its element name.
    pub name: String,
    /// Whether this crate reads its values.
    pub known: bool,
    /// The line where it was first seen.
    pub line: u64,
    /// How many numbers or words it held there.
    pub columns: usize,
    /// How many frames had it, of those read so far.
    pub frames: u64,
    /// Of a section that this crate does not know: its first occurrence as it stands in the file, the first 4 KiB.
    pub text: String,
}

/// The sections seen so far, in the order of their first occurrence.
#[derive(Debug, Default)]
pub(crate) struct SectionSummary {
    pub(crate) list: Vec<SectionInfo>,
    /// Where the section after the one seen last is most likely in the list.
    next: usize,
}

impl SectionSummary {
    /// Counts a section that was read.
    pub(crate) fn saw(&mut self, section: Section, columns: usize, at: Place) {
        if let Some(info) = self.find(section.name()) {
            info.frames += 1;
            return;
        }
        self.list.push(SectionInfo {
            name: section.name().to_owned(),
            known: true,
            line: at.line,
            columns,
            frames: 1,
            text: String::new(),
        });
    }

    /// Passes over the unknown section on whose start tag the reader stands, and counts it.
    pub(crate) fn read_unknown(&mut self, xml: &mut impl Elements) -> Result<(), Error> {
        let name = clip(xml.name());
        if let Some(info) = self.find(&name) {
            info.frames += 1;
            return xml.skip();
        }
        if self.list.len() >= MAX_SECTIONS {
            return xml.skip();
        }
        let line = xml.place().line;
        let raw = xml.skip_keeping(MAX_TEXT)?;
        self.list.push(SectionInfo {
            name,
            known: false,
            line,
            columns: count_words(xml.text()),
            frames: 1,
            text: raw.text,
        });
        Ok(())
    }

    /// Adds the sections of frames that follow those seen so far. `false` when there are too many to say what reading the
    /// frames one after the other would have kept; nothing is added then.
    pub(crate) fn append(&mut self, mut following: Self) -> bool {
        let is_new = |info: &SectionInfo| self.list.iter().all(|known| known.name != info.name);
        let new = following.list.iter().filter(|info| is_new(info)).count();
        if self.list.len() + new >= MAX_SECTIONS {
            return false;
        }
        for info in following.list.drain(..) {
            match self.list.iter_mut().find(|known| known.name == info.name) {
                Some(known) => known.frames += info.frames,
                None => self.list.push(info),
            }
        }
        true
    }

    /// The section of this name. Frames hold the same sections in the same order, so that the first look finds it.
    fn find(&mut self, name: &str) -> Option<&mut SectionInfo> {
        let likely = self.list.get(self.next).is_some_and(|info| info.name == name);
        let place = if likely {
            self.next
        } else {
            self.list.iter().position(|info| info.name == name)?
        };
        self.next = (place + 1) % self.list.len();
        self.list.get_mut(place)
    }
}

const MAX_SECTIONS: usize = 128;
const MAX_TEXT: usize = 4 << 10;
