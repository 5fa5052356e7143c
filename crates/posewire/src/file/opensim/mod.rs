//! What `OpenSim` reads: marker trajectories (TRC), joint angles (MOT) and orientations of segments (STO).
//!
//! `OpenSim`'s ground is right-handed with X forward, Y up and Z to the right: canonical x, z and -y, which is the turn of
//! -90 degrees about X that its tools ask for as `sensor_to_opensim_rotations`. It is made here, so 0 0 0 is to be set there.

pub(super) mod mot;
pub(super) mod sto;
pub(super) mod trc;

use posewire_motion::{DQuat, Take};
use std::f64::consts::FRAC_1_SQRT_2;

/// From the canonical axes to those of `OpenSim`'s ground: -90 degrees about X.
const TO_GROUND: DQuat = DQuat::from_xyzw(-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2);

/// When each frame was, s after the first: by the numbers of the samples, which unlike their times do not jitter. `OpenSim`
/// wants times that go up, so frames out of order get those of their places.
fn times(take: &Take, rate: f64) -> Vec<f64> {
    let samples = take.samples();
    let go_up = samples.windows(2).all(|pair| pair[0] < pair[1]);
    let first = samples.first().copied().unwrap_or_default();
    let offset = |(place, &sample): (usize, &u32)| if go_up { f64::from(sample - first) } else { place as f64 };
    samples.iter().enumerate().map(|frame| offset(frame) / rate).collect()
}

/// A name as the label of a column, which ends at white space.
fn label(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}

/// How `OpenSim` writes a number that is none.
const NOT_TRACKED: &str = "NaN";
const DECIMALS: usize = 6;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DVec3, Frame, Skeleton, Subject};
    use std::sync::Arc;

    fn take(samples: &[u32]) -> Take {
        let subject = Arc::new(Subject::new("Ada", Skeleton::default()));
        let mut take = Take::new(Arc::clone(&subject), 10.0);
        let mut frame = Frame::new(subject);
        for &sample in samples {
            frame.sample = sample;
            take.push(&frame).unwrap();
        }
        take
    }

    #[test]
    fn times_go_up_from_zero_and_keep_gaps() {
        assert_eq!(times(&take(&[7, 8, 12]), 10.0), [0.0, 0.1, 0.5]);
        assert_eq!(times(&take(&[7, 7, 3]), 10.0), [0.0, 0.1, 0.2]);
    }

    #[test]
    fn left_is_minus_z_and_up_is_y() {
        let ground = |v| TO_GROUND * v;
        assert!((ground(DVec3::Y) + DVec3::Z).length() < 1e-12);
        assert!((ground(DVec3::Z) - DVec3::Y).length() < 1e-12);
        assert!((ground(DVec3::X) - DVec3::X).length() < 1e-12);
    }
}
