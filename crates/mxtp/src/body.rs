//! What follows the header: one module per datagram type.
//!
//! Types with equal items are slices of records borrowed from the datagram; a record is the byte
//! table of the specification. Meta data and scale are checked views with iterators.

mod angular;
mod center_of_mass;
mod display;
mod euler;
mod joint_angles;
mod linear;
mod meta;
mod points;
mod quaternion;
mod scale;
mod text;
mod time_code;
mod trackers;
mod unity;

use zerocopy::byteorder::big_endian::F32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::ids::{SegmentId, joint_quirks, numbering_quirk, part_numbering_quirk};
use crate::{DatagramCounter, Error, Header, MessageType, Quirk, Quirks, Revision};

pub use angular::AngularSegment;
pub use center_of_mass::{CenterOfMass, CenterOfMassPosition};
pub use euler::EulerSegment;
pub use joint_angles::JointAngles;
pub use linear::LinearSegment;
pub use meta::{Meta, Tag, push_tag};
pub use points::PointPosition;
pub use quaternion::QuaternionSegment;
pub use scale::{Scale, ScaleBuffer, ScalePoint, ScaleSegment};
pub use text::Text;
pub use time_code::TimeCode;
pub use trackers::{ShortTracker, Tracker};
pub use unity::UnitySegment;

pub(crate) use scale::{POINT_MIN as SCALE_POINT_MIN, SEGMENT_MIN as SCALE_SEGMENT_MIN};

