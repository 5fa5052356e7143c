//! Fingers that curl a little and slowly, and props that are held.

use posewire_motion::{DQuat, Segment, SegmentKind};
use std::f64::consts::TAU;

/// How a prop or a segment of a hand is turned against the segment it hangs on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grip {
    /// The bend about X on average, rad: towards the palm.
    bend: f64,
    /// Which finger it is of, from the thumb at 0.
    finger: f64,
}

impl Grip {
    /// The grip of a segment: props and the carpus stay with the hand.
    pub(super) fn new(segment: &Segment) -> Self {
        let side = match segment.kind {
            SegmentKind::LeftFinger => -1.0,
            SegmentKind::RightFinger => 1.0,
            SegmentKind::Body | SegmentKind::Prop => 0.0,
        };
        let mut fingers = FINGERS.iter().zip(0_u8..);
        let found = fingers.find_map(|(finger, number)| Some((segment.name.split_once(finger)?.1, f64::from(number))));
        let (bone, finger) = found.unwrap_or_default();
        Self {
            bend: side * bone_bend(bone, finger),
            finger,
        }
    }

    /// The turn at a time in seconds.
    pub(super) fn at(self, seconds: f64) -> DQuat {
        // Each finger a little after the one before it, as a relaxed hand does.
        let breath = 1.0 + 0.15 * (TAU * (seconds / PERIOD - 0.06 * self.finger)).sin();
        DQuat::from_rotation_x(self.bend * breath)
    }
}

/// How far a bone of a finger is bent, rad.
fn bone_bend(bone: &str, finger: f64) -> f64 {
    let thumb = if finger < 1.0 { 0.5 } else { 1.0 };
    let bend = match bone {
        "Metacarpal" => 0.02 * finger,
        "ProximalPhalange" => 0.3 + 0.05 * finger,
        "MiddlePhalange" => 0.4 + 0.04 * finger,
        "DistalPhalange" => 0.25,
        _ => 0.0,
    };
    thumb * bend
}

const FINGERS: [&str; 5] = ["First", "Second", "Third", "Fourth", "Fifth"];
/// Seconds from one curl to the next.
const PERIOD: f64 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::DVec3;

    #[test]
    fn fingers_bend_towards_the_palm_on_either_hand() {
        for (kind, out) in [
            (SegmentKind::LeftFinger, DVec3::Y),
            (SegmentKind::RightFinger, DVec3::NEG_Y),
        ] {
            let tip = Grip::new(&Segment::new("LeftThirdProximalPhalange", kind)).at(0.0) * out;
            assert!(tip.z < -0.2 && tip.dot(out) > 0.5, "{tip}");
        }
    }

    #[test]
    fn the_carpus_and_what_is_held_stay_with_the_hand() {
        for (name, kind) in [
            ("LeftCarpus", SegmentKind::LeftFinger),
            ("Prop1Generic", SegmentKind::Prop),
        ] {
            assert_eq!(Grip::new(&Segment::new(name, kind)).at(3.0), DQuat::IDENTITY);
        }
    }
}
