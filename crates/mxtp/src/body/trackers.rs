//! Type 23: motion trackers (MV0305 2.7.4).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{Body, floats, record_count, records, wire};
use crate::ids::{SegmentId, carries_tracker};
use crate::{Error, Header, Quirk, Quirks};

/// One motion tracker, 68 bytes (MV0305 Rev J 2.7.4; Rev N lists fewer fields).
///
/// Orientation and free acceleration are global (right-handed, Z up), the rest is in the tracker's
/// own axes.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 16 | orientation w, x, y, z |
/// | 20 | 12 | free acceleration x, y, z, m/s² |
/// | 32 | 12 | acceleration x, y, z, m/s² |
/// | 44 | 12 | angular velocity x, y, z, rad/s |
/// | 56 | 12 | magnetic field x, y, z, arbitrary units |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct Tracker {
    id: U32,
    orientation: [F32; 4],
    free_acceleration: [F32; 3],
    acceleration: [F32; 3],
    angular_velocity: [F32; 3],
    magnetic_field: [F32; 3],
}

impl Tracker {
    /// A tracker with its orientation w, x, y, z; the rest is zero until set by the other methods.
    #[inline]
    pub fn new(id: SegmentId, orientation: [f32; 4]) -> Self {
        Self {
            id: id.0.into(),
            orientation: wire(orientation),
            free_acceleration: [F32::ZERO; 3],
            acceleration: [F32::ZERO; 3],
            angular_velocity: [F32::ZERO; 3],
            magnetic_field: [F32::ZERO; 3],
        }
    }

    /// The same tracker with a global free acceleration in m/s².
    #[must_use]
    pub fn with_free_acceleration(self, value: [f32; 3]) -> Self {
        Self {
            free_acceleration: wire(value),
            ..self
        }
    }

    /// The same tracker with an acceleration in its own axes in m/s².
    #[must_use]
    pub fn with_acceleration(self, value: [f32; 3]) -> Self {
        Self {
            acceleration: wire(value),
            ..self
        }
    }

    /// The same tracker with an angular velocity in its own axes in rad/s.
    #[must_use]
    pub fn with_angular_velocity(self, value: [f32; 3]) -> Self {
        Self {
            angular_velocity: wire(value),
            ..self
        }
    }

    /// The same tracker with a magnetic field in its own axes, arbitrary units.
    #[must_use]
    pub fn with_magnetic_field(self, value: [f32; 3]) -> Self {
        Self {
            magnetic_field: wire(value),
            ..self
        }
    }

    /// The segment the tracker is on.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Global unit quaternion w, x, y, z.
    #[inline]
    pub fn orientation(&self) -> [f32; 4] {
        floats(self.orientation)
    }

    /// Global acceleration without gravity, m/s².
    #[inline]
    pub fn free_acceleration(&self) -> [f32; 3] {
        floats(self.free_acceleration)
    }

    /// Acceleration in the tracker's axes, m/s².
    #[inline]
    pub fn acceleration(&self) -> [f32; 3] {
        floats(self.acceleration)
    }

    /// Angular velocity in the tracker's axes, rad/s.
    #[inline]
    pub fn angular_velocity(&self) -> [f32; 3] {
        floats(self.angular_velocity)
    }

    /// Magnetic field in the tracker's axes, arbitrary units (norm about 1).
    #[inline]
    pub fn magnetic_field(&self) -> [f32; 3] {
        floats(self.magnetic_field)
    }
}

/// One motion tracker in the short form, 44 bytes (MV0305 Rev N 2.7.4).
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 16 | orientation w, x, y, z |
/// | 20 | 12 | free acceleration x, y, z, m/s² |
/// | 32 | 12 | magnetic field x, y, z, arbitrary units |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct ShortTracker {
    id: U32,
    orientation: [F32; 4],
    free_acceleration: [F32; 3],
    magnetic_field: [F32; 3],
}

impl ShortTracker {
    /// A tracker with its orientation w, x, y, z, global free acceleration in m/s² and
    /// magnetic field in its own axes in arbitrary units.
    #[inline]
    pub fn new(id: SegmentId, orientation: [f32; 4], free_acceleration: [f32; 3], magnetic_field: [f32; 3]) -> Self {
        Self {
            id: id.0.into(),
            orientation: wire(orientation),
            free_acceleration: wire(free_acceleration),
            magnetic_field: wire(magnetic_field),
        }
    }

    /// The segment the tracker is on.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Global unit quaternion w, x, y, z.
    #[inline]
    pub fn orientation(&self) -> [f32; 4] {
        floats(self.orientation)
    }

    /// Global acceleration without gravity, m/s².
    #[inline]
    pub fn free_acceleration(&self) -> [f32; 3] {
        floats(self.free_acceleration)
    }

    /// Magnetic field in the tracker's axes, arbitrary units (norm about 1).
    #[inline]
    pub fn magnetic_field(&self) -> [f32; 3] {
        floats(self.magnetic_field)
    }
}

pub(super) fn decode<'a>(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Body<'a>, &'a [u8]), Error> {
    if is_short(header, bytes) {
        let (items, rest) = records(header, bytes, quirks)?;
        quirks.insert(Quirk::TrackersShort);
        check(items, ShortTracker::id, quirks);
        return Ok((Body::TrackersShort(items), rest));
    }
    let (items, rest) = records(header, bytes, quirks)?;
    check(items, Tracker::id, quirks);
    Ok((Body::Trackers(items), rest))
}

fn check<T>(items: &[T], id: fn(&T) -> SegmentId, quirks: &mut Quirks) {
    let known = items.iter().map(id).all(carries_tracker);
    quirks.insert_if(!known, Quirk::TrackerId);
}

/// Whether the items have 44 bytes rather than 68.
///
/// The stated sizes decide; 748 bytes are both 11 long and 17 short trackers, and then the segment
/// IDs tell when the header does not.
fn is_short(header: &Header, bytes: &[u8]) -> bool {
    const LONG: usize = size_of::<Tracker>();
    const SHORT: usize = size_of::<ShortTracker>();
    let items = usize::from(header.items);
    if items > 0 && (items * LONG == bytes.len() || items * SHORT == bytes.len()) {
        return items * SHORT == bytes.len();
    }
    let whole = |size| bytes.len().is_multiple_of(size);
    match (whole(LONG), whole(SHORT)) {
        (true, true) => !segments_at(bytes, LONG),
        (long, short) if long || short => short,
        _ => record_count(header, bytes.len(), LONG).is_none() && record_count(header, bytes.len(), SHORT).is_some(),
    }
}

/// Whether segment IDs stand at every step of this size.
fn segments_at(bytes: &[u8], step: usize) -> bool {
    bytes
        .chunks_exact(step)
        .filter_map(<[u8]>::first_chunk)
        .all(|id| (1..=67).contains(&u32::from_be_bytes(*id)))
}
