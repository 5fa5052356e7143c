//! Joint and ergonomic angles: an exact function of the segments' orientations.

use crate::rotation::{Sequence, to_euler};
use crate::{ErgonomicAngle, Joint, Skeleton};
use glam::{DQuat, DVec3};

/// The angles of every joint of `skeleton`: (x, y, z) = (abduction, internal rotation, flexion), rad, as MVN gives them.
///
/// `orientation` holds, per segment, the rotation from its axes to the world's (canonical: the identity in the T-pose);
/// [`Segment::isb`](crate::Segment::isb) turns it to the ISB's axes. `out` gets an entry for each joint, `None` where
/// one of the two segments is not tracked. MXTP type 20 and MVNX `jointAngle` are [`Sequence::Zxy`], MVNX
/// `jointAngleXZY` is [`Sequence::Xzy`].
///
/// The signs follow from the joint's name, as anatomy has them: `Right` and `Left` mirror x and y, and a `Knee` or a
/// `BallFoot` flexes the other way round. A joint that names no side, an unknown one included, has the signs of the spine.
pub fn joint_angles(
    skeleton: &Skeleton,
    orientation: &[Option<DQuat>],
    sequence: Sequence,
    out: &mut Vec<Option<DVec3>>,
) {
    out.clear();
    let angles = skeleton.joints.iter().map(|joint: &Joint| {
        let parent = isb_orientation(skeleton, orientation, joint.parent.segment)?;
        let child = isb_orientation(skeleton, orientation, joint.child.segment)?;
        Some(signs(&joint.name) * clinical(parent.conjugate() * child, sequence)?)
    });
    out.extend(angles);
}

/// The ergonomic angles of `skeleton`, rad: as [`joint_angles`], between segments that need not touch.
///
/// An angle from the vertical compares the segment with the upright frame nearest to it, the one that the smallest turn
/// reaches. Its x and z therefore tell the tilt to the side and to the front, and the segment's heading tells nothing.
pub fn ergonomic_angles(
    skeleton: &Skeleton,
    orientation: &[Option<DQuat>],
    sequence: Sequence,
    out: &mut Vec<Option<DVec3>>,
) {
    out.clear();
    let angles = skeleton.ergonomic_angles.iter().map(|angle: &ErgonomicAngle| {
        let child = isb_orientation(skeleton, orientation, angle.child)?;
        let parent = match angle.parent {
            Some(parent) => isb_orientation(skeleton, orientation, parent)?,
            None => nearest_upright(child)?,
        };
        Some(signs(&angle.name) * clinical(parent.conjugate() * child, sequence)?)
    });
    out.extend(angles);
}

fn isb_orientation(skeleton: &Skeleton, orientation: &[Option<DQuat>], segment: usize) -> Option<DQuat> {
    let isb = skeleton.segments.get(segment)?.isb;
    Some(orientation.get(segment).copied().flatten()? * isb)
}

/// Turns about the ISB's x (forward), y (up) and z (to the right).
fn clinical(turn: DQuat, sequence: Sequence) -> Option<DVec3> {
    let turn = unit(turn)?;
    Some(to_euler(DQuat::from_xyzw(turn.x, turn.z, -turn.y, turn.w), sequence))
}

/// The turn about the vertical that leaves the smallest turn to `orientation`. A segment upside down has none.
fn nearest_upright(orientation: DQuat) -> Option<DQuat> {
    unit(DQuat::from_xyzw(0.0, 0.0, orientation.z, orientation.w))
}

fn unit(quaternion: DQuat) -> Option<DQuat> {
    let length = quaternion.length();
    (length.is_finite() && length > SHORTEST).then(|| quaternion / length)
}

/// What turns right-handed angles to anatomical ones.
fn signs(name: &str) -> DVec3 {
    let flexion = if name.contains("Knee") || name.contains("BallFoot") {
        -1.0
    } else {
        1.0
    };
    if name.contains("Right") {
        DVec3::new(-1.0, 1.0, flexion)
    } else if name.contains("Left") {
        DVec3::new(1.0, -1.0, flexion)
    } else {
        DVec3::new(1.0, 1.0, -1.0)
    }
}

