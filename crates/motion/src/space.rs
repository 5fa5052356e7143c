//! Axes and units of the world outside.

use crate::Section;
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

    /// An angular velocity or acceleration of this space from a canonical one: its axis, about which a left-handed space
    /// turns the other way round.
    pub fn turn_from_canonical(self, v: DVec3) -> DVec3 {
        self.axis(v, Self::vector_from_canonical)
    }

    /// Makes canonical numbers of a section, its entries side by side as in a [`Column`](crate::Column), this space's.
    ///
    /// Positions, velocities and accelerations get its axes and its unit; orientations, angular velocities and
    /// accelerations its axes and hand; a magnetic field, which is a direction, its axes. What is in a sensor's own axes
    /// changes as what is in the world, because those axes are named anew as well. Joint angles are the same in every space.
    /// What is NaN stays so.
    pub fn section_from_canonical(self, section: Section, values: &mut [f64]) {
        for entry in values.chunks_exact_mut(section.components()) {
            match *entry {
                [w, x, y, z] => {
                    let q = self.orientation_from_canonical(DQuat::from_xyzw(x, y, z, w));
                    entry.copy_from_slice(&[q.w, q.x, q.y, q.z]);
                }
                [x, y, z] => entry.copy_from_slice(&self.vector_of(section, DVec3::new(x, y, z)).to_array()),
                _ => {}
            }
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

    fn vector_of(self, section: Section, v: DVec3) -> DVec3 {
        match section {
            Section::AngularVelocity | Section::AngularAcceleration | Section::SensorAngularVelocity => {
                self.turn_from_canonical(v)
            }
            Section::JointAngles | Section::JointAnglesXzy | Section::ErgonomicAngles | Section::ErgonomicAnglesXzy => {
                v
            }
            Section::SensorMagneticField => self.vector_from_canonical(v),
            _ => self.position_from_canonical(v),
        }
    }

    fn rotate_axis(self, q: DQuat, map: fn(Self, DVec3) -> DVec3) -> DQuat {
        let axis = self.axis(DVec3::new(q.x, q.y, q.z), map);
        DQuat::from_xyzw(axis.x, axis.y, axis.z, q.w)
    }

    /// An axis of turning maps as a vector; mirroring the space turns it the other way round.
    fn axis(self, axis: DVec3, map: fn(Self, DVec3) -> DVec3) -> DVec3 {
        let axis = map(self, axis);
        if self.handedness == Handedness::Left {
            -axis
        } else {
            axis
        }
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

    #[test]
    fn a_section_gets_the_axes_the_unit_and_the_hand_of_the_space() {
        let unreal = |section| {
            let mut values = [1.0, 2.0, 3.0];
            Space::UNREAL.section_from_canonical(section, &mut values);
            values.to_vec()
        };
        assert_eq!(unreal(Section::Position), [100.0, -200.0, 300.0]);
        assert_eq!(unreal(Section::Velocity), [100.0, -200.0, 300.0]);
        assert_eq!(unreal(Section::AngularVelocity), [-1.0, 2.0, -3.0]);
        assert_eq!(unreal(Section::SensorMagneticField), [1.0, -2.0, 3.0]);
        assert_eq!(unreal(Section::JointAngles), [1.0, 2.0, 3.0]);
        let mut values = [0.9, 0.1, 0.2, 0.3, f64::NAN, f64::NAN, f64::NAN, f64::NAN];
        Space::UNREAL.section_from_canonical(Section::Orientation, &mut values);
        assert_eq!(values[..4].to_vec(), [0.9, -0.1, 0.2, -0.3]);
        assert!(values[4..].iter().all(|value| value.is_nan()));
    }

    proptest! {
        #[test]
        fn what_turns_at_a_velocity_turns_at_the_mapped_one(x in -3.0..3.0_f64, y in -3.0..3.0_f64, z in -3.0..3.0_f64) {
            let (v, p) = (DVec3::new(x, y, z), DVec3::new(y, z, 1.0));
            for space in ALL {
                let mapped = space.turn_from_canonical(v).cross(space.vector_from_canonical(p));
                let expected = space.vector_from_canonical(v.cross(p));
                prop_assert!((mapped - expected).length() < 1e-9);
            }
        }

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
