//! The 24 bytes in front of every datagram (MV0305 2.4.1).

use std::fmt;

use zerocopy::byteorder::big_endian::{U16, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::ids::SegmentCounts;
use crate::{Error, MessageType};

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
    fn counters_split_into_index_and_last_flag() {
        assert_eq!(DatagramCounter::part(2, true), DatagramCounter(0x82));
        assert_eq!(DatagramCounter::part(0, true), DatagramCounter::SINGLE);
        assert_eq!(DatagramCounter(0x82).index(), 2);
        assert!(DatagramCounter(0x82).is_last());
        assert!(!DatagramCounter::part(1, false).is_last());
    }
}
