//! The 24 bytes in front of every datagram (MV0305 2.4.1).

use std::fmt;
use std::str::FromStr;

use zerocopy::byteorder::big_endian::{U16, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::Error;
use crate::ids::SegmentCounts;

/// The two decimal digits that say what a datagram carries (MV0305 2.4.1.1).
///
/// Types without a named constant stay what they are: they decode as opaque bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MessageType(u8);

impl MessageType {
    /// 01: absolute position and Euler angles, Y-up, centimetres and degrees.
    pub const EULER: Self = Self(1);
    /// 02: absolute position and quaternion, Z-up, metres.
    pub const QUATERNION: Self = Self(2);
    /// 03: positions of points, like optical markers, Y-up, centimetres.
    pub const POINTS: Self = Self(3);
    /// 04: `MotionGrid` tags; deprecated, carried as opaque bytes.
    pub const TAGS: Self = Self(4);
    /// 05: the Unity pose: local rotations, left-handed, Y-up.
    pub const UNITY: Self = Self(5);
    /// 10: scale, superseded by 13; carried as opaque bytes.
    pub const OLD_SCALE: Self = Self(10);
    /// 11: props, superseded by 13; carried as opaque bytes.
    pub const OLD_PROPS: Self = Self(11);
    /// 12: meta data: name, colour and more, as tagged lines of text.
    pub const META: Self = Self(12);
    /// 13: scale: the null pose and the points on the segments.
    pub const SCALE: Self = Self(13);
    /// 20: joint angles in degrees.
    pub const JOINT_ANGLES: Self = Self(20);
    /// 21: position, velocity and acceleration of segments.
    pub const LINEAR: Self = Self(21);
    /// 22: orientation, angular velocity and angular acceleration of segments.
    pub const ANGULAR: Self = Self(22);
    /// 23: motion trackers.
    pub const TRACKERS: Self = Self(23);
    /// 24: centre of mass.
    pub const CENTER_OF_MASS: Self = Self(24);
    /// 25: time code, UTC time of day.
    pub const TIME_CODE: Self = Self(25);

    /// The type with this number, if two digits can state it.
    pub const fn new(number: u8) -> Option<Self> {
        if number < 100 { Some(Self(number)) } else { None }
    }

    /// The number that the two digits state, 0 to 99.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// What the type carries, in a few words; `unknown` for a type the specification does not have.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EULER => "pose, Euler angles",
            Self::QUATERNION => "pose, quaternion",
            Self::POINTS => "pose, points",
            Self::TAGS => "MotionGrid tags",
            Self::UNITY => "pose, Unity3D",
            Self::OLD_SCALE => "scale, old",
            Self::OLD_PROPS => "props, old",
            Self::META => "meta data",
            Self::SCALE => "scale",
            Self::JOINT_ANGLES => "joint angles",
            Self::LINEAR => "linear segment kinematics",
            Self::ANGULAR => "angular segment kinematics",
            Self::TRACKERS => "motion trackers",
            Self::CENTER_OF_MASS => "centre of mass",
            Self::TIME_CODE => "time code",
            _ => "unknown",
        }
    }

    /// Size of one item in bytes as current software sends it, for the types whose items all have
    /// one size. Types 23, 24 and 25 also have a shorter form (44, 12 and 12 bytes).
    pub const fn item_size(self) -> Option<usize> {
        match self {
            Self::EULER => Some(28),
            Self::QUATERNION | Self::UNITY => Some(32),
            Self::POINTS | Self::TIME_CODE => Some(16),
            Self::JOINT_ANGLES => Some(20),
            Self::LINEAR => Some(40),
            Self::ANGULAR => Some(44),
            Self::TRACKERS => Some(68),
            Self::CENTER_OF_MASS => Some(36),
            _ => None,
        }
    }

    fn from_digits(digits: [u8; 2]) -> Option<Self> {
        let [tens, ones] = digits;
        (tens.is_ascii_digit() && ones.is_ascii_digit()).then(|| Self((tens - b'0') * 10 + (ones - b'0')))
    }

    const fn digits(self) -> [u8; 2] {
        [b'0' + self.0 / 10, b'0' + self.0 % 10]
    }
}

impl fmt::Display for MessageType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02}", self.0)
    }
}

impl FromStr for MessageType {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        <[u8; 2]>::try_from(text.as_bytes())
            .ok()
            .and_then(Self::from_digits)
            .ok_or_else(|| Error::TypeText { found: text.into() })
    }
}

/// Which part of a split sample a datagram is (MV0305 2.4.1.3): a 7-bit index and, in the highest
/// bit, whether it is the last part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DatagramCounter(pub u8);

impl DatagramCounter {
    /// The whole sample in one datagram, the usual case.
    pub const SINGLE: Self = Self(0x80);

    const LAST: u8 = 0x80;

