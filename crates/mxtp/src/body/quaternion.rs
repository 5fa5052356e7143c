//! Type 02: pose with quaternions (MV0305 2.5.3).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::SegmentId;

/// Absolute position and orientation of a segment, 32 bytes (MV0305 2.5.3).
///
/// Right-handed, X forward, Y left, Z up. The specification gives positions in centimetres; they
/// are metres.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 12 | position x, y, z, m |
/// | 16 | 16 | orientation w, x, y, z |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct QuaternionSegment {
    id: U32,
    position: [F32; 3],
    orientation: [F32; 4],
}

impl QuaternionSegment {
    /// A segment at a position in metres with an orientation w, x, y, z.
    #[inline]
    pub fn new(id: SegmentId, position: [f32; 3], orientation: [f32; 4]) -> Self {
        Self {
            id: id.0.into(),
            position: wire(position),
            orientation: wire(orientation),
        }
    }

    /// Which segment.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Position x, y, z in metres, Z up.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }

    /// Unit quaternion w, x, y, z; the identity in the T-pose.
    #[inline]
    pub fn orientation(&self) -> [f32; 4] {
        floats(self.orientation)
    }
}
