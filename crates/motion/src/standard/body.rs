//! The 23 segments of the body: MV0305 3.1 table 1, and the Unity order of table 3.

use glam::{DMat3, DQuat, DVec3};

/// One of the 23 segments of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySegment {
    /// Its name as MVN exports it.
    pub name: &'static str,
    /// The place of the segment that it hangs on.
    pub parent: Option<usize>,
    /// Its origin in the null pose of a nominal adult of 1.75 m: x, y, z in metres, the ground at z = 0.
    pub origin: [f64; 3],
    arm: Arm,
}

impl BodySegment {
    /// The nominal rotation from the ISB's axes to the segment's own: not the identity on upper arms, forearms and hands.
    pub fn isb(&self) -> DQuat {
        let rows = match self.arm {
            Arm::None => return DQuat::IDENTITY,
            Arm::RightUpper => [DVec3::X, DVec3::Z, DVec3::NEG_Y],
            Arm::RightLower => [DVec3::NEG_Y, DVec3::Z, DVec3::NEG_X],
            Arm::LeftUpper => [DVec3::X, DVec3::NEG_Z, DVec3::Y],
            Arm::LeftLower => [DVec3::Y, DVec3::NEG_Z, DVec3::NEG_X],
        };
        DQuat::from_mat3(&DMat3::from_cols(rows[0], rows[1], rows[2]).transpose())
    }
}

/// Which part of which arm a segment is: the ISB turns their axes against the T-pose's.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Arm {
    None,
    RightUpper,
    RightLower,
    LeftUpper,
    LeftLower,
}

const fn segment(name: &'static str, parent: Option<usize>, origin: [f64; 3]) -> BodySegment {
    BodySegment {
        name,
        parent,
        origin,
        arm: Arm::None,
    }
}

const fn arm(name: &'static str, parent: usize, origin: [f64; 3], arm: Arm) -> BodySegment {
    BodySegment {
        name,
        parent: Some(parent),
        origin,
        arm,
    }
}

/// The body's segments in the order of MXTP types 01, 02, 21 and 22 and of MVNX: MV0305 3.1 table 1.
pub const BODY_SEGMENTS: [BodySegment; 23] = [
    segment("Pelvis", None, [0.0, 0.0, 0.93]),
    segment("L5", Some(0), [0.0, 0.0, 1.03]),
    segment("L3", Some(1), [0.0, 0.0, 1.12]),
    segment("T12", Some(2), [0.0, 0.0, 1.21]),
    segment("T8", Some(3), [0.0, 0.0, 1.3]),
    segment("Neck", Some(4), [0.0, 0.0, 1.43]),
    segment("Head", Some(5), [0.0, 0.0, 1.52]),
    segment("RightShoulder", Some(4), [0.0, -0.03, 1.38]),
    arm("RightUpperArm", 7, [0.0, -0.17, 1.38], Arm::RightUpper),
    arm("RightForeArm", 8, [0.0, -0.46, 1.38], Arm::RightLower),
    arm("RightHand", 9, [0.0, -0.71, 1.38], Arm::RightLower),
    segment("LeftShoulder", Some(4), [0.0, 0.03, 1.38]),
    arm("LeftUpperArm", 11, [0.0, 0.17, 1.38], Arm::LeftUpper),
    arm("LeftForeArm", 12, [0.0, 0.46, 1.38], Arm::LeftLower),
    arm("LeftHand", 13, [0.0, 0.71, 1.38], Arm::LeftLower),
    segment("RightUpperLeg", Some(0), [0.0, -0.09, 0.93]),
    segment("RightLowerLeg", Some(15), [0.0, -0.09, 0.5]),
    segment("RightFoot", Some(16), [0.0, -0.09, 0.09]),
    segment("RightToe", Some(17), [0.16, -0.09, 0.02]),
    segment("LeftUpperLeg", Some(0), [0.0, 0.09, 0.93]),
    segment("LeftLowerLeg", Some(19), [0.0, 0.09, 0.5]),
    segment("LeftFoot", Some(20), [0.0, 0.09, 0.09]),
    segment("LeftToe", Some(21), [0.16, 0.09, 0.02]),
];

/// The places of the body's segments in the order of MXTP type 05: MV0305 3.1 table 3.
pub const UNITY_ORDER: [usize; 23] = [
    0, 15, 16, 17, 18, 19, 20, 21, 22, 1, 2, 3, 4, 11, 12, 13, 14, 7, 8, 9, 10, 5, 6,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_isb_axes_of_the_right_arm_are_those_of_mvnx_version_3() {
        let half = 0.5_f64.sqrt();
        let upper = BODY_SEGMENTS[8].isb();
        assert!(upper.angle_between(DQuat::from_xyzw(-half, 0.0, 0.0, half)) < 1e-7);
        for place in [9, 10] {
            let expected = DQuat::from_xyzw(-0.5, 0.5, 0.5, 0.5);
            assert!(
                BODY_SEGMENTS[place].isb().angle_between(expected) < 1e-7,
                "{}",
                BODY_SEGMENTS[place].isb()
            );
        }
    }

    #[test]
    fn unity_order_holds_every_segment_once() {
        let mut places = UNITY_ORDER;
        places.sort_unstable();
        assert!(places.into_iter().eq(0..23));
        assert_eq!(BODY_SEGMENTS[UNITY_ORDER[13]].name, "LeftShoulder");
    }
}
