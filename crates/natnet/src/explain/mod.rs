//! The bytes of a packet, field by field.

mod command;
mod frame;
mod model;
mod walk;

use std::borrow::Cow;
use std::fmt;

use crate::{Error, Message, MessageId, Quirk, Quirks, Version};
use walk::Walk;

/// What the bytes of one packet say, field by field.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The fields in the order of their offsets, without gaps as far as the bytes make sense.
    pub fields: Vec<Field>,
    /// What was unusual; empty when the packet does not decode.
    pub quirks: Quirks,
    /// Why the packet does not decode.
    pub error: Option<Error>,
}

/// One field of a packet.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Where the field begins, counted from the first byte of the packet.
    pub offset: usize,
    /// Bytes of the field.
    pub length: usize,
    /// Dotted path, such as `rigid_bodies[0].position.x`.
    pub name: String,
    /// The section of the packet, such as `rigid bodies`.
    pub section: &'static str,
    /// What the bytes say.
    pub value: Value,
    /// Unit of the value.
    pub unit: Option<&'static str>,
    /// What else there is to know about this value.
    pub note: Option<Cow<'static, str>>,
}

/// The value of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number without sign.
    Unsigned(u64),
    /// A number with sign.
    Signed(i32),
    /// A number with a fraction, 32 bits.
    Float(f32),
    /// A number with a fraction, 64 bits.
    Double(f64),
    /// A string; what is not UTF-8 is U+FFFD.
    Text(String),
    /// Bytes without a meaning here.
    Bytes(Vec<u8>),
}

/// Explains the bytes of one packet of a bitstream of `version`. Of a malformed packet it explains
/// what comes before the fault; the bytes after it are one last field.
///
/// ```
/// use posewire_natnet::{Version, explain};
///
/// let explanation = explain(Version::new(3, 1), b"\x07\0\x05\0\x2a\0\0\0\x01");
/// let last = explanation.fields.last().unwrap();
/// assert_eq!(explanation.fields[2].to_string(), "    4  frame_number                     42  (frame prefix)");
/// assert_eq!((last.offset, last.name.as_str()), (8, "unread"));
/// assert!(explanation.error.is_some());
/// ```
pub fn explain(version: Version, bytes: &[u8]) -> Explanation {
    let decoded = Message::decode(version, bytes).map(|(_, quirks)| quirks);
    let quirks = decoded.as_ref().copied().unwrap_or(Quirks::NONE);
    let mut walk = Walk::new(bytes);
    // What a malformed payload leaves becomes the last field.
    let _ = packet(&mut walk, version, quirks);
    Explanation {
        fields: walk.into_fields(decoded.is_ok()),
        quirks,
        error: decoded.err(),
    }
}

fn packet(walk: &mut Walk<'_>, version: Version, quirks: Quirks) -> Option<()> {
    let id = MessageId(walk.u16("message")?);
    walk.note(id.to_string());
    let size = usize::from(walk.u16("payload_size")?);
    walk.unit("bytes");
    let found = walk.left().len();
    if size != found {
        walk.note(format!("{found} bytes follow"));
    }
    let layout = Layout::new(version, quirks);
    walk.within(size.min(found), |walk| match id {
        MessageId::FRAME if layout.draft => frame::draft(walk, layout.version),
        MessageId::FRAME => frame::frame(walk, layout.version),
        MessageId::MODEL => model::model(walk, &layout),
        id => command::command(walk, id),
    })
}

/// How the frames and descriptions turned out to be laid out.
struct Layout {
    version: Version,
    draft: bool,
    /// Descriptions that cannot be read were kept as bytes.
    tolerant: bool,
}

impl Layout {
    fn new(version: Version, quirks: Quirks) -> Self {
        let unsized_later = quirks.contains(Quirk::UnsizedSections);
        Self {
            version: if unsized_later { Version::new(4, 0) } else { version },
            draft: quirks.contains(Quirk::DraftLayout),
            tolerant: quirks.contains(Quirk::UnreadableDescription),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsigned(number) => number.fmt(f),
            Self::Signed(number) => number.fmt(f),
            Self::Float(number) => number.fmt(f),
            Self::Double(number) => number.fmt(f),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Bytes(bytes) => bytes.iter().try_for_each(|byte| write!(f, "{byte:02x}")),
        }
    }
}

impl fmt::Display for Field {
    /// One line: offset, name, value, unit, section and note.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:>5}  {:<32} {}", self.offset, self.name, self.value)?;
        if let Some(unit) = self.unit {
            write!(f, " {unit}")?;
        }
        write!(f, "  ({})", self.section)?;
        match &self.note {
            Some(note) => write!(f, "  {note}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Explanation {
    /// One line for each field, quirk and error.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for field in &self.fields {
            writeln!(f, "{field}")?;
        }
        for quirk in self.quirks.iter() {
            writeln!(f, "quirk  {quirk}: {}", quirk.meaning())?;
        }
        match &self.error {
            Some(error) => writeln!(f, "error  {error}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{BodyParams, Frame, FrameParams, LabeledMarker, MarkerParams, RigidBody, Timecode};

    fn notes(frame: Frame) -> Vec<(String, String)> {
        let mut bytes = Vec::new();
        Message::Frame(frame.into())
            .encode(Version::new(3, 1), &mut bytes)
            .unwrap();
        let fields = explain(Version::new(3, 1), &bytes).fields.into_iter();
        fields
            .filter_map(|field| Some((field.name, field.note?.into_owned())))
            .collect()
    }

    #[test]
    fn ids_bits_and_timecodes_are_put_into_words() {
        let bits = MarkerParams(MarkerParams::OCCLUDED.0 | MarkerParams::ACTIVE.0);
        let frame = Frame {
            rigid_bodies: vec![RigidBody {
                id: (4 << 16) | 1,
                params: Some(BodyParams::TRACKED),
                ..RigidBody::default()
            }],
            labeled_markers: vec![LabeledMarker {
                id: (2 << 16) | 5,
                params: Some(bits),
                ..LabeledMarker::default()
            }],
            timecode: Some(Timecode::new(1, 2, 3, 4, 0)),
            params: Some(FrameParams::MODEL_CHANGED),
            ..Frame::default()
        };
        let expected = [
            ("message", "FRAMEOFDATA"),
            ("rigid_bodies[0].id", "bone 1 of skeleton 4"),
            ("rigid_bodies[0].params", "tracked"),
            ("labeled_markers[0].id", "member 5 of asset 2"),
            ("labeled_markers[0].params", "occluded, active"),
            ("timecode", "01:02:03:04.0"),
            ("params", "model changed"),
        ];
        let expected = expected.map(|(name, note)| (name.to_owned(), note.to_owned()));
        assert_eq!(notes(frame), expected);
    }
}