/// A quaternion that is no longer than this is no rotation.
const SHORTEST: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn standing() -> (Skeleton, Vec<Option<DQuat>>) {
        (Skeleton::standard(0, false), vec![Some(DQuat::IDENTITY); 23])
    }

    /// The angles of one joint after `turn` of the segment at `place`.
    fn angle_of(name: &str, place: usize, turn: DQuat) -> DVec3 {
        let (skeleton, mut orientation) = standing();
        orientation[place] = Some(turn);
        let mut out = Vec::new();
        joint_angles(&skeleton, &orientation, Sequence::Zxy, &mut out);
        let joint = skeleton.joints.iter().position(|joint| joint.name == name).unwrap();
        out[joint].unwrap()
    }

    fn assert_near(found: DVec3, expected: DVec3) {
        assert!((found - expected).length() < 1e-9, "{found} is not {expected}");
    }

    #[test]
    fn a_bent_knee_has_positive_flexion_on_either_side() {
        let bent = DQuat::from_rotation_y(0.5);
        assert_near(angle_of("jRightKnee", 16, bent), DVec3::new(0.0, 0.0, 0.5));
        assert_near(angle_of("jLeftKnee", 20, bent), DVec3::new(0.0, 0.0, 0.5));
    }

    #[test]
    fn a_lifted_thigh_has_positive_hip_flexion() {
        let lifted = DQuat::from_rotation_y(-0.5);
        assert_near(angle_of("jRightHip", 15, lifted), DVec3::new(0.0, 0.0, 0.5));
        assert_near(angle_of("jLeftHip", 19, lifted), DVec3::new(0.0, 0.0, 0.5));
    }

    #[test]
    fn legs_spread_apart_are_abducted_on_either_side() {
        let right = angle_of("jRightHip", 15, DQuat::from_rotation_x(-0.3));
        let left = angle_of("jLeftHip", 19, DQuat::from_rotation_x(0.3));
        assert_near(right, DVec3::new(0.3, 0.0, 0.0));
        assert_near(left, right);
    }

    #[test]
    fn an_arm_that_hangs_has_its_shoulder_at_zero_and_a_flexed_elbow_its_flexion() {
        let hanging = DQuat::from_rotation_x(FRAC_PI_2);
        assert_near(angle_of("jRightShoulder", 8, hanging), DVec3::ZERO);
        let elbow = angle_of("jRightElbow", 9, DQuat::from_rotation_z(0.4));
        assert!((elbow.z - 0.4).abs() < 1e-9, "{elbow}");
    }

    #[test]
    fn an_untracked_segment_leaves_its_joints_unknown() {
        let (skeleton, mut orientation) = standing();
        orientation[9] = None;
        let mut out = Vec::new();
        joint_angles(&skeleton, &orientation, Sequence::Xzy, &mut out);
        let unknown: Vec<_> = (0..22).filter(|&joint| out[joint].is_none()).collect();
        assert_eq!(unknown, [8, 9]);
        joint_angles(&skeleton, &[], Sequence::Xzy, &mut out);
        assert_eq!(out, vec![None; 22]);
    }

    #[test]
    fn the_angle_from_the_vertical_does_not_mind_the_heading() {
        let (skeleton, mut orientation) = standing();
        let mut out = Vec::new();
        for heading in [-3.0, -1.0, 0.0, 2.0, 3.1] {
            orientation[0] = Some(DQuat::from_rotation_z(heading) * DQuat::from_rotation_y(0.3));
            ergonomic_angles(&skeleton, &orientation, Sequence::Zxy, &mut out);
            assert_near(out[4].unwrap(), DVec3::new(0.0, 0.0, 0.3));
        }
    }

    #[test]
    fn what_is_no_rotation_has_no_angles() {
        let (skeleton, mut orientation) = standing();
        orientation[0] = Some(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0));
        orientation[4] = Some(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 0.0));
        let mut out = Vec::new();
        ergonomic_angles(&skeleton, &orientation, Sequence::Zxy, &mut out);
        assert_eq!(out, vec![None; 6]);
    }
}
