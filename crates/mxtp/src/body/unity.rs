//! Type 05: pose for Unity (MV0305 2.5.5).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::SegmentId;

/// Position and orientation of a segment for Unity, 32 bytes (MV0305 2.5.5).
///
/// Left-handed, Y up, metres. The pelvis is global; the other segments have a rotation local to
/// their parent and a position relative to it. The segments come in the order of
/// [`UNITY_ORDER`](posewire_motion::standard::UNITY_ORDER) and are numbered 1 to 23 in that order.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 12 | position x, y, z, m |
/// | 16 | 16 | orientation w, x, y, z |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct UnitySegment {
    id: U32,
    position: [F32; 3],
    orientation: [F32; 4],
}

impl UnitySegment {
    /// A segment at a position in metres with an orientation w, x, y, z.
    #[inline]
    pub fn new(id: SegmentId, position: [f32; 3], orientation: [f32; 4]) -> Self {
        Self {
            id: id.0.into(),
            position: wire(position),
            orientation: wire(orientation),
        }
    }

    /// Which segment, numbered in Unity order.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Position x, y, z in metres, Y up, left-handed; relative to the parent except for the pelvis.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }

    /// Unit quaternion w, x, y, z, left-handed; local to the parent except for the pelvis.
    #[inline]
    pub fn orientation(&self) -> [f32; 4] {
        floats(self.orientation)
    }
}