/// The payload of a datagram.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body<'a> {
    /// Type 01.
    Euler(&'a [EulerSegment]),
    /// Type 02.
    Quaternion(&'a [QuaternionSegment]),
    /// Type 03.
    Points(&'a [PointPosition]),
    /// Type 05, in the order of [`UNITY_ORDER`](posewire_motion::standard::UNITY_ORDER).
    Unity(&'a [UnitySegment]),
    /// Type 12.
    Meta(Meta<'a>),
    /// Type 13.
    Scale(Scale<'a>),
    /// Type 20.
    JointAngles(&'a [JointAngles]),
    /// Type 21.
    Linear(&'a [LinearSegment]),
    /// Type 22.
    Angular(&'a [AngularSegment]),
    /// Type 23 with items of 68 bytes.
    Trackers(&'a [Tracker]),
    /// Type 23 with items of 44 bytes.
    TrackersShort(&'a [ShortTracker]),
    /// Type 24 with 36 bytes.
    CenterOfMass(&'a CenterOfMass),
    /// Type 24 with 12 bytes.
    CenterOfMassShort(&'a CenterOfMassPosition),
    /// Type 25.
    TimeCode(TimeCode),
    /// The bytes of types 04, 10, 11 and of types the specification does not have.
    Opaque(&'a [u8]),
}

impl<'a> Body<'a> {
    /// The type of datagram that carries this body; `None` for opaque bytes.
    pub const fn message_type(&self) -> Option<MessageType> {
        Some(match self {
            Self::Euler(_) => MessageType::EULER,
            Self::Quaternion(_) => MessageType::QUATERNION,
            Self::Points(_) => MessageType::POINTS,
            Self::Unity(_) => MessageType::UNITY,
            Self::Meta(_) => MessageType::META,
            Self::Scale(_) => MessageType::SCALE,
            Self::JointAngles(_) => MessageType::JOINT_ANGLES,
            Self::Linear(_) => MessageType::LINEAR,
            Self::Angular(_) => MessageType::ANGULAR,
            Self::Trackers(_) | Self::TrackersShort(_) => MessageType::TRACKERS,
            Self::CenterOfMass(_) | Self::CenterOfMassShort(_) => MessageType::CENTER_OF_MASS,
            Self::TimeCode(_) => MessageType::TIME_CODE,
            Self::Opaque(_) => return None,
        })
    }

    /// Number of items as a header states it: 0 for scale, 1 for what comes once; `None` for opaque
    /// bytes, whose items are not known.
    pub const fn items(&self) -> Option<usize> {
        Some(match self {
            Self::Euler(items) => items.len(),
            Self::Quaternion(items) => items.len(),
            Self::Points(items) => items.len(),
            Self::Unity(items) => items.len(),
            Self::JointAngles(items) => items.len(),
            Self::Linear(items) => items.len(),
            Self::Angular(items) => items.len(),
            Self::Trackers(items) => items.len(),
            Self::TrackersShort(items) => items.len(),
            Self::Scale(_) => 0,
            Self::Meta(_) | Self::CenterOfMass(_) | Self::CenterOfMassShort(_) | Self::TimeCode(_) => 1,
            Self::Opaque(_) => return None,
        })
    }

    /// Bytes of the body on the wire.
    pub fn size(&self) -> usize {
        match self {
            Self::Meta(meta) => meta.size(),
            Self::Scale(scale) => scale.size(),
            Self::TimeCode(time_code) => time_code.size(),
            fixed => fixed.fixed_bytes().len(),
        }
    }

    /// Appends the bytes of the body to `out`.
    #[inline]
    pub fn encode(&self, out: &mut Vec<u8>) {
        match self {
            Self::Meta(meta) => meta.encode(out),
            Self::Scale(scale) => scale.encode(out),
            Self::TimeCode(time_code) => time_code.encode(out),
            fixed => out.extend_from_slice(fixed.fixed_bytes()),
        }
    }

    /// Reads the body of a datagram and what follows it.
    #[inline]
    pub(crate) fn decode(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Self, &'a [u8]), Error> {
        match header.message_type {
            MessageType::EULER => {
                let (items, rest) = records(header, bytes, quirks)?;
                segment_quirks(header, items, EulerSegment::id, quirks);
                Ok((Self::Euler(items), rest))
            }
            MessageType::QUATERNION => {
                let (items, rest) = records(header, bytes, quirks)?;
                segment_quirks(header, items, QuaternionSegment::id, quirks);
                Ok((Self::Quaternion(items), rest))
            }
            MessageType::LINEAR => {
                let (items, rest) = records(header, bytes, quirks)?;
                segment_quirks(header, items, LinearSegment::id, quirks);
                Ok((Self::Linear(items), rest))
            }
            MessageType::ANGULAR => {
                let (items, rest) = records(header, bytes, quirks)?;
                segment_quirks(header, items, AngularSegment::id, quirks);
                Ok((Self::Angular(items), rest))
            }
            MessageType::UNITY => {
                let (items, rest) = records(header, bytes, quirks)?;
                numbering_quirks(header, items, UnitySegment::id, quirks);
                Ok((Self::Unity(items), rest))
            }
            _ => Self::decode_other(header, bytes, quirks),
        }
    }

    /// The types that are not poses of segments.
    fn decode_other(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Self, &'a [u8]), Error> {
        match header.message_type {
            MessageType::POINTS => {
                let (items, rest) = records(header, bytes, quirks)?;
                points::check(header, items, quirks);
                Ok((Self::Points(items), rest))
            }
            MessageType::JOINT_ANGLES => {
                let (items, rest) = records(header, bytes, quirks)?;
                let pairs = items.iter().map(|j: &JointAngles| (j.parent(), j.child()));
                let whole = header.counter == DatagramCounter::SINGLE;
                *quirks = quirks.union(joint_quirks(pairs, whole));
                Ok((Self::JointAngles(items), rest))
            }
            MessageType::TRACKERS => trackers::decode(header, bytes, quirks),
            MessageType::CENTER_OF_MASS => center_of_mass::decode(header, bytes, quirks),
            MessageType::TIME_CODE => time_code::decode(header, bytes, quirks),
            MessageType::META => meta::decode(header, bytes, quirks),
            MessageType::SCALE => scale::decode(header, bytes, quirks),
            _ => Ok((Self::Opaque(bytes), &[])),
        }
    }

    /// The bytes of a body that is one run of records, as they are on the wire; nothing for the
    /// three other types.
    fn fixed_bytes(&self) -> &'a [u8] {
        match *self {
            Self::Euler(items) => items.as_bytes(),
            Self::Quaternion(items) => items.as_bytes(),
            Self::Points(items) => items.as_bytes(),
            Self::Unity(items) => items.as_bytes(),
            Self::JointAngles(items) => items.as_bytes(),
            Self::Linear(items) => items.as_bytes(),
            Self::Angular(items) => items.as_bytes(),
            Self::Trackers(items) => items.as_bytes(),
            Self::TrackersShort(items) => items.as_bytes(),
            Self::CenterOfMass(item) => item.as_bytes(),
            Self::CenterOfMassShort(item) => item.as_bytes(),
            Self::Opaque(bytes) => bytes,
            Self::Meta(_) | Self::Scale(_) | Self::TimeCode(_) => &[],
        }
    }
}

/// Reads a payload of equal records: all that the bytes hold when they divide evenly, else as many
/// as the header says when what follows can be told from them.
#[inline]
fn records<'a, T>(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(&'a [T], &'a [u8]), Error>
where
    T: FromBytes + Immutable + KnownLayout,
{
    let stated = usize::from(header.items);
    let count = record_count(header, bytes.len(), size_of::<T>())
        .ok_or_else(|| payload_size_error(header, size_of::<T>(), bytes.len()))?;
    if count != stated {
        quirks.insert(item_count_quirk(stated));
    }
    <[T]>::ref_from_prefix_with_elems(bytes, count).map_err(|_| payload_size_error(header, size_of::<T>(), bytes.len()))
}

/// How many records of a size a payload holds, when that can be told.
#[inline]
fn record_count(header: &Header, found: usize, item_size: usize) -> Option<usize> {
    if found.is_multiple_of(item_size) {
        return Some(found / item_size);
    }
    let by_items = usize::from(header.items);
    let payload_size = usize::from(header.payload_size);
    let by_size = payload_size
        .is_multiple_of(item_size)
        .then_some(payload_size / item_size);
    [Some(by_items), by_size]
        .into_iter()
        .flatten()
        .find(|count| *count > 0 && count * item_size <= found)
}

#[cold]
fn payload_size_error(header: &Header, item_size: usize, found: usize) -> Error {
    Error::PayloadSize {
        message_type: header.message_type,
        items: header.items,
        item_size,
        found,
        offset: Header::SIZE,
    }
}

/// Checks the item count of a type that has one item.
fn one_item_quirk(header: &Header, quirks: &mut Quirks) {
    if header.items != 1 {
        quirks.insert(item_count_quirk(usize::from(header.items)));
    }
}

const fn item_count_quirk(stated: usize) -> Quirk {
    match stated {
        0 => Quirk::ItemCountZero,
        _ => Quirk::ItemCount,
    }
}

/// Checks the numbering of segments, and their count against the header's. Fewer segments than the
/// header counts are regular: what does not exist is left out (MV0305 2.5.1).
#[inline]
fn segment_quirks<T>(header: &Header, items: &[T], id: fn(&T) -> SegmentId, quirks: &mut Quirks) {
    numbering_quirks(header, items, id, quirks);
    let counts = header.segment_counts();
    if counts.body == 0 {
        quirks.insert_if(header.revision() == Revision::N, Quirk::SegmentCountsZero);
    } else {
        quirks.insert_if(items.len() > counts.total(), Quirk::SegmentCounts);
    }
}

#[inline]
fn numbering_quirks<T>(header: &Header, items: &[T], id: fn(&T) -> SegmentId, quirks: &mut Quirks) {
    let ids = items.iter().map(id);
    let unusual = if header.counter == DatagramCounter::SINGLE {
        numbering_quirk(&ids, header.segment_counts())
    } else {
        part_numbering_quirk(&ids, header.segment_counts())
    };
    if let Some(quirk) = unusual {
        quirks.insert(quirk);
    }
}

/// The error of a field that needs more bytes than are left.
fn truncated(header: &Header, field: &'static str, expected: usize, found: usize, offset: usize) -> Error {
    Error::Truncated {
        message_type: header.message_type,
        field,
        expected,
        found,
        offset,
    }
}

#[inline]
fn floats<const N: usize>(wire: [F32; N]) -> [f32; N] {
    wire.map(F32::get)
}

#[inline]
fn wire<const N: usize>(values: [f32; N]) -> [F32; N] {
    values.map(F32::new)
}
