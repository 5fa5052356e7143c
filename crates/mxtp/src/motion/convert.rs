//! Values of the wire as canonical ones, and back.

use posewire_motion::rotation::{Sequence, from_euler};
use posewire_motion::{DQuat, DVec3, Space};

/// The axes and unit of types 01 and 03: right-handed, Y up, centimetres.
pub(super) const EULER_SPACE: Space = Space::MOTION_BUILDER;

/// The axes and unit of type 05: left-handed, Y up, metres.
pub(super) const UNITY_SPACE: Space = Space::UNITY;

#[inline]
pub(super) fn vector([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(x.into(), y.into(), z.into())
}

#[inline]
pub(super) fn vector_to_wire(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// From w, x, y, z.
#[inline]
pub(super) fn quaternion([w, x, y, z]: [f32; 4]) -> DQuat {
    DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into())
}

/// To w, x, y, z.
#[inline]
pub(super) fn quaternion_to_wire(q: DQuat) -> [f32; 4] {
    [q.w as f32, q.x as f32, q.y as f32, q.z as f32]
}

/// Degrees to radians.
pub(super) fn angles([x, y, z]: [f32; 3]) -> DVec3 {
    vector([x, y, z]).map(f64::to_radians)
}

/// Radians to degrees.
pub(super) fn angles_to_wire(angles: DVec3) -> [f32; 3] {
    vector_to_wire(angles.map(f64::to_degrees))
}

/// The orientation of Euler angles in degrees, Y up: R = Rz·Ry·Rx.
pub(super) fn euler(degrees: [f32; 3]) -> DQuat {
    EULER_SPACE.orientation_to_canonical(from_euler(angles(degrees), Sequence::Zyx))
}

/// The Euler angles of an orientation, in degrees, Y up.
///
/// The turn about x is taken from what the turn about z leaves, not on its own: so the three make up the orientation even
/// where x and z turn about nearly the same axis and neither is determined well.
pub(super) fn euler_to_wire(orientation: DQuat) -> [f32; 3] {
    let turn = EULER_SPACE.orientation_from_canonical(orientation);
    let [x_axis, y_axis, z_axis] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn * axis);
    let z = x_axis.y.atan2(x_axis.x);
    let y = (-x_axis.z).atan2(x_axis.x.hypot(x_axis.y));
    let (sin, cos) = z.sin_cos();
    let x = (sin * z_axis.x - cos * z_axis.y).atan2(cos * y_axis.y - sin * y_axis.x);
    angles_to_wire(DVec3::new(x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::DMat3;
    use proptest::prelude::*;

    /// What rounding three angles of up to half a turn to `f32` can do, rad.
    const EULER_ERROR: f64 = 5e-7;

    /// The angle between two rotations, without the loss of an arc cosine near 1.
    fn turn_between(a: DQuat, b: DQuat) -> f64 {
        let difference = a.conjugate() * b;
        2.0 * difference.xyz().length().atan2(difference.w.abs())
    }

    #[test]
    fn euler_angles_turn_about_x_then_y_then_z_of_the_y_up_world() {
        let degrees = [30.0_f32, -40.0, 50.0];
        let [x, y, z] = degrees.map(|angle| f64::from(angle).to_radians());
        let y_up = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
        // (X, Y, Z) of Y-up are (y, z, x) of Z-up.
        let to_y_up = DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y);
        let expected = to_y_up.transpose() * y_up * to_y_up;
        assert!(DMat3::from_quat(euler(degrees)).abs_diff_eq(expected, 1e-12));
    }

    #[test]
    fn a_turn_to_the_left_is_about_y_up() {
        let left = DQuat::from_rotation_z(0.5_f64.to_radians());
        let [x, y, z] = euler_to_wire(left);
        assert!(x.abs() < 1e-6 && (y - 0.5).abs() < 1e-6 && z.abs() < 1e-6);
    }

    #[test]
    fn at_gimbal_lock_the_angles_still_make_up_the_rotation() {
        for off in [0.0, 1e-15, 1e-9, 1e-7, 1e-5, 1e-3] {
            for sign in [1.0, -1.0] {
                let y = sign * (std::f64::consts::FRAC_PI_2 - off);
                let turn = DQuat::from_rotation_z(0.7) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(-1.9);
                let orientation = EULER_SPACE.orientation_to_canonical(turn);
                let error = turn_between(euler(euler_to_wire(orientation)), orientation);
                assert!(error < EULER_ERROR, "{off} {sign}: {error}");
            }
        }
    }

    proptest! {
        #[test]
        fn euler_angles_give_the_rotation_back(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64, w in -1.0..1.0_f64) {
            prop_assume!(x * x + y * y + z * z + w * w > 1e-3);
            let orientation = DQuat::from_xyzw(x, y, z, w).normalize();
            prop_assert!(turn_between(euler(euler_to_wire(orientation)), orientation) < EULER_ERROR);
        }

        #[test]
        fn degrees_keep_every_value(degrees: [f32; 3]) {
            let bits = |values: [f32; 3]| values.map(f32::to_bits);
            prop_assert_eq!(bits(angles_to_wire(angles(degrees))), bits(degrees));
        }
    }
}
