//! Axes and units of the world outside.

use glam::{DMat3, DQuat, DVec3};

/// Which axis points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Up {
    /// Y points up, Z forward.
    Y,
    /// Z points up, X forward.
    Z,
}

/// Which way the third axis goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handedness {
    /// X cross Y is Z.
    Right,
    /// X cross Y is minus Z.
    Left,
}

/// The unit of a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unit {
    /// Metres.
    Metre,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
}

impl Unit {
    /// How many of this unit make a metre.
    pub const fn per_metre(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 100.0,
            Self::Millimetre => 1000.0,
        }
    }
}

/// A coordinate system: which axis is up, which hand it is for, and its unit.
///
/// Forward is X when Z is up and Z when Y is up, which is what MVN, Unity and Unreal do. Where the canonical axes are X
/// forward, Y left, Z up, the other ones are:
///
/// | space | X, Y, Z of canonical x, y, z |
/// |---|---|
/// | Z up, right-handed | x, y, z |
/// | Z up, left-handed (Unreal) | x, -y, z |
/// | Y up, right-handed (MXTP type 01) | y, z, x |
/// | Y up, left-handed (Unity) | -y, z, x |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Space {
    /// The axis that points up.
    pub up: Up,
    /// Right- or left-handed.
    pub handedness: Handedness,
    /// The unit of lengths.
    pub unit: Unit,
}

impl Space {
    /// Metres, right-handed, X forward, Y left, Z up: what everything in posewire uses inside.
    pub const CANONICAL: Self = Self {
        up: Up::Z,
        handedness: Handedness::Right,
        unit: Unit::Metre,
    };
    /// Metres, left-handed, X right, Y up, Z forward.
    pub const UNITY: Self = Self {
        up: Up::Y,
        handedness: Handedness::Left,
        unit: Unit::Metre,
    };
    /// Centimetres, left-handed, X forward, Y right, Z up.
    pub const UNREAL: Self = Self {
        up: Up::Z,
        handedness: Handedness::Left,
        unit: Unit::Centimetre,
    };
    /// Centimetres, right-handed, Y up, Z forward: `MotionBuilder`, Maya and MXTP types 01 and 03.
    pub const MOTION_BUILDER: Self = Self {
        up: Up::Y,
        handedness: Handedness::Right,
        unit: Unit::Centimetre,
    };

    /// A position of this space from a canonical one in metres.
    pub fn position_from_canonical(self, position: DVec3) -> DVec3 {
        self.vector_from_canonical(position) * self.unit.per_metre()
    }

    /// The canonical position, in metres, of a position of this space.
    pub fn position_to_canonical(self, position: DVec3) -> DVec3 {
        self.vector_to_canonical(position) / self.unit.per_metre()
    }

    /// A direction, velocity or acceleration of this space from a canonical one; no unit is changed.
    pub fn vector_from_canonical(self, v: DVec3) -> DVec3 {
        match (self.up, self.handedness) {
            (Up::Z, Handedness::Right) => v,
            (Up::Z, Handedness::Left) => DVec3::new(v.x, -v.y, v.z),
            (Up::Y, Handedness::Right) => DVec3::new(v.y, v.z, v.x),
            (Up::Y, Handedness::Left) => DVec3::new(-v.y, v.z, v.x),
        }
    }

    /// The canonical direction of a direction of this space; no unit is changed.
    pub fn vector_to_canonical(self, v: DVec3) -> DVec3 {
        match (self.up, self.handedness) {
            (Up::Z, Handedness::Right) => v,
            (Up::Z, Handedness::Left) => DVec3::new(v.x, -v.y, v.z),
            (Up::Y, Handedness::Right) => DVec3::new(v.z, v.x, v.y),
            (Up::Y, Handedness::Left) => DVec3::new(v.z, -v.x, v.y),
        }
    }

    /// A rotation of this space from a canonical one.
    pub fn orientation_from_canonical(self, q: DQuat) -> DQuat {
        self.rotate_axis(q, Self::vector_from_canonical)
    }

    /// The canonical rotation of a rotation of this space.
    pub fn orientation_to_canonical(self, q: DQuat) -> DQuat {
        self.rotate_axis(q, Self::vector_to_canonical)
    }

    /// The rotation or reflection that takes canonical directions to this space's.
    pub fn basis(self) -> DMat3 {
        let column = |axis| self.vector_from_canonical(axis);
        DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
    }

    /// A rotation's axis maps as a vector; mirroring the space turns it the other way round.
    fn rotate_axis(self, q: DQuat, map: fn(Self, DVec3) -> DVec3) -> DQuat {
        let axis = map(self, DVec3::new(q.x, q.y, q.z));
        let axis = if self.handedness == Handedness::Left {
            -axis
        } else {
            axis
        };
        DQuat::from_xyzw(axis.x, axis.y, axis.z, q.w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: [Space; 4] = [Space::CANONICAL, Space::UNITY, Space::UNREAL, Space::MOTION_BUILDER];

    #[test]
    fn the_engines_axes_are_those_of_the_vendor() {
        let (p, q) = (DVec3::new(1.0, 2.0, 3.0), DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9));
        let cases = [
            (Space::UNITY, [-2.0, 3.0, 1.0], [0.2, -0.3, -0.1, 0.9]),
            (Space::UNREAL, [100.0, -200.0, 300.0], [-0.1, 0.2, -0.3, 0.9]),
            (Space::MOTION_BUILDER, [200.0, 300.0, 100.0], [0.2, 0.3, 0.1, 0.9]),
        ];
        for (space, position, orientation) in cases {
            assert_eq!(space.position_from_canonical(p), DVec3::from_array(position));
            assert_eq!(space.orientation_from_canonical(q), DQuat::from_array(orientation));
        }
    }

    proptest! {
        #[test]
        fn an_f32_of_any_space_survives_the_way_to_canonical_and_back(x: f32, y: f32, z: f32) {
            let p = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
            for space in ALL {
                let back = space.position_from_canonical(space.position_to_canonical(p));
                prop_assert_eq!([back.x as f32, back.y as f32, back.z as f32].map(f32::to_bits), [x, y, z].map(f32::to_bits));
            }
        }

        #[test]
        fn turning_then_mapping_is_mapping_then_turning(a in -3.0..3.0_f64, b in -3.0..3.0_f64, c in -3.0..3.0_f64) {
            let q = DQuat::from_euler(glam::EulerRot::XYZ, a, b, c);
            let v = DVec3::new(a, b, c);
            for space in ALL {
                let mapped = space.orientation_from_canonical(q) * space.vector_from_canonical(v);
                prop_assert!((mapped - space.vector_from_canonical(q * v)).length() < 1e-9);
                prop_assert_eq!(space.orientation_to_canonical(space.orientation_from_canonical(q)), q);
            }
        }
    }
}
