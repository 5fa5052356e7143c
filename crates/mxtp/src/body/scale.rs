//! Type 13: scale, the null pose and the points on the segments (MV0305 2.6.2).

use zerocopy::byteorder::big_endian::{F32, I32, U16, U32};
use zerocopy::{FromBytes, Immutable, KnownLayout, Unaligned};

use super::{Body, Text, floats, truncated};
use crate::ids::SegmentId;
use crate::{DatagramCounter, Error, Header, Quirk, Quirks};

/// Bytes of a segment with an empty name.
pub(crate) const SEGMENT_MIN: usize = 16;

/// Bytes of a point with an empty name.
pub(crate) const POINT_MIN: usize = 24;

const COUNT: usize = 4;

/// The null pose, a T-pose with every orientation the identity, or some of the points on the
/// segments (MV0305 2.6.2).
///
/// A sequence of datagrams describes a character: the first holds the segments and no points, the
/// others points and no segments. Each stands alone.
///
/// Right-handed, X forward, Y left, Z up, metres.
///
/// | bytes | field |
/// |---|---|
/// | 4 | number of segments |
/// | ... | per segment: name (length in 4 bytes, text), origin x, y, z in the null pose |
/// | 4 | number of points |
/// | ... | per point: segment ID (2), local ID (2), name, flags (4), position x, y, z |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Scale<'a> {
    segment_count: u32,
    segments: &'a [u8],
    point_count: u32,
    points: &'a [u8],
}

/// A segment of the null pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleSegment<'a> {
    /// The name, without spaces.
    pub name: Text<'a>,
    /// Origin in the null pose, metres, Z up.
    pub origin: [f32; 3],
}

/// A point on a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalePoint<'a> {
    /// The segment the point is on.
    pub segment: u16,
    /// The number of the point on its segment.
    pub local: u16,
    /// The name.
    pub name: Text<'a>,
    /// The point's characteristics; the specification does not list the bits.
    pub flags: u32,
    /// Position relative to the segment's origin in the null pose, metres, Z up.
    pub position: [f32; 3],
}

impl<'a> Scale<'a> {
    /// Number of segments.
    pub const fn segment_count(&self) -> usize {
        self.segment_count as usize
    }

    /// Number of points.
    pub const fn point_count(&self) -> usize {
        self.point_count as usize
    }

    /// The segments, in the order of their IDs.
    pub fn segments(&self) -> impl Iterator<Item = ScaleSegment<'a>> + use<'a> {
        let mut cursor = Cursor::new(self.segments, 0);
        (0..self.segment_count).map_while(move |_| cursor.segment().ok())
    }

    /// The points, in the order they came.
    pub fn points(&self) -> impl Iterator<Item = ScalePoint<'a>> + use<'a> {
        let mut cursor = Cursor::new(self.points, 0);
        (0..self.point_count).map_while(move |_| cursor.point().ok())
    }

    /// Bytes on the wire.
    pub const fn size(&self) -> usize {
        COUNT + self.segments.len() + COUNT + self.points.len()
    }

    pub(super) fn encode(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.segment_count.to_be_bytes());
        out.extend_from_slice(self.segments);
        out.extend_from_slice(&self.point_count.to_be_bytes());
        out.extend_from_slice(self.points);
    }
}

/// Segments or points being collected for a scale datagram. Reusable: [`clear`](Self::clear) keeps
/// the memory.
#[derive(Clone, Debug, Default)]
pub struct ScaleBuffer {
    segment_count: u32,
    segments: Vec<u8>,
    point_count: u32,
    points: Vec<u8>,
}

impl ScaleBuffer {
    /// An empty buffer.
    pub fn new() -> Self {
        Self::default()
    }

    /// Removes all segments and points.
    pub fn clear(&mut self) {
        self.segment_count = 0;
        self.segments.clear();
        self.point_count = 0;
        self.points.clear();
    }

    /// Adds a segment with its origin in the null pose, metres, Z up.
    pub fn push_segment(&mut self, name: &str, origin: [f32; 3]) {
        self.segment_count += 1;
        push_text(&mut self.segments, Text::from(name));
        push_vector(&mut self.segments, origin);
    }

    /// Adds a point.
    pub fn push_point(&mut self, point: &ScalePoint<'_>) {
        self.point_count += 1;
        self.points.extend_from_slice(&point.segment.to_be_bytes());
        self.points.extend_from_slice(&point.local.to_be_bytes());
        push_text(&mut self.points, point.name);
        self.points.extend_from_slice(&point.flags.to_be_bytes());
        push_vector(&mut self.points, point.position);
    }

    /// What has been collected, for [`Body::Scale`].
    pub fn as_scale(&self) -> Scale<'_> {
        Scale {
            segment_count: self.segment_count,
            segments: &self.segments,
            point_count: self.point_count,
            points: &self.points,
        }
    }
}

pub(super) fn decode<'a>(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Body<'a>, &'a [u8]), Error> {
    let mut cursor = Cursor::new(bytes, Header::SIZE);
    let (scale, utf8) = walk(&mut cursor).map_err(|fault| fault.error(header))?;
    quirks.insert_if(!utf8, Quirk::TextNotUtf8);
    let (segments, points) = (scale.segment_count > 0, scale.point_count > 0);
    let single = header.counter == DatagramCounter::SINGLE;
    quirks.insert_if(segments && points, Quirk::ScaleCombined);
    quirks.insert_if(segments && single, Quirk::ScaleSingleDatagram);
    let counts = header.segment_counts();
    let known = |point: ScalePoint<'_>| counts.may_have(SegmentId(point.segment.into()));
    quirks.insert_if(!scale.points().all(known), Quirk::PointId);
    Ok((Body::Scale(scale), cursor.left))
}

