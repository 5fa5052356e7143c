//! Markup in MVN's layout: tabs, one element a line, line feeds.

use super::fixed::push_fixed;
use crate::Error;
use crate::markup::{Kind, Piece, Pieces};
use crate::section::Section;
use posewire_motion::DVec3;
use std::io::Write;

/// Writes markup, and knows which elements are open.
pub(crate) struct Printer<W> {
    to: W,
    buffer: Vec<u8>,
    /// The names of the open elements one after the other.
    names: String,
    open: Vec<Open>,
}

/// An open element.
#[derive(Clone, Copy)]
struct Open {
    /// Where its name begins.
    name: usize,
    style: Style,
}

/// How the content of an element is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// Every child on a line of its own.
    Lines,
    /// As it stands.
    Inline,
}

impl<W: Write> Printer<W> {
    pub(crate) fn new(to: W) -> Self {
        Self {
            to,
            buffer: Vec::with_capacity(2 * FULL),
            names: String::new(),
            open: Vec::new(),
        }
    }

    /// How many elements are open.
    pub(crate) fn depth(&self) -> usize {
        self.open.len()
    }

    /// The name of the innermost open element.
    pub(crate) fn parent(&self) -> &str {
        self.open.last().map_or("", |open| &self.names[open.name..])
    }

    /// Begins an element.
    pub(crate) fn start(&mut self, tag: &str, style: Style) {
        self.indent();
        self.push(["<", tag, ">"]);
        self.open.push(Open {
            name: self.names.len(),
            style,
        });
        self.names.push_str(Piece::start(tag).tag_name());
        if style == Style::Lines {
            self.buffer.push(b'\n');
        }
    }

    /// Ends the innermost open element.
    pub(crate) fn end(&mut self) -> Result<(), Error> {
        let Some(open) = self.open.pop() else { return Ok(()) };
        if open.style == Style::Lines {
            self.tabs();
        }
        self.buffer.extend_from_slice(b"</");
        self.buffer.extend_from_slice(&self.names.as_bytes()[open.name..]);
        self.buffer.push(b'>');
        self.names.truncate(open.name);
        self.end_line()
    }

    /// Writes an element without content.
    pub(crate) fn empty(&mut self, tag: &str) -> Result<(), Error> {
        self.indent();
        self.push(["<", tag, "/>"]);
        self.end_line()
    }

    /// Writes the numbers of a section: contacts as 0 or 1, all others with six decimals.
    pub(crate) fn numbers(&mut self, tag: &str, section: Section, numbers: &[f64]) -> Result<(), Error> {
        self.leaf(tag, |to| {
            for &number in numbers {
                if section == Section::FootContacts {
                    to.push(if number == 0.0 { b'0' } else { b'1' });
                } else {
                    push_fixed(to, number);
                }
                to.push(b' ');
            }
        })
    }

    /// Writes x, y and z of a vector.
    pub(crate) fn vector(&mut self, tag: &str, vector: DVec3) -> Result<(), Error> {
        self.leaf(tag, |to| {
            for number in vector.to_array() {
                push_fixed(to, number);
                to.push(b' ');
            }
        })
    }

    /// Writes a processing instruction.
    pub(crate) fn instruction(&mut self, text: &str) -> Result<(), Error> {
        self.content(Piece {
            kind: Kind::Instruction,
            text,
        })
    }

    /// Writes an element with text. What `content` adds must be escaped; a space at its end is taken away.
    pub(crate) fn leaf(&mut self, tag: &str, content: impl FnOnce(&mut Vec<u8>)) -> Result<(), Error> {
        self.indent();
        self.push(["<", tag, ">"]);
        content(&mut self.buffer);
        if self.buffer.last() == Some(&b' ') {
            self.buffer.pop();
        }
        self.push(["</", Piece::start(tag).tag_name(), ">"]);
        self.end_line()
    }

    /// Writes what is no tag.
    pub(crate) fn content(&mut self, piece: Piece<'_>) -> Result<(), Error> {
        let (before, after) = match piece.kind {
            Kind::Text if self.in_lines() => return Ok(()),
            Kind::Text => ("", ""),
            Kind::Reference => ("&", ";"),
            Kind::CData => ("<![CDATA[", "]]>"),
            Kind::Comment => ("<!--", "-->"),
            Kind::Instruction => ("<?", "?>"),
            Kind::Doctype => ("<!DOCTYPE ", ">"),
            Kind::Start | Kind::End | Kind::EndOfEmpty => return Ok(()),
        };
        self.indent();
        self.push([before, piece.text, after]);
        self.end_line()
    }

    /// Hands on all that is written and gives the destination back.
    pub(crate) fn finish(mut self) -> Result<W, Error> {
        self.hand_on()?;
        self.to.flush().map_err(|error| Error::of_write(&error))?;
        Ok(self.to)
    }

    /// Whether children of the innermost open element stand on lines of their own.
    pub(crate) fn in_lines(&self) -> bool {
        self.open.last().is_none_or(|open| open.style == Style::Lines)
    }

    fn indent(&mut self) {
        if self.in_lines() {
            self.tabs();
        }
    }

    fn tabs(&mut self) {
        let length = self.buffer.len() + self.open.len();
        self.buffer.resize(length, b'\t');
    }

    fn end_line(&mut self) -> Result<(), Error> {
        if self.in_lines() {
            self.buffer.push(b'\n');
        }
        if self.buffer.len() < FULL {
            return Ok(());
        }
        self.hand_on()
    }

    fn hand_on(&mut self) -> Result<(), Error> {
        self.to
            .write_all(&self.buffer)
            .map_err(|error| Error::of_write(&error))?;
        self.buffer.clear();
        Ok(())
    }

    fn push<const N: usize>(&mut self, parts: [&str; N]) {
        for part in parts {
            self.buffer.extend_from_slice(part.as_bytes());
        }
    }
}

impl Style {
    /// That of the element whose start tag was just taken from `content`.
    ///
    /// MVN's own lists have their entries on lines whatever the file did; other elements stay as they are, their lines
    /// indented.
    pub(crate) fn of(tag: Piece<'_>, content: &Pieces<'_>) -> Self {
        match content.peek() {
            Some(piece) if piece.kind == Kind::End => Self::Inline,
            _ if LISTS.contains(&tag.name()) => Self::Lines,
            _ if has_lines(content.clone()) => Self::Lines,
            _ => Self::Inline,
        }
    }
}

/// Whether the rest of an element is children on lines, without text between them.
fn has_lines(mut content: Pieces<'_>) -> bool {
    let (mut children, mut lines) = (false, false);
    while let Some(piece) = content.next() {
        match piece.kind {
            Kind::Start => {
                children = true;
                content.skip_element();
            }
            Kind::Comment | Kind::Instruction | Kind::Doctype => children = true,
            Kind::Text if piece.is_blank() => lines |= piece.text.contains('\n'),
            Kind::Text | Kind::CData | Kind::Reference => return false,
            Kind::End | Kind::EndOfEmpty => break,
        }
    }
    children && lines
}

/// The elements of MVNX that hold a list.
const LISTS: [&str; 17] = [
    "mvnx",
    "subject",
    "segments",
    "segment",
    "points",
    "point",
    "sensors",
    "joints",
    "joint",
    "ergonomicJointAngles",
    "footContactDefinition",
    "fingerTrackingSegmentsLeft",
    "fingerTrackingSegmentsRight",
    "fingerTrackingJointsLeft",
    "fingerTrackingJointsRight",
    "frames",
    "frame",
];

/// So many bytes are handed on at once.
const FULL: usize = 64 << 10;
