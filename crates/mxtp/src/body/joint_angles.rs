//! Type 20: joint angles (MV0305 2.7.1).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::PointId;

/// Angles of one joint, 20 bytes (MV0305 2.7.1).
///
/// Degrees, from the Euler sequence Z, X, Y of the anatomical frames, given in the order x, y, z.
/// [`JOINTS`](crate::ids::JOINTS) lists the joints in the order of the datagram.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | point ID on the parent segment |
/// | 4 | 4 | point ID on the child segment |
/// | 8 | 12 | rotation about x, y, z, degrees |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct JointAngles {
    parent: U32,
    child: U32,
    angles: [F32; 3],
}

impl JointAngles {
    /// Angles in degrees of the joint between two points.
    #[inline]
    pub fn new(parent: PointId, child: PointId, angles: [f32; 3]) -> Self {
        Self {
            parent: parent.0.into(),
            child: child.0.into(),
            angles: wire(angles),
        }
    }

    /// The point on the parent segment.
    #[inline]
    pub fn parent(&self) -> PointId {
        PointId(self.parent.get())
    }

    /// The point on the child segment.
    #[inline]
    pub fn child(&self) -> PointId {
        PointId(self.child.get())
    }

    /// Angles about x, y, z in degrees.
    #[inline]
    pub fn angles(&self) -> [f32; 3] {
        floats(self.angles)
    }
}
