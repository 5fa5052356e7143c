//! Quaternions, Euler angles and what lies between two orientations.

use glam::{DMat3, DQuat, DVec3, EulerRot};
use std::time::Duration;

/// The order in which three turns about a body's own (moving) axes make up a rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sequence {
    /// About Z, then X, then Y.
    Zxy,
    /// About X, then Z, then Y.
    Xzy,
    /// About Z, then Y, then X: the matrix Rz·Ry·Rx of MXTP type 01.
    Zyx,
}

impl Sequence {
    const fn order(self) -> EulerRot {
        match self {
            Self::Zxy => EulerRot::ZXY,
            Self::Xzy => EulerRot::XZY,
            Self::Zyx => EulerRot::ZYX,
        }
    }
}

/// The turns about x, y and z, radians, that make up `rotation` in this sequence.
///
/// The middle turn lies within a quarter turn of zero, the others within half a turn.
pub fn to_euler(rotation: DQuat, sequence: Sequence) -> DVec3 {
    matrix_to_euler(DMat3::from_quat(rotation), sequence)
}

/// As [`to_euler`], of a rotation matrix.
pub fn matrix_to_euler(rotation: DMat3, sequence: Sequence) -> DVec3 {
    let (first, second, third) = rotation.to_euler(sequence.order());
    match sequence {
        Sequence::Zxy => DVec3::new(second, third, first),
        Sequence::Xzy => DVec3::new(first, third, second),
        Sequence::Zyx => DVec3::new(third, second, first),
    }
}

/// The rotation made up of turns about x, y and z, radians, in this sequence.
pub fn from_euler(angles: DVec3, sequence: Sequence) -> DQuat {
    let DVec3 { x, y, z } = angles;
    match sequence {
        Sequence::Zxy => DQuat::from_euler(sequence.order(), z, x, y),
        Sequence::Xzy => DQuat::from_euler(sequence.order(), x, z, y),
        Sequence::Zyx => DQuat::from_euler(sequence.order(), z, y, x),
    }
}

/// `orientation` with the sign that lies nearer to `before`: the two signs are one rotation, and interpolation minds.
#[must_use]
pub fn continuous(orientation: DQuat, before: DQuat) -> DQuat {
    if orientation.dot(before) < 0.0 {
        -orientation
    } else {
        orientation
    }
}

/// The turn in the world that takes `from` to `to`, the shorter way round: its axis, as long as its angle in rad.
pub fn turn_between(from: DQuat, to: DQuat) -> DVec3 {
    (continuous(to, from) * from.conjugate()).to_scaled_axis()
}

/// The constant angular velocity in the world, rad/s, that turns `from` to `to` within `elapsed`, the shorter way round.
///
/// `None` when no time has elapsed.
pub fn angular_velocity(from: DQuat, to: DQuat, elapsed: Duration) -> Option<DVec3> {
    let seconds = elapsed.as_secs_f64();
    (seconds > 0.0).then(|| turn_between(from, to) / seconds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn type_01_angles_make_the_matrix_rz_ry_rx() {
        let angles = DVec3::new(0.3, -0.4, 0.5);
        let expected = DMat3::from_rotation_z(0.5) * DMat3::from_rotation_y(-0.4) * DMat3::from_rotation_x(0.3);
        let found = DMat3::from_quat(from_euler(angles, Sequence::Zyx));
        assert!(found.abs_diff_eq(expected, 1e-12));
    }

    #[test]
    fn a_turn_about_z_has_its_angular_velocity_along_z() {
        let (from, to) = (DQuat::from_rotation_z(0.1), -DQuat::from_rotation_z(0.3));
        let velocity = angular_velocity(from, to, Duration::from_millis(100)).unwrap();
        assert!((velocity - DVec3::new(0.0, 0.0, 2.0)).length() < 1e-9);
        assert_eq!(angular_velocity(from, to, Duration::ZERO), None);
    }

    proptest! {
        #[test]
        fn euler_angles_give_their_rotation_back(x in -1.5..1.5_f64, y in -1.5..1.5_f64, z in -1.5..1.5_f64) {
            for sequence in [Sequence::Zxy, Sequence::Xzy, Sequence::Zyx] {
                let angles = DVec3::new(x, y, z);
                prop_assert!((to_euler(from_euler(angles, sequence), sequence) - angles).length() < 1e-9);
            }
        }
    }
}
