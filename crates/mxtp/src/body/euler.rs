//! Type 01: pose with Euler angles (MV0305 2.5.2).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::SegmentId;

/// Absolute position and Euler angles of a segment, 28 bytes (MV0305 2.5.2).
///
/// Right-handed, X to the left, Y up, Z forward; centimetres and degrees. The rotation matrix is
/// `Rz(z) * Ry(y) * Rx(x)` and acts on column vectors.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 12 | position x, y, z, cm |
/// | 16 | 12 | rotation x, y, z, degrees |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct EulerSegment {
    id: U32,
    position: [F32; 3],
    rotation: [F32; 3],
}

impl EulerSegment {
    /// A segment at a position in centimetres with angles in degrees.
    #[inline]
    pub fn new(id: SegmentId, position: [f32; 3], rotation: [f32; 3]) -> Self {
        Self {
            id: id.0.into(),
            position: wire(position),
            rotation: wire(rotation),
        }
    }

    /// Which segment.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Position x, y, z in centimetres, Y up.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }

    /// Angles about x, y, z in degrees, Y up.
    #[inline]
    pub fn rotation(&self) -> [f32; 3] {
        floats(self.rotation)
    }
}
