//! Joints, ergonomic angles, sensors and foot contacts of MVN's body, in MVN's order.

/// A joint of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandardJoint {
    /// Its name, which is also that of the points it joins.
    pub name: &'static str,
    /// The place of the parent segment.
    pub parent: usize,
    /// The place of the child segment.
    pub child: usize,
}

const fn joint(name: &'static str, parent: usize, child: usize) -> StandardJoint {
    StandardJoint { name, parent, child }
}

/// The 22 joints of the body in the order of MXTP type 20 and of MVNX.
pub const JOINTS: [StandardJoint; 22] = [
    joint("jL5S1", 0, 1),
    joint("jL4L3", 1, 2),
    joint("jL1T12", 2, 3),
    joint("jT9T8", 3, 4),
    joint("jT1C7", 4, 5),
    joint("jC1Head", 5, 6),
    joint("jRightT4Shoulder", 4, 7),
    joint("jRightShoulder", 7, 8),
    joint("jRightElbow", 8, 9),
    joint("jRightWrist", 9, 10),
    joint("jLeftT4Shoulder", 4, 11),
    joint("jLeftShoulder", 11, 12),
    joint("jLeftElbow", 12, 13),
    joint("jLeftWrist", 13, 14),
    joint("jRightHip", 0, 15),
    joint("jRightKnee", 15, 16),
    joint("jRightAnkle", 16, 17),
    joint("jRightBallFoot", 17, 18),
    joint("jLeftHip", 0, 19),
    joint("jLeftKnee", 19, 20),
    joint("jLeftAnkle", 20, 21),
    joint("jLeftBallFoot", 21, 22),
];

/// An ergonomic angle of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandardErgonomicAngle {
    /// Its name.
    pub name: &'static str,
    /// The place of the segment that it is measured from; `None` for the vertical.
    pub parent: Option<usize>,
    /// The place of the segment that is measured.
    pub child: usize,
}

const fn ergonomic(name: &'static str, parent: Option<usize>, child: usize) -> StandardErgonomicAngle {
    StandardErgonomicAngle { name, parent, child }
}

/// The six ergonomic angles in the order of MXTP type 20; MVNX files hold the first four of them or all.
pub const ERGONOMIC_ANGLES: [StandardErgonomicAngle; 6] = [
    ergonomic("T8_Head", Some(4), 6),
    ergonomic("T8_LeftUpperArm", Some(4), 12),
    ergonomic("T8_RightUpperArm", Some(4), 8),
    ergonomic("Pelvis_T8", Some(0), 4),
    ergonomic("Vertical_Pelvis", None, 0),
    ergonomic("Vertical_T8", None, 4),
];

/// The places of the segments that wear the 17 motion trackers of a full body.
pub const SENSORS: [usize; 17] = [0, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 19, 20, 21];

/// The foot contacts of MVNX version 4 in their order.
pub const FOOT_CONTACTS: [&str; 4] = ["LeftFoot_Heel", "LeftFoot_Toe", "RightFoot_Heel", "RightFoot_Toe"];
