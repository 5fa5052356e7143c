//! The points of the body's segments: joint centres (`j...`) and landmarks (`p...`), in MVN's order.

use crate::Point;
use glam::DVec3;

/// The points of the body segment at a place of [`BODY_SEGMENTS`](super::BODY_SEGMENTS), with the offsets of a nominal
/// adult of 1.75 m. A point's id is its place here, from 1. A place past the body has none.
pub fn body_points(place: usize) -> Vec<Point> {
    let (side, landmarks) = match place {
        0 => (Side::Middle, PELVIS),
        1 => (Side::Middle, L5),
        2 => (Side::Middle, L3),
        3 => (Side::Middle, T12),
        4 => (Side::Middle, T8),
        5 => (Side::Middle, NECK),
        6 => (Side::Middle, HEAD),
        7..=10 => (Side::Right, ARM[place - 7]),
        11..=14 => (Side::Left, ARM[place - 11]),
        15..=18 => (Side::Right, LEG[place - 15]),
        19..=22 => (Side::Left, LEG[place - 19]),
        _ => return Vec::new(),
    };
    landmarks
        .iter()
        .zip(1..)
        .map(|(landmark, id)| landmark.point(id, side))
        .collect()
}

/// A point of a segment; of a limb's, outward is y and the name lacks its side.
struct Landmark {
    name: &'static str,
    offset: [f64; 3],
}

#[derive(Clone, Copy)]
enum Side {
    Middle,
    Left,
    Right,
}

impl Landmark {
    fn point(&self, id: u16, side: Side) -> Point {
        let [x, y, z] = self.offset;
        let (kind, rest) = self.name.split_at(1);
        let (name, y) = match side {
            Side::Middle => (self.name.to_owned(), y),
            _ if self.name == MANUBRIUM => (self.name.to_owned(), if matches!(side, Side::Left) { y } else { -y }),
            Side::Left => (format!("{kind}Left{rest}"), y),
            Side::Right => (format!("{kind}Right{rest}"), -y),
        };
        Point {
            id,
            name,
            offset: DVec3::new(x, y, z),
            flags: 0,
        }
    }
}

const fn landmark(name: &'static str, x: f64, y: f64, z: f64) -> Landmark {
    Landmark {
        name,
        offset: [x, y, z],
    }
}

/// The one point of the shoulders that has no side.
const MANUBRIUM: &str = "pIJ";

const ARM: [&[Landmark]; 4] = [SHOULDER, UPPER_ARM, FORE_ARM, HAND];
const LEG: [&[Landmark]; 4] = [UPPER_LEG, LOWER_LEG, FOOT, TOE];

const PELVIS: &[Landmark] = &[
    landmark("pHipOrigin", 0.0, 0.0, 0.0),
    landmark("jL5S1", 0.0, 0.0, 0.1),
    landmark("jRightHip", 0.0, -0.09, 0.0),
    landmark("jLeftHip", 0.0, 0.09, 0.0),
    landmark("pRightSIPS", -0.06, -0.05, 0.09),
    landmark("pLeftSIPS", -0.06, 0.05, 0.09),
    landmark("pRightASI", 0.08, -0.12, 0.08),
    landmark("pLeftASI", 0.08, 0.12, 0.08),
    landmark("pRightCSI", 0.02, -0.13, 0.12),
    landmark("pLeftCSI", 0.02, 0.13, 0.12),
    landmark("pRightIschialTub", -0.06, -0.06, -0.06),
    landmark("pLeftIschialTub", -0.06, 0.06, -0.06),
    landmark("pSacrum", -0.09, 0.0, 0.06),
    landmark("pCentralButtock", -0.1, 0.0, -0.03),
];

const L5: &[Landmark] = &[
    landmark("jL5S1", 0.0, 0.0, 0.0),
    landmark("jL4L3", 0.0, 0.0, 0.09),
    landmark("pL5SpinalProcess", -0.07, 0.0, 0.02),
];

const L3: &[Landmark] = &[
    landmark("jL4L3", 0.0, 0.0, 0.0),
    landmark("jL1T12", 0.0, 0.0, 0.09),
    landmark("pL3SpinalProcess", -0.07, 0.0, 0.03),
];

const T12: &[Landmark] = &[
    landmark("jL1T12", 0.0, 0.0, 0.0),
    landmark("jT9T8", 0.0, 0.0, 0.09),
    landmark("pT12SpinalProcess", -0.07, 0.0, 0.03),
];

