//! What a motion tracker's orientation tells of what it measures.

use crate::Frame;
use glam::{DQuat, DVec3};

/// Fills in the sensors' free acceleration from their acceleration, or the other way round, where one of them is there
/// and the sensors' orientation is: `free = q * acceleration - g`, with g upward at [`STANDARD_GRAVITY`].
pub(super) fn complete_accelerations(frame: &mut Frame) {
    let orientation = &frame.sensor_orientation;
    if frame.sensor_free_acceleration.is_empty() {
        frame.sensor_free_acceleration = turned(orientation, &frame.sensor_acceleration, |q, a| q * a - UPWARD);
    } else if frame.sensor_acceleration.is_empty() {
        let measured = |q: DQuat, free| q.conjugate() * (free + UPWARD);
        frame.sensor_acceleration = turned(orientation, &frame.sensor_free_acceleration, measured);
    }
}

fn turned(
    orientation: &[Option<DQuat>],
    known: &[Option<DVec3>],
    turn: impl Fn(DQuat, DVec3) -> DVec3,
) -> Vec<Option<DVec3>> {
    let pairs = orientation.iter().zip(known);
    pairs
        .map(|(orientation, known)| Some(turn((*orientation)?, (*known)?)))
        .collect()
}

/// What a body at rest is held up with, m/s².
const STANDARD_GRAVITY: f64 = 9.806_65;
const UPWARD: DVec3 = DVec3::new(0.0, 0.0, STANDARD_GRAVITY);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Skeleton, Subject};
    use std::f64::consts::FRAC_PI_2;
    use std::sync::Arc;

    #[test]
    fn a_sensor_at_rest_on_its_side_measures_gravity_alone() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.sensor_orientation = vec![Some(DQuat::from_rotation_x(FRAC_PI_2)), None];
        frame.sensor_free_acceleration = vec![Some(DVec3::ZERO); 2];
        complete_accelerations(&mut frame);
        let measured = frame.sensor_acceleration[0].unwrap();
        assert!((measured - DVec3::new(0.0, STANDARD_GRAVITY, 0.0)).length() < 1e-12);
        assert_eq!(frame.sensor_acceleration[1], None);

        frame.sensor_free_acceleration.clear();
        complete_accelerations(&mut frame);
        assert!(frame.sensor_free_acceleration[0].unwrap().length() < 1e-12);
    }

    #[test]
    fn without_orientation_nothing_is_told() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.sensor_acceleration = vec![Some(DVec3::Z); 17];
        complete_accelerations(&mut frame);
        assert!(frame.sensor_free_acceleration.is_empty());
    }
}
