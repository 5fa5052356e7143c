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

/// Gives the orientations of one segment, in the order of time, signs that go on from one to the next.
///
/// The first that is known keeps its sign; the first after some that are not goes on from the last before them.
///
/// ```
/// use posewire_motion::DQuat;
/// use posewire_motion::rotation::make_continuous;
///
/// let turn = DQuat::from_rotation_z(0.1);
/// let mut orientations = [Some(turn), Some(-turn), None, Some(-turn)];
/// make_continuous(&mut orientations);
/// assert_eq!(orientations, [Some(turn), Some(turn), None, Some(turn)]);
/// ```
pub fn make_continuous(orientations: &mut [Option<DQuat>]) {
    let mut before = None;
    for orientation in orientations.iter_mut().flatten() {
        *orientation = continuous(*orientation, before.unwrap_or(*orientation));
        before = Some(*orientation);
    }
}

/// The orientation at `share` of the way from `from` (0) to `to` (1): the shorter way round, at a constant angular
/// velocity.
///
/// At 0 and before, it is `from` as given; at 1 and after, `to` with the sign that lies nearer to `from`; between them
/// a quaternion of length 1. Where `from` or `to` is no rotation, there is none between them, and the result is not
/// finite.
#[must_use]
pub fn slerp(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let to = continuous(to, from);
    if share <= 0.0 {
        return from;
    }
    if share >= 1.0 {
        return to;
    }
    let (from, to) = (from / from.length(), to / to.length());
    // Half the turn between them. The arc tangent is exact for the small turns of one sample, the arc cosine is not.
    let angle = 2.0 * (to - from).length().atan2((to + from).length());
    let weights = if angle < SMALLEST_ANGLE {
        [1.0 - share, share]
    } else {
        [((1.0 - share) * angle).sin(), (share * angle).sin()]
    };
    let between = from * weights[0] + to * weights[1];
    between / between.length()
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

/// Below this angle, rad, the sine is the angle in every digit.
const SMALLEST_ANGLE: f64 = 1e-9;

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

    #[test]
    fn what_lies_between_no_rotations_is_not_finite() {
        let nothing = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        assert!(!slerp(nothing, DQuat::IDENTITY, 0.5).is_finite());
        assert_eq!(slerp(nothing, DQuat::IDENTITY, 0.0), nothing);
    }

    fn rotation() -> impl Strategy<Value = DQuat> {
        let component = -1.0..1.0_f64;
        [component.clone(), component.clone(), component.clone(), component]
            .prop_map(DQuat::from_array)
            .prop_filter("a rotation", |q| q.length() > 0.1)
            .prop_map(DQuat::normalize)
    }

    proptest! {
        #[test]
        fn half_ways_make_up_the_whole_at_a_constant_velocity(from in rotation(), to in rotation(), share in 0.0..1.0_f64) {
            let whole = turn_between(from, to);
            let part = turn_between(from, slerp(from, to, share));
            // Half a turn can go either way round.
            prop_assume!(whole.length() < 3.1);
            prop_assert!((part - whole * share).length() < 1e-7, "{part} is not {share} of {whole}");
            prop_assert!(slerp(from, to, share).is_normalized());
        }

        #[test]
        fn the_way_does_not_depend_on_signs_and_steps_keep_theirs(from in rotation(), to in rotation(), share in 0.0..1.0_f64) {
            prop_assume!(from.dot(to).abs() > 1e-6);
            let there = slerp(from, to, share);
            prop_assert!((there - slerp(from, -to, share)).length() < 1e-12);
            prop_assert!((there + slerp(-from, to, share)).length() < 1e-12);
            prop_assert!(there.dot(from) > 0.0);
        }

        #[test]
        fn a_run_made_continuous_never_turns_its_sign(mut run in prop::collection::vec(prop::option::of(rotation()), 0..20)) {
            let given = run.clone();
            make_continuous(&mut run);
            let known: Vec<_> = run.iter().flatten().collect();
            prop_assert!(known.windows(2).all(|pair| pair[0].dot(*pair[1]) >= 0.0));
            let same = |(a, b): (&Option<DQuat>, &Option<DQuat>)| a == b || *a == b.map(|b| -b);
            prop_assert!(run.iter().zip(&given).all(same));
        }

        #[test]
        fn euler_angles_give_their_rotation_back(x in -1.5..1.5_f64, y in -1.5..1.5_f64, z in -1.5..1.5_f64) {
            for sequence in [Sequence::Zxy, Sequence::Xzy, Sequence::Zyx] {
                let angles = DVec3::new(x, y, z);
                prop_assert!((to_euler(from_euler(angles, sequence), sequence) - angles).length() < 1e-9);
            }
        }
    }
}
