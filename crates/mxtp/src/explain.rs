//! The bytes of a datagram, field by field.

mod layout;
mod walk;

use std::borrow::Cow;
use std::fmt;

use crate::{Datagram, Error, Header, Quirks};
use walk::Walk;

/// What the bytes of one datagram say, field by field.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The fields in the order of their offsets, without gaps as far as the bytes make sense.
    pub fields: Vec<Field>,
    /// Deviations from the specification; empty when the datagram does not decode.
    pub quirks: Quirks,
    /// Why the datagram does not decode.
    pub error: Option<Error>,
}

/// One field of a datagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Where the field begins, counted from the first byte of the datagram.
    pub offset: usize,
    /// Bytes of the field.
    pub length: usize,
    /// Dotted path, such as `segments[0].position.x`.
    pub name: String,
    /// Section of the specification, such as `MV0305 2.5.3`.
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
    Unsigned(u32),
    /// A number with sign: the length of a string.
    Signed(i32),
    /// A number with a fraction.
    Float(f32),
    /// A string; what is not UTF-8 is U+FFFD.
    Text(String),
    /// Bytes without a meaning here.
    Bytes(Vec<u8>),
}

/// Explains the bytes of one datagram. Of a malformed datagram it explains what comes before the
/// fault; the bytes after it are one last field.
///
/// ```
/// let explanation = posewire_mxtp::explain(b"MXTP02\0\0\x1a\x19");
/// let names: Vec<_> = explanation.fields.iter().map(|f| f.name.as_str()).collect();
/// assert_eq!(names, ["header.magic", "header.message_type", "header.sample"]);
/// assert!(explanation.error.is_some());
/// ```
pub fn explain(bytes: &[u8]) -> Explanation {
    let decoded = Datagram::decode(bytes);
    let mut walk = Walk::new(bytes);
    if layout::header(&mut walk).is_some()
        && let Ok(header) = Header::decode(bytes)
    {
        let body = decoded.as_ref().ok().map(|datagram| datagram.body);
        layout::body(&mut walk, &header, body.as_ref());
    }
    Explanation {
        fields: walk.into_fields(decoded.is_ok()),
        quirks: decoded.as_ref().map_or(Quirks::NONE, |d| d.quirks),
        error: decoded.err(),
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsigned(number) => number.fmt(f),
            Self::Signed(number) => number.fmt(f),
            Self::Float(number) => number.fmt(f),
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
    use crate::MessageType;
    use crate::body::{Body, JointAngles, QuaternionSegment, ScaleBuffer, UnitySegment};
    use crate::ids::{JOINTS, SegmentCounts, SegmentId};

    fn bytes_of(body: Body<'_>) -> Vec<u8> {
        let header = Header::rev_n(MessageType::META, 6681, 27_837, SegmentCounts::new(0, true));
        let mut bytes = Vec::new();
        Datagram::new(header, body).unwrap().encode(&mut bytes);
        bytes
    }

    fn gapless(explanation: &Explanation) -> usize {
        explanation.fields.iter().fold(0, |end, field| {
            assert_eq!(field.offset, end, "{field}");
            end + field.length
        })
    }

    #[test]
    fn every_byte_of_a_pose_has_a_field() {
        let segment = QuaternionSegment::new(SegmentId(1), [0.5, 1.5, 2.5], [1.0, 0.0, 0.0, 0.0]);
        let bytes = bytes_of(Body::Quaternion(&[segment]));
        let explanation = explain(&bytes);
        assert_eq!(gapless(&explanation), bytes.len());
        let y = &explanation.fields[14];
        assert_eq!((y.name.as_str(), y.offset), ("segments[0].position.y", 32));
        assert_eq!((&y.value, y.unit), (&Value::Float(1.5), Some("m")));
        assert_eq!(y.section, "MV0305 2.5.3");
        assert_eq!(explanation.quirks, Quirks::NONE);
    }

    #[test]
    fn segments_and_joints_are_named() {
        let note = |body, name: &str| {
            let fields = explain(&bytes_of(body)).fields;
            let field = fields.into_iter().find(|field| field.name == name).unwrap();
            field.note.unwrap().into_owned()
        };
        let at = |id| QuaternionSegment::new(SegmentId(id), [0.0; 3], [1.0, 0.0, 0.0, 0.0]);
        let poses = [at(10), at(24), at(63)];
        let pose = |name| note(Body::Quaternion(&poses), name);
        assert_eq!(pose("segments[0].id"), "RightForeArm");
        assert_eq!(pose("segments[1].id"), "LeftCarpus");
        assert_eq!(pose("segments[2].id"), "RightFifthDistalPhalange");
        let unity = [2, 24].map(|id| UnitySegment::new(SegmentId(id), [0.0; 3], [0.0; 4]));
        assert_eq!(note(Body::Unity(&unity), "segments[0].id"), "RightUpperLeg");
        assert_eq!(
            note(Body::Unity(&unity), "segments[1].id"),
            "no segment that the header counts"
        );
        let joints = JOINTS.map(|(parent, child)| JointAngles::new(parent, child, [0.0; 3]));
        let joint = |name| note(Body::JointAngles(&joints), name);
        assert_eq!(joint("joints[8].parent"), "RightUpperArm, point 2");
        assert_eq!(joint("joints[8].angles.z"), "jRightElbow, usually 9.2 to 10.1");
        assert_eq!(joint("joints[27].angles.z"), "Vertical_T8, usually 1.0 to 5.0");
    }

    #[test]
    fn a_cut_datagram_is_explained_up_to_the_cut() {
        let mut scale = ScaleBuffer::new();
        scale.push_segment("Pelvis", [0.0, 0.0, 1.0]);
        scale.push_segment("L5", [0.0, 0.0, 1.25]);
        let bytes = bytes_of(Body::Scale(scale.as_scale()));
        for length in 0..bytes.len() {
            let explanation = explain(&bytes[..length]);
            assert_eq!(gapless(&explanation), length);
            assert!(explanation.error.is_some(), "{length} bytes");
        }
        let whole = explain(&bytes);
        assert_eq!(gapless(&whole), bytes.len());
        assert_eq!(whole.error, None);
        assert!(whole.to_string().contains("segments[1].name "));
    }
}