const T8: &[Landmark] = &[
    landmark("jT9T8", 0.0, 0.0, 0.0),
    landmark("jT1C7", 0.0, 0.0, 0.13),
    landmark("jRightT4Shoulder", 0.0, -0.03, 0.08),
    landmark("jLeftT4Shoulder", 0.0, 0.03, 0.08),
    landmark("pC7SpinalProcess", -0.06, 0.0, 0.13),
    landmark("pPX", 0.12, 0.0, -0.04),
    landmark("pIJ", 0.09, 0.0, 0.1),
    landmark("pT4SpinalProcess", -0.08, 0.0, 0.06),
    landmark("pT8SpinalProcess", -0.08, 0.0, -0.02),
];

const NECK: &[Landmark] = &[
    landmark("jT1C7", 0.0, 0.0, 0.0),
    landmark("jC1Head", 0.0, 0.0, 0.09),
    landmark("pC7SpinalProcess", -0.06, 0.0, 0.0),
    landmark("pT4SpinalProcess", -0.08, 0.0, -0.07),
];

const HEAD: &[Landmark] = &[
    landmark("jC1Head", 0.0, 0.0, 0.0),
    landmark("pTopOfHead", 0.01, 0.0, 0.23),
    landmark("pRightAuricularis", 0.01, -0.075, 0.1),
    landmark("pLeftAuricularis", 0.01, 0.075, 0.1),
    landmark("pBackOfHead", -0.09, 0.0, 0.1),
];

const SHOULDER: &[Landmark] = &[
    landmark("jT4Shoulder", 0.0, 0.0, 0.0),
    landmark("jShoulder", 0.0, 0.14, 0.0),
    landmark("pIJ", 0.09, -0.03, 0.02),
    landmark("pAcromion", -0.01, 0.13, 0.04),
];

const UPPER_ARM: &[Landmark] = &[
    landmark("jShoulder", 0.0, 0.0, 0.0),
    landmark("jElbow", 0.0, 0.29, 0.0),
    landmark("pArmLatEpicondyle", -0.03, 0.28, 0.0),
    landmark("pArmMedEpicondyle", 0.03, 0.28, 0.0),
];

const FORE_ARM: &[Landmark] = &[
    landmark("jElbow", 0.0, 0.0, 0.0),
    landmark("jWrist", 0.0, 0.25, 0.0),
    landmark("pUlnarStyloid", -0.025, 0.245, 0.0),
    landmark("pRadialStyloid", 0.025, 0.245, 0.0),
    landmark("pOlecranon", -0.03, -0.01, 0.02),
];

const HAND: &[Landmark] = &[
    landmark("jWrist", 0.0, 0.0, 0.0),
    landmark("pTopOfHand", 0.0, 0.19, 0.0),
    landmark("pPinky", -0.045, 0.09, 0.0),
    landmark("pBallHand", 0.045, 0.09, 0.0),
    landmark("pHandPalm", 0.0, 0.08, -0.02),
];

const UPPER_LEG: &[Landmark] = &[
    landmark("jHip", 0.0, 0.0, 0.0),
    landmark("jKnee", 0.0, 0.0, -0.43),
    landmark("pGreaterTrochanter", 0.0, 0.06, 0.01),
    landmark("pKneeLatEpicondyle", 0.0, 0.05, -0.42),
    landmark("pKneeMedEpicondyle", 0.0, -0.05, -0.42),
    landmark("pPatella", 0.05, 0.0, -0.42),
];

const LOWER_LEG: &[Landmark] = &[
    landmark("jKnee", 0.0, 0.0, 0.0),
    landmark("jAnkle", 0.0, 0.0, -0.41),
    landmark("pKneeLatEpicondyle", 0.0, 0.05, 0.01),
    landmark("pKneeMedEpicondyle", 0.0, -0.05, 0.01),
    landmark("pLatMalleolus", 0.0, 0.035, -0.41),
    landmark("pMedMalleolus", 0.0, -0.035, -0.4),
    landmark("pTibialTub", 0.05, 0.0, -0.06),
];

const FOOT: &[Landmark] = &[
    landmark("jAnkle", 0.0, 0.0, 0.0),
    landmark("jBallFoot", 0.16, 0.0, -0.07),
    landmark("pHeelFoot", -0.05, 0.0, -0.08),
    landmark("pFirstMetatarsal", 0.16, -0.04, -0.07),
    landmark("pFifthMetatarsal", 0.13, 0.05, -0.08),
    landmark("pPivotFoot", 0.15, 0.0, -0.09),
    landmark("pHeelCenter", 0.0, 0.0, -0.09),
    landmark("pTopOfFoot", 0.09, 0.0, -0.02),
];

const TOE: &[Landmark] = &[
    landmark("jBallFoot", 0.0, 0.0, 0.0),
    landmark("pToe", 0.07, 0.0, -0.01),
    landmark("pFirstMetatarsal", 0.0, -0.04, 0.0),
    landmark("pFifthMetatarsal", -0.03, 0.05, -0.01),
];
