//! Fingers that curl a little and slowly.

use posewire_motion::DQuat;
use std::f64::consts::TAU;

/// How a finger segment is turned against the one before it, `side` 1 on the left hand: bent towards the palm.
pub(super) fn curl(name: &str, side: f64, seconds: f64) -> DQuat {
    let Some((finger, bone)) = FINGERS.iter().zip(0_u8..).find_map(|(finger, number)| {
        let (_, bone) = name.split_once(finger)?;
        Some((f64::from(number), bone))
    }) else {
        return DQuat::IDENTITY;
    };
    let bend = match bone {
        "Metacarpal" => 0.02 * finger,
        "ProximalPhalange" => 0.3 + 0.05 * finger,
        "MiddlePhalange" => 0.4 + 0.04 * finger,
        _ => 0.25,
    };
    // Each finger a little after the one before it, as a relaxed hand does.
    let breath = 1.0 + 0.15 * (TAU * (seconds / PERIOD - 0.06 * finger)).sin();
    let thumb = if finger == 0.0 { 0.5 } else { 1.0 };
    DQuat::from_rotation_x(-side * thumb * bend * breath)
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
        for (side, out) in [(1.0, DVec3::Y), (-1.0, DVec3::NEG_Y)] {
            let tip = curl("ThirdProximalPhalange", side, 0.0) * out;
            assert!(tip.z < -0.2 && tip.dot(out) > 0.5, "{tip}");
        }
    }

    #[test]
    fn the_carpus_stays_with_the_hand() {
        assert_eq!(curl("LeftCarpus", 1.0, 3.0), DQuat::IDENTITY);
    }
}