/// Checks every length, and finds where the segments and points are.
fn walk<'a>(cursor: &mut Cursor<'a>) -> Result<(Scale<'a>, bool), Fault> {
    let mut utf8 = true;
    let segment_count = cursor.count("segment count", SEGMENT_MIN)?;
    let from = cursor.left;
    for _ in 0..segment_count {
        utf8 &= cursor.segment()?.name.is_utf8();
    }
    let segments = &from[..from.len() - cursor.left.len()];
    let point_count = cursor.count("point count", POINT_MIN)?;
    let from = cursor.left;
    for _ in 0..point_count {
        utf8 &= cursor.point()?.name.is_utf8();
    }
    let points = &from[..from.len() - cursor.left.len()];
    let scale = Scale {
        segment_count,
        segments,
        point_count,
        points,
    };
    Ok((scale, utf8))
}

/// What went wrong at which offset, without the type of the datagram.
struct Fault {
    field: &'static str,
    offset: usize,
    kind: FaultKind,
}

enum FaultKind {
    Truncated { expected: usize, found: usize },
    Count { limit: usize, found: i64 },
}

impl Fault {
    fn error(self, header: &Header) -> Error {
        match self.kind {
            FaultKind::Truncated { expected, found } => truncated(header, self.field, expected, found, self.offset),
            FaultKind::Count { limit, found } => Error::Count {
                message_type: header.message_type,
                field: self.field,
                limit,
                found,
                offset: self.offset,
            },
        }
    }
}

#[derive(FromBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
struct PointIds {
    segment: U16,
    local: U16,
}

#[derive(FromBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
struct PointValues {
    flags: U32,
    position: [F32; 3],
}

/// Reads from the front of the bytes left, and knows the offset in the datagram.
struct Cursor<'a> {
    left: &'a [u8],
    offset: usize,
}

impl<'a> Cursor<'a> {
    const fn new(left: &'a [u8], offset: usize) -> Self {
        Self { left, offset }
    }

    fn segment(&mut self) -> Result<ScaleSegment<'a>, Fault> {
        let name = self.text("segment name")?;
        let origin = *self.value::<[F32; 3]>("segment origin")?;
        let origin = floats(origin);
        Ok(ScaleSegment { name, origin })
    }

    fn point(&mut self) -> Result<ScalePoint<'a>, Fault> {
        let ids = self.value::<PointIds>("point ID")?;
        let name = self.text("point name")?;
        let values = self.value::<PointValues>("point position")?;
        Ok(ScalePoint {
            segment: ids.segment.get(),
            local: ids.local.get(),
            name,
            flags: values.flags.get(),
            position: floats(values.position),
        })
    }

    /// A count of things that each need at least `minimum` bytes.
    fn count(&mut self, field: &'static str, minimum: usize) -> Result<u32, Fault> {
        let offset = self.offset;
        let found = self.value::<U32>(field)?.get();
        let limit = self.left.len() / minimum;
        if found as usize > limit {
            return Err(Fault::count(field, offset, limit, found.into()));
        }
        Ok(found)
    }

    fn text(&mut self, field: &'static str) -> Result<Text<'a>, Fault> {
        let offset = self.offset;
        let found = self.value::<I32>(field)?.get();
        let limit = self.left.len();
        match usize::try_from(found) {
            Ok(length) if length <= limit => self.take(field, length).map(Text::new),
            _ => Err(Fault::count(field, offset, limit, found.into())),
        }
    }

    fn value<T>(&mut self, field: &'static str) -> Result<&'a T, Fault>
    where
        T: FromBytes + KnownLayout + Immutable + Unaligned,
    {
        let offset = self.offset;
        let bytes = self.take(field, size_of::<T>())?;
        T::ref_from_bytes(bytes).map_err(|_| Fault::truncated(field, offset, size_of::<T>(), bytes.len()))
    }

    fn take(&mut self, field: &'static str, size: usize) -> Result<&'a [u8], Fault> {
        let found = self.left.len();
        let (taken, left) = self
            .left
            .split_at_checked(size)
            .ok_or_else(|| Fault::truncated(field, self.offset, size, found))?;
        self.left = left;
        self.offset += size;
        Ok(taken)
    }
}

impl Fault {
    const fn truncated(field: &'static str, offset: usize, expected: usize, found: usize) -> Self {
        let kind = FaultKind::Truncated { expected, found };
        Self { field, offset, kind }
    }

    const fn count(field: &'static str, offset: usize, limit: usize, found: i64) -> Self {
        let kind = FaultKind::Count { limit, found };
        Self { field, offset, kind }
    }
}

fn push_text(out: &mut Vec<u8>, text: Text<'_>) {
    out.extend_from_slice(&(text.as_bytes().len() as u32).to_be_bytes());
    out.extend_from_slice(text.as_bytes());
}

fn push_vector(out: &mut Vec<u8>, vector: [f32; 3]) {
    for value in vector {
        out.extend_from_slice(&value.to_be_bytes());
    }
}
