//! Type 22: angular segment kinematics (MV0305 2.7.3).

use zerocopy::byteorder::big_endian::{F32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{floats, wire};
use crate::ids::SegmentId;

/// Orientation, angular velocity and angular acceleration of a segment, 44 bytes (MV0305 2.7.3).
///
/// Global, right-handed, X forward, Y left, Z up. The specification gives no unit; it is radians.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | segment ID |
/// | 4 | 16 | orientation w, x, y, z |
/// | 20 | 12 | angular velocity x, y, z, rad/s |
/// | 32 | 12 | angular acceleration x, y, z, rad/s² |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct AngularSegment {
    id: U32,
    orientation: [F32; 4],
    angular_velocity: [F32; 3],
    angular_acceleration: [F32; 3],
}

impl AngularSegment {
    /// A segment with its orientation w, x, y, z and its rotation in rad/s and rad/s².
    #[inline]
    pub fn new(
        id: SegmentId,
        orientation: [f32; 4],
        angular_velocity: [f32; 3],
        angular_acceleration: [f32; 3],
    ) -> Self {
        Self {
            id: id.0.into(),
            orientation: wire(orientation),
            angular_velocity: wire(angular_velocity),
            angular_acceleration: wire(angular_acceleration),
        }
    }

    /// Which segment.
    #[inline]
    pub fn id(&self) -> SegmentId {
        SegmentId(self.id.get())
    }

    /// Unit quaternion w, x, y, z.
    #[inline]
    pub fn orientation(&self) -> [f32; 4] {
        floats(self.orientation)
    }

    /// Global angular velocity in rad/s.
    #[inline]
    pub fn angular_velocity(&self) -> [f32; 3] {
        floats(self.angular_velocity)
    }

    /// Global angular acceleration in rad/s².
    #[inline]
    pub fn angular_acceleration(&self) -> [f32; 3] {
        floats(self.angular_acceleration)
    }
}
