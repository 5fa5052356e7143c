//! What a frame element holds besides its numbers.

use crate::markup::{Kind, Markup, Pieces};
use crate::section::{Layout, Section};

/// What a frame element holds besides the numbers that became a [`Frame`](posewire_motion::Frame): its attributes as they
/// are written, the order of its elements, comments and unknown elements, and what stood between it and the frame before.
///
/// [`Reader::read_whole`](crate::Reader::read_whole) fills one, [`Writer::write_whole`](crate::Writer::write_whole) puts
/// it back. One value serves for all frames of a file. Of a frame that takes more than 4 MiB of text, nothing is kept.
#[derive(Clone, Debug, Default)]
pub struct Remainder {
    pub(crate) markup: Markup,
    /// Where the frame's start tag stands in the markup.
    pub(crate) frame: usize,
    /// Where a quaternion that is turned to canonical axes had a negative zero, of which the turn keeps no sign.
    pub(crate) negative_zeros: Vec<(Section, usize)>,
    /// The frame with its numbers, while it is read.
    whole: Markup,
}

impl Remainder {
    /// Gives away the memory that a frame is recorded in, empty.
    pub(crate) fn begin(&mut self) -> Markup {
        let mut whole = std::mem::take(&mut self.whole);
        whole.restart(MAX_FRAME);
        whole
    }

    /// Takes over a recorded frame without its numbers. `turned` says whether its quaternions are turned.
    pub(crate) fn end(&mut self, whole: Markup, layout: &Layout, turned: bool) {
        self.markup.restart(MAX_FRAME);
        self.negative_zeros.clear();
        self.frame = whole.last_element().unwrap_or_default();
        if whole.left_out() > 0 {
            // Where too much was read, the frame's own start tag may be missing.
            self.markup.leave_out(whole.left_out());
            self.frame = 0;
            self.whole = whole;
            return;
        }
        let mut pieces = whole.pieces();
        let mut depth = 0_usize;
        while let Some(piece) = pieces.next() {
            self.markup.push(piece.kind, piece.text);
            match piece.kind {
                Kind::Start => depth += 1,
                Kind::End | Kind::EndOfEmpty => depth = depth.saturating_sub(1),
                _ => {}
            }
            let in_frame = depth == 2 && pieces.place() > self.frame && piece.kind == Kind::Start;
            if in_frame && let Some(section) = layout.section(piece.name()) {
                self.skip_numbers(section, &mut pieces, turned);
            }
        }
        self.whole = whole;
    }

    /// Passes over the text of a section up to its end tag.
    fn skip_numbers(&mut self, section: Section, pieces: &mut Pieces<'_>, turned: bool) {
        while let Some(piece) = pieces.peek()
            && !matches!(piece.kind, Kind::End | Kind::EndOfEmpty)
        {
            if turned && section.columns() == 4 && piece.text.contains(NEGATIVE_ZERO) {
                let numbers = piece.text.split_ascii_whitespace().enumerate();
                let zeros = numbers.filter(|(_, number)| *number == NEGATIVE_ZERO);
                self.negative_zeros.extend(zeros.map(|(place, _)| (section, place)));
            }
            pieces.next();
        }
    }
}

const NEGATIVE_ZERO: &str = "-0.000000";
/// A frame of 500 segments with all sections takes 0.3 MB.
const MAX_FRAME: usize = 4 << 20;