    /// Part `index` (0 to 127; higher bits are cut off) of a split sample.
    pub const fn part(index: u8, last: bool) -> Self {
        let flag = if last { Self::LAST } else { 0 };
        Self(index & !Self::LAST | flag)
    }

    /// Index of the part, 0 to 127.
    pub const fn index(self) -> u8 {
        self.0 & !Self::LAST
    }

    /// Whether this is the last part of its sample.
    pub const fn is_last(self) -> bool {
        self.0 & Self::LAST != 0
    }
}

impl fmt::Display for DatagramCounter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#04x}", self.0)
    }
}

/// Which revision of the specification a header follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Revision {
    /// Rev J (MVN Studio, and MVN before 2019): the last seven header bytes are zero.
    J,
    /// Rev N (from MVN 2019): segment counts and payload size in the header.
    N,
}

/// The header of a datagram (MV0305 2.4.1), 24 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// What the datagram carries.
    pub message_type: MessageType,
    /// Counts samples at the sampling rate; a sender may skip some.
    pub sample: u32,
    /// Which part of a split sample this is.
    pub counter: DatagramCounter,
    /// Number of items in this datagram, as the sender states it.
    pub items: u8,
    /// Milliseconds since the recording began.
    pub time_ms: u32,
    /// Which character, from 0. User interfaces of the vendor show one more.
    pub character: u8,
    /// Number of body segments of the character, usually 23; 0 in Rev J.
    pub body_segments: u8,
    /// Number of props of the character, 0 to 4; 0 in Rev J.
    pub props: u8,
    /// Number of finger segments of both hands, 0 or 40; 0 in Rev J.
    pub finger_segments: u8,
    /// Reserved, 0.
    pub reserved: [u8; 2],
    /// Bytes after the header, as the sender states it; 0 in Rev J.
    pub payload_size: u16,
}

impl Header {
    /// Bytes of a header.
    pub const SIZE: usize = 24;

    /// The four characters that every datagram begins with.
    pub const MAGIC: [u8; 4] = *b"MXTP";

    /// A Rev J header of an unsplit sample of character 0.
    pub const fn rev_j(message_type: MessageType, sample: u32, time_ms: u32) -> Self {
        Self {
            message_type,
            sample,
            counter: DatagramCounter::SINGLE,
            items: 0,
            time_ms,
            character: 0,
            body_segments: 0,
            props: 0,
            finger_segments: 0,
            reserved: [0; 2],
            payload_size: 0,
        }
    }

    /// A Rev N header of an unsplit sample of character 0 with these segments.
    pub const fn rev_n(message_type: MessageType, sample: u32, time_ms: u32, segments: SegmentCounts) -> Self {
        Self {
            body_segments: segments.body,
            props: segments.props,
            finger_segments: segments.fingers,
            ..Self::rev_j(message_type, sample, time_ms)
        }
    }

    /// The same header for another character.
    #[must_use]
    pub const fn with_character(self, character: u8) -> Self {
        Self { character, ..self }
    }

    /// The same header for a part of a split sample.
    #[must_use]
    pub const fn with_counter(self, counter: DatagramCounter) -> Self {
        Self { counter, ..self }
    }

    /// Reads the header from the first 24 of `bytes`.
    ///
    /// # Errors
    /// [`Error::ShortHeader`], [`Error::Magic`] or [`Error::TypeDigits`].
    #[inline]
    pub fn decode(bytes: &[u8]) -> Result<Self, Error> {
        let (raw, _) = RawHeader::ref_from_prefix(bytes).map_err(|_| Error::ShortHeader {
            expected: Self::SIZE,
            found: bytes.len(),
        })?;
        if raw.magic != Self::MAGIC {
            return Err(Error::Magic { found: raw.magic });
        }
        let message_type = MessageType::from_digits(raw.message_type).ok_or(Error::TypeDigits {
            found: raw.message_type,
        })?;
        Ok(raw.header(message_type))
    }

    /// The 24 bytes of the header; [`Header::decode`] of them gives the same header back.
    #[inline]
    pub fn encode(&self) -> [u8; Self::SIZE] {
        zerocopy::transmute!(RawHeader {
            magic: Self::MAGIC,
            message_type: self.message_type.digits(),
            sample: self.sample.into(),
            counter: self.counter.0,
            items: self.items,
            time_ms: self.time_ms.into(),
            character: self.character,
            body_segments: self.body_segments,
            props: self.props,
            finger_segments: self.finger_segments,
            reserved: self.reserved,
            payload_size: self.payload_size.into(),
        })
    }

    /// Which revision wrote the header: Rev J when its last seven bytes are all zero.
    pub const fn revision(&self) -> Revision {
        let [first, second] = self.reserved;
        let zero = self.body_segments == 0
            && self.props == 0
            && self.finger_segments == 0
            && first == 0
            && second == 0
            && self.payload_size == 0;
        if zero { Revision::J } else { Revision::N }
    }

