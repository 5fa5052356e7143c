//! What can be wrong with an MVNX file, or with writing one.

use std::fmt;
use std::io;

/// Where in the text of a file something is. Of a compressed file, the text is the decompressed one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The line, from 1.
    pub line: u64,
    /// The byte, from 0.
    pub offset: u64,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {} (byte {})", self.line, self.offset)
    }
}

/// Why a file is not MVNX that can be read, and where; or why one cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is nothing in the file, or only white space and comments.
    #[error("expected an MVNX document, found an empty file")]
    Empty,
    /// The file is not text: MVN's own `.mvn` recordings are like that.
    #[error(
        "expected an MVNX document, found binary data ({}): MVN's own .mvn format is proprietary, export MVNX from MVN",
        Hex(found)
    )]
    Binary {
        /// The first bytes of the file, eight at most.
        found: Vec<u8>,
    },
    /// The file is text, but the text of something else.
    #[error("{at}: expected the root element <mvnx>, found {found:?}")]
    NotMvnx {
        /// Where the text begins.
        at: Place,
        /// The root element's name, or the beginning of the text.
        found: String,
    },
    /// A version of the format that this crate does not read. It reads 3 and 4.
    #[error("MVNX version {found} is not supported: export again from MVN (expected version 3 or 4)")]
    Version {
        /// The `version` of the root element.
        found: String,
    },
    /// The file could not be read, or its compression is damaged.
    #[error("{at}: {message}")]
    Io {
        /// How far it was read.
        at: Place,
        /// What kind of failure it is.
        kind: io::ErrorKind,
        /// What the operating system or the decompressor says.
        message: String,
    },
    /// The file could not be written.
    #[error("writing failed: {message}")]
    Write {
        /// What kind of failure it is.
        kind: io::ErrorKind,
        /// What the operating system says.
        message: String,
    },
    /// A frame to write whose section does not fit the document.
    #[error("{section} of sample {sample}: expected {expected} entries, found {found}")]
    Misfit {
        /// The section's element.
        section: &'static str,
        /// The frame's sample number.
        sample: u32,
        /// Entries that the document defines.
        expected: usize,
        /// Entries that the frame holds.
        found: usize,
    },
    /// The file is not well-formed XML.
    #[error("{at}: malformed XML: {message}")]
    Xml {
        /// Where the markup begins.
        at: Place,
        /// What is wrong with it.
        message: String,
    },
    /// The file ends before its root element does.
    #[error("{at}: the file ends inside <{inside}>")]
    Truncated {
        /// Where it ends.
        at: Place,
        /// The elements that were open, outermost first, with slashes between.
        inside: String,
    },
    /// An element that every MVNX file has is not there.
    #[error("{at}: expected <{expected}> in <{inside}>, found none")]
    MissingElement {
        /// Where the element that lacks it begins or ends.
        at: Place,
        /// The element that lacks it.
        inside: &'static str,
        /// The element that is missing.
        expected: &'static str,
    },
    /// An element that may stand once only stands again.
    #[error("{at}: expected <{element}> once, found it again")]
    Repeated {
        /// Where it stands again.
        at: Place,
        /// Its name.
        element: String,
    },
    /// An attribute that the element must have is not there.
    #[error("{at}: expected attribute {attribute:?} of <{element}>, found none")]
    MissingAttribute {
        /// Where the element begins.
        at: Place,
        /// The element's name.
        element: &'static str,
        /// The attribute's name.
        attribute: &'static str,
    },
    /// An attribute or text whose value makes no sense.
    #[error("{at}: {what}: expected {expected}, found {found:?}")]
    Value {
        /// Where the element begins.
        at: Place,
        /// The element, or the element and its attribute.
        what: &'static str,
        /// What it should be.
        expected: &'static str,
        /// What it is; long text is cut.
        found: String,
    },
    /// Something that has no place here: text between elements, an element within numbers.
    #[error("{at}: expected {expected}, found {found:?}")]
    Unexpected {
        /// Where it begins.
        at: Place,
        /// What should be there.
        expected: String,
        /// What is there; long text is cut.
        found: String,
    },
    /// A section of a frame with too few or too many numbers.
    #[error("{at}: {section}: expected {expected} numbers ({entries}), found {found}")]
    Columns {
        /// Where the section begins.
        at: Place,
        /// The section's element.
        section: &'static str,
        /// How many numbers it must hold.
        expected: usize,
        /// Why that many: `23 segments x 4`.
        entries: String,
        /// How many it holds.
        found: usize,
    },
    /// Something else than a finite decimal number where numbers stand.
    #[error("{at}: {section}: expected a number, found {found:?}")]
    Number {
        /// Where it stands.
        at: Place,
        /// The element.
        section: &'static str,
        /// The text; long text is cut.
        found: String,
    },
    /// A joint, sensor or angle that names a segment which the file does not have.
    #[error("{what} before the frames: expected the label of a segment, found {found:?}")]
    UnknownSegment {
        /// The element.
        what: &'static str,
        /// The name; long text is cut.
        found: String,
    },
    /// A joint that makes a segment hang on itself.
    #[error("joint {joint:?} hangs segment {segment:?} on itself")]
    Cycle {
        /// The joint's label.
        joint: String,
        /// The label of its child segment.
        segment: String,
    },
    /// More of something than any take has.
    #[error("{at}: expected at most {limit} {what}, found more")]
    TooMany {
        /// Where the first one too many is.
        at: Place,
        /// What there is too much of.
        what: &'static str,
        /// How many there may be.
        limit: u64,
    },
}

impl Error {
    /// The error of a failed write.
    pub(crate) fn of_write(error: &io::Error) -> Self {
        Self::Write {
            kind: error.kind(),
            message: error.to_string(),
        }
    }
}

/// Bytes as they are shown in a message.
struct Hex<'a>(&'a [u8]);

impl fmt::Display for Hex<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, byte) in self.0.iter().enumerate() {
            let gap = if place == 0 { "" } else { " " };
            write!(f, "{gap}{byte:02x}")?;
        }
        Ok(())
    }
}

/// Found text as a message holds it: the first 40 characters.
pub(crate) fn clip(text: &str) -> String {
    let mut characters = text.trim().chars();
    let mut kept: String = characters.by_ref().take(40).collect();
    if characters.next().is_some() {
        kept.push('…');
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_says_expected_found_and_where() {
        let at = Place {
            line: 614,
            offset: 51_200,
        };
        let error = Error::Columns {
            at,
            section: "orientation",
            expected: 92,
            entries: "23 segments x 4".to_owned(),
            found: 91,
        };
        assert_eq!(
            error.to_string(),
            "line 614 (byte 51200): orientation: expected 92 numbers (23 segments x 4), found 91"
        );
        let binary = Error::Binary { found: vec![0, 0x4d] };
        assert!(binary.to_string().contains("(00 4d)"), "{binary}");
        assert!(binary.to_string().contains("export MVNX from MVN"), "{binary}");
    }

    #[test]
    fn long_text_is_cut() {
        assert_eq!(clip(" short "), "short");
        assert_eq!(clip(&"é".repeat(41)).chars().count(), 41);
    }
}
