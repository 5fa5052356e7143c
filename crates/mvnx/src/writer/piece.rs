//! Markup of a document, written again in this version or the other.

use super::left_out::Reason;
use super::{Poses, Printer, Style, Version, Writer, write_poses};
use crate::calibration::CalibrationKind;
use crate::markup::{Kind, Markup, Piece, Pieces};
use crate::section::Section;
use crate::{Calibration, Document, Error};
use posewire_motion::{DQuat, Skeleton};
use std::borrow::Cow;
use std::io::Write;

impl<W: Write> Writer<W> {
    /// Writes all of a stretch of markup.
    pub(super) fn write_markup(&mut self, markup: &Markup) -> Result<(), Error> {
        self.left_out.too_large(markup);
        let mut pieces = markup.pieces();
        while let Some(piece) = pieces.next() {
            self.write_piece(piece, &mut pieces)?;
        }
        Ok(())
    }

    /// Writes a piece; of an element that stands on one line, all of it.
    pub(super) fn write_piece(&mut self, piece: Piece<'_>, pieces: &mut Pieces<'_>) -> Result<(), Error> {
        match piece.kind {
            Kind::Start if self.is_replaced(piece) => {
                pieces.skip_element();
                Ok(())
            }
            Kind::Start => self.write_start(piece, pieces),
            Kind::End | Kind::EndOfEmpty => self.printer.end(),
            Kind::Instruction if declares_other_encoding(piece) => {
                let text = &piece.with_attribute("encoding", "UTF-8");
                self.printer.content(Piece { text, ..piece })
            }
            _ => self.printer.content(piece),
        }
    }

    fn write_start(&mut self, tag: Piece<'_>, pieces: &mut Pieces<'_>) -> Result<(), Error> {
        let text = self.converted(tag);
        if pieces.peek().is_some_and(|piece| piece.kind == Kind::EndOfEmpty) {
            pieces.next();
            return self.printer.empty(&text);
        }
        if is_numbers(&self.printer, tag)
            && let Some(numbers) = pieces.text_content()
        {
            pieces.skip_element();
            return self.printer.leaf(&text, |to| {
                for number in numbers.split_ascii_whitespace() {
                    to.extend_from_slice(number.as_bytes());
                    to.push(b' ');
                }
            });
        }
        let style = if self.printer.in_lines() {
            Style::of(tag, pieces)
        } else {
            Style::Inline
        };
        self.printer.start(&text, style);
        Ok(())
    }

    /// Whether an element has no place in the other version, or is written anew in its convention.
    fn is_replaced(&mut self, tag: Piece<'_>) -> bool {
        if !self.changed {
            return false;
        }
        let (name, kind) = (tag.name(), tag.attribute("type").unwrap_or("normal"));
        match (self.printer.parent(), name) {
            ("mvnx", "securityCode") if tag.attribute("code").is_some_and(|code| !code.is_empty()) => {
                self.left_out.add(name, Reason::Converted);
                return false;
            }
            _ if !self.converts => return false,
            ("subject", "footContactDefinition") if self.version == Version::V3 => {
                self.left_out.add(name, Reason::Version(self.version));
            }
            ("frames", "frame") if self.frames == 0 && CalibrationKind::of(kind).is_some() => {}
            ("frames", "frame") => self.left_out.add(&format!("frame of type {kind}"), Reason::Converted),
            _ => return false,
        }
        true
    }

    /// A start tag in the version that is written.
    fn converted<'a>(&self, tag: Piece<'a>) -> Cow<'a, str> {
        if !self.changed {
            return Cow::Borrowed(tag.text);
        }
        match (self.printer.parent(), tag.name()) {
            ("mvnx", "securityCode") => Cow::Owned(tag.with_attribute("code", "")),
            _ if !self.converts => Cow::Borrowed(tag.text),
            ("point", "pos_b" | "pos_s") => Cow::Borrowed(self.version.offset()),
            ("mvnx", "subject") if self.version == Version::V4 => Cow::Owned(with_attributes_of_4(tag)),
            ("", "mvnx") => Cow::Owned(tag.with_attribute("version", &self.version.to_string())),
            _ => Cow::Borrowed(tag.text),
        }
    }

    /// Writes the poses of calibration that files of the other version have.
    pub(super) fn write_converted_poses(&mut self, document: &Document) -> Result<(), Error> {
        let skeleton = &document.subject.skeleton;
        let poses = poses(skeleton, document.version(), &document.calibration);
        let (layout, rate) = (self.numbers.layout, document.header.frame_rate());
        write_poses(&mut self.printer, layout, self.version, skeleton, &poses, rate)
    }
}

/// What the frames of calibration of a file tell; what they do not is as in the null pose.
fn poses(skeleton: &Skeleton, version: Version, calibration: &[Calibration]) -> Poses {
    let frame = |kind| calibration.iter().find(|pose| pose.kind == kind);
    let (null, held, held_in_own_axes) = match version {
        Version::V3 => (CalibrationKind::NPose, CalibrationKind::TPose, None),
        Version::V4 => (
            CalibrationKind::Identity,
            CalibrationKind::TPoseIsb,
            frame(CalibrationKind::TPose),
        ),
    };
    let mut poses = Poses::of_null(skeleton);
    if let Some(frame) = frame(null) {
        // Of which segments the file tells, but their exact axes.
        let known = |(q, isb): (&Option<DQuat>, &Option<DQuat>)| q.and(*isb);
        let axes = frame.orientation.iter().zip(&poses.null.orientation);
        poses.null.orientation = axes.map(known).collect();
        poses.null.position.clone_from(&frame.position);
        poses.held = poses.null.clone();
    }
    if let Some(frame) = frame(held) {
        poses.held.orientation.clone_from(&frame.orientation);
        poses.held.position.clone_from(&frame.position);
    } else if let Some(frame) = held_in_own_axes {
        let turned = frame.orientation.iter().zip(&skeleton.segments);
        poses.held.orientation = turned.map(|(q, segment)| q.map(|q| q * segment.isb)).collect();
        poses.held.position.clone_from(&frame.position);
    }
    poses
}

/// The subject's start tag with the attributes that readers of version 4 look for, empty where it had none.
fn with_attributes_of_4(tag: Piece<'_>) -> String {
    let mut text = tag.text.to_owned();
    for name in ONLY_IN_4 {
        if tag.attribute(name).is_none() {
            text = Piece::start(&text).with_attribute(name, "");
        }
    }
    text
}

/// Attributes of the subject that version 3 does not know.
pub(crate) const ONLY_IN_4: [&str; 2] = ["configuration", "userScenario"];

/// Whether the text declares that the file was in another encoding before it was read.
fn declares_other_encoding(piece: Piece<'_>) -> bool {
    let encoding = piece.attribute("encoding").filter(|_| piece.tag_name() == "xml");
    encoding.is_some_and(|encoding| !encoding.eq_ignore_ascii_case("UTF-8"))
}

/// Whether an element holds nothing but numbers.
fn is_numbers<W: Write>(printer: &Printer<W>, tag: Piece<'_>) -> bool {
    match printer.parent() {
        "point" => matches!(tag.name(), "pos_b" | "pos_s"),
        "frame" => Section::of(tag.name()).is_some(),
        _ => false,
    }
}
