//! Type 03: positions of points (MV0305 2.5.4).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::PointId;
use crate::{Header, Quirk, Quirks};

/// Position of a point, 16 bytes (MV0305 2.5.4).
///
/// Right-handed, X to the left, Y up, Z forward; centimetres. Section 2.5.4 gives the ID as
/// 100 x segment + point and section 2.5.10 as 256 x segment + point: the latter is sent, and the
/// raw number is kept.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | point ID |
/// | 4 | 12 | position x, y, z, cm |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct PointPosition {
    id: U32,
    position: [F32; 3],
}

impl PointPosition {
    /// A point at a position in centimetres.
    #[inline]
    pub fn new(id: PointId, position: [f32; 3]) -> Self {
        Self {
            id: id.0.into(),
            position: wire(position),
        }
    }

    /// Which point, as it came.
    #[inline]
    pub fn id(&self) -> PointId {
        PointId(self.id.get())
    }

    /// Position x, y, z in centimetres, Y up.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }
}

pub(super) fn check(header: &Header, points: &[PointPosition], quirks: &mut Quirks) {
    let counts = header.segment_counts();
    let known = points.iter().all(|point| counts.may_have(point.id().segment()));
    quirks.insert_if(!known, Quirk::PointId);
}
