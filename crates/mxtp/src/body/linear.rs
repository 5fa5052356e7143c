//! Type 21: linear segment kinematics (MV0305 2.7.2).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::SegmentId;

/// Position, velocity and acceleration of a segment, 40 bytes (MV0305 2.7.2).
///
/// Global, right-handed, X forward, Y left, Z up; metres and seconds.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 12 | position x, y, z, m |
/// | 16 | 12 | velocity x, y, z, m/s |
/// | 28 | 12 | acceleration x, y, z, m/s² |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct LinearSegment {
    id: U32,
    position: [F32; 3],
    velocity: [F32; 3],
    acceleration: [F32; 3],
}

impl LinearSegment {
    /// A segment with its motion in m, m/s and m/s².
    #[inline]
    pub fn new(id: SegmentId, position: [f32; 3], velocity: [f32; 3], acceleration: [f32; 3]) -> Self {
        Self {
            id: id.0.into(),
            position: wire(position),
            velocity: wire(velocity),
            acceleration: wire(acceleration),
        }
    }

    /// Which segment.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Position in metres, Z up.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }

    /// Global velocity in m/s.
    #[inline]
    pub fn velocity(&self) -> [f32; 3] {
        floats(self.velocity)
    }

    /// Global acceleration in m/s².
    #[inline]
    pub fn acceleration(&self) -> [f32; 3] {
        floats(self.acceleration)
    }
}
