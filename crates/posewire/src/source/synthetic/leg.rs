//! A leg between a hip and an ankle.

use posewire_motion::{DMat3, DQuat, DVec3};

/// How thigh and shank are turned so that a leg of these lengths reaches from `hip` to `ankle` with the knee bent
/// towards `forward`: their orientations, the identity for a straight leg that hangs.
///
/// A knee never straightens fully, as it would jerk then: an ankle almost out of reach, or out of it, is taken as a little
/// nearer, and the nearer the farther it is.
pub(super) fn reach(hip: DVec3, ankle: DVec3, thigh: f64, shank: f64, forward: DVec3) -> [DQuat; 2] {
    let leg = hip - ankle;
    let length = (thigh + shank) * softened(leg.length() / (thigh + shank));
    let up = leg.normalize();
    let left = up.cross(forward).normalize();
    let upright = DMat3::from_cols(left.cross(up), left, up);
    let at_hip = corner(thigh, length, shank);
    let at_ankle = corner(shank, length, thigh);
    [-at_hip, at_ankle].map(|bend| near_identity(DQuat::from_mat3(&(upright * DMat3::from_rotation_y(bend)))))
}

/// A share of the full length that never reaches 1; its first two derivatives are continuous.
fn softened(share: f64) -> f64 {
    if share < FREE {
        return share;
    }
    FREE + SPRING * ((share - FREE) / SPRING).tanh()
}

/// The angle of a triangle between the sides `a` and `b`.
fn corner(a: f64, b: f64, opposite: f64) -> f64 {
    ((a * a + b * b - opposite * opposite) / (2.0 * a * b))
        .clamp(-1.0, 1.0)
        .acos()
}

/// Of a quaternion and its negative, the one nearer to the identity: no leg turns so far that this would jump.
fn near_identity(turn: DQuat) -> DQuat {
    if turn.w < 0.0 { -turn } else { turn }
}

/// The share of its full length that a leg reaches freely: the knee bends by 11 degrees then.
const FREE: f64 = 0.994;
/// How much of its length beyond that it gives at most: the knee bends by 5 degrees then.
const SPRING: f64 = 0.005;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_leg_ends_at_the_ankle_and_bends_forward() {
        let (hip, ankle) = (DVec3::new(0.1, 0.09, 0.9), DVec3::new(0.35, 0.05, 0.15));
        let [thigh, shank] = reach(hip, ankle, 0.43, 0.41, DVec3::X);
        let knee = hip + thigh * DVec3::new(0.0, 0.0, -0.43);
        assert!((knee + shank * DVec3::new(0.0, 0.0, -0.41) - ankle).length() < 1e-9);
        assert!(knee.x > hip.lerp(ankle, 0.5).x);
        assert!((thigh * DVec3::Y - shank * DVec3::Y).length() < 1e-9);
    }

    #[test]
    fn an_ankle_out_of_reach_gives_a_leg_almost_straight() {
        let [thigh, shank] = reach(DVec3::Z * 2.0, DVec3::ZERO, 0.43, 0.41, DVec3::X);
        assert!(thigh.is_finite() && shank.is_finite());
        assert!((0.08..0.1).contains(&thigh.angle_between(shank)));
    }
}
