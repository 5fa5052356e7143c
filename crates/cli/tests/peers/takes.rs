//! Takes that are never twice in one pose, and two seconds long.

use std::f64::consts::TAU;
use std::fmt::Write;

/// Samples a second.
pub(crate) const RATE: usize = 120;

/// MVN's body, with points on three of its segments.
pub(crate) fn body() -> String {
    take("Ada", &SEGMENTS)
}

/// One segment, which NatNet has as a rigid body.
pub(crate) fn wand() -> String {
    take("Wand", &["Wand"])
}

fn take(label: &str, segments: &[&str]) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <mvnx xmlns=\"http://www.xsens.com/mvn/mvnx\" version=\"4\">\n\
         <subject label=\"{label}\" frameRate=\"{RATE}\" segmentCount=\"{}\">\n<segments>\n",
        segments.len()
    );
    for (place, segment) in segments.iter().enumerate() {
        let points = points(segment);
        let id = place + 1;
        _ = writeln!(
            text,
            "<segment label=\"{segment}\" id=\"{id}\"><points>{points}</points></segment>"
        );
    }
    _ = writeln!(
        text,
        "</segments>\n<frames segmentCount=\"{}\" jointCount=\"0\">",
        segments.len()
    );
    for index in 0..2 * RATE {
        push_frame(&mut text, index, segments.len());
    }
    text + "</frames>\n</subject>\n</mvnx>\n"
}

fn points(segment: &str) -> String {
    let mut text = String::new();
    for (_, point, [x, y, z]) in POINTS.iter().filter(|(owner, ..)| *owner == segment) {
        _ = write!(
            text,
            "<point label=\"{point}\"><pos_b>{x:.6} {y:.6} {z:.6}</pos_b></point>"
        );
    }
    text
}

/// Segments that turn about an oblique axis, each on a circle of its own that rises.
fn push_frame(text: &mut String, index: usize, segments: usize) {
    let time = index * 1000 / RATE;
    let (mut turns, mut positions) = (String::new(), String::new());
    for place in 0..segments {
        let angle = TAU * index as f64 / (2 * RATE) as f64 + place as f64 * 0.3;
        let (sin, cos) = angle.sin_cos();
        _ = write!(turns, " {cos:.6} {:.6} {:.6} {:.6}", 0.36 * sin, 0.48 * sin, 0.8 * sin);
        let height = 0.05 * place as f64 + 0.001 * index as f64;
        _ = write!(positions, " {:.6} {:.6} {height:.6}", 1.5 * cos, -0.7 + 1.5 * sin);
    }
    _ = writeln!(
        text,
        "<frame time=\"{time}\" index=\"{index}\" type=\"normal\">\
         <orientation>{}</orientation><position>{}</position></frame>",
        turns.trim_start(),
        positions.trim_start()
    );
}

const SEGMENTS: [&str; 23] = [
    "Pelvis",
    "L5",
    "L3",
    "T12",
    "T8",
    "Neck",
    "Head",
    "RightShoulder",
    "RightUpperArm",
    "RightForeArm",
    "RightHand",
    "LeftShoulder",
    "LeftUpperArm",
    "LeftForeArm",
    "LeftHand",
    "RightUpperLeg",
    "RightLowerLeg",
    "RightFoot",
    "RightToe",
    "LeftUpperLeg",
    "LeftLowerLeg",
    "LeftFoot",
    "LeftToe",
];

const POINTS: [(&str, &str, [f64; 3]); 4] = [
    ("Pelvis", "pHipOrigin", [0.1, 0.02, 0.03]),
    ("Pelvis", "pSacrum", [-0.15, 0.0, 0.08]),
    ("Head", "pTopOfHead", [0.01, -0.02, 0.2]),
    ("LeftToe", "pLeftToe", [0.06, 0.0, -0.01]),
];