    /// The segment counts as the header states them, all 0 in Rev J.
    pub const fn segment_counts(&self) -> SegmentCounts {
        SegmentCounts {
            body: self.body_segments,
            props: self.props,
            fingers: self.finger_segments,
        }
    }
}

impl fmt::Display for Header {
    /// One line: `MXTP02 char 0 sample 6681 time 27.837s 0x80`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "MXTP{} char {} sample {} time {}.{:03}s {}",
            self.message_type,
            self.character,
            self.sample,
            self.time_ms / 1000,
            self.time_ms % 1000,
            self.counter,
        )
    }
}

/// The header as it is on the wire, big-endian (MV0305 2.4.1).
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | `MXTP` |
/// | 4 | 2 | message type, two decimal digits |
/// | 6 | 4 | sample counter |
/// | 10 | 1 | datagram counter |
/// | 11 | 1 | number of items |
/// | 12 | 4 | time code, milliseconds |
/// | 16 | 1 | character ID |
/// | 17 | 1 | number of body segments (Rev N) |
/// | 18 | 1 | number of props (Rev N) |
/// | 19 | 1 | number of finger segments (Rev N) |
/// | 20 | 2 | reserved |
/// | 22 | 2 | payload size (Rev N) |
#[derive(FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
struct RawHeader {
    magic: [u8; 4],
    message_type: [u8; 2],
    sample: U32,
    counter: u8,
    items: u8,
    time_ms: U32,
    character: u8,
    body_segments: u8,
    props: u8,
    finger_segments: u8,
    reserved: [u8; 2],
    payload_size: U16,
}

impl RawHeader {
    #[inline]
    fn header(&self, message_type: MessageType) -> Header {
        Header {
            message_type,
            sample: self.sample.get(),
            counter: DatagramCounter(self.counter),
            items: self.items,
            time_ms: self.time_ms.get(),
            character: self.character,
            body_segments: self.body_segments,
            props: self.props,
            finger_segments: self.finger_segments,
            reserved: self.reserved,
            payload_size: self.payload_size.get(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_its_place() {
        let header = Header {
            sample: 0x0102_0304,
            counter: DatagramCounter(5),
            items: 6,
            time_ms: 0x0708_090A,
            character: 11,
            body_segments: 12,
            props: 13,
            finger_segments: 14,
            reserved: [15, 16],
            payload_size: 0x1112,
            ..Header::rev_j(MessageType::META, 0, 0)
        };
        let bytes = header.encode();
        assert_eq!(&bytes[..6], b"MXTP12");
        assert!(bytes[6..].iter().copied().eq(1..=18));
        assert_eq!(Header::decode(&bytes), Ok(header));
    }

    #[test]
    fn revisions_are_told_apart_by_the_last_seven_bytes() {
        let old = Header::rev_j(MessageType::QUATERNION, 1, 2);
        assert_eq!(old.revision(), Revision::J);
        let new = Header::rev_n(MessageType::QUATERNION, 1, 2, SegmentCounts::BODY);
        assert_eq!(new.revision(), Revision::N);
        let sized = Header { payload_size: 1, ..old };
        assert_eq!(sized.revision(), Revision::N);
    }

    #[test]
    fn bad_headers_say_what_was_found() {
        let short = Error::ShortHeader { expected: 24, found: 3 };
        assert_eq!(Header::decode(b"MXT"), Err(short));
        let mut bytes = Header::rev_j(MessageType::META, 0, 0).encode();
        bytes[5] = b'x';
        assert_eq!(Header::decode(&bytes), Err(Error::TypeDigits { found: *b"1x" }));
        bytes[0] = 0;
        assert_eq!(Header::decode(&bytes), Err(Error::Magic { found: *b"\0XTP" }));
    }

    #[test]
    fn message_types_read_and_print_two_digits() {
        assert_eq!("02".parse(), Ok(MessageType::QUATERNION));
        assert_eq!(MessageType::QUATERNION.to_string(), "02");
        for text in ["2", "002", "0x", "", "é"] {
            let error = Error::TypeText { found: text.into() };
            assert_eq!(text.parse::<MessageType>(), Err(error));
        }
        assert_eq!(MessageType::new(100), None);
        assert_eq!(MessageType::new(99).unwrap().name(), "unknown");
    }

    #[test]
    fn counters_split_into_index_and_last_flag() {
        assert_eq!(DatagramCounter::part(2, true), DatagramCounter(0x82));
        assert_eq!(DatagramCounter::part(0, true), DatagramCounter::SINGLE);
        assert_eq!(DatagramCounter(0x82).index(), 2);
        assert!(DatagramCounter(0x82).is_last());
        assert!(!DatagramCounter::part(1, false).is_last());
    }
}
