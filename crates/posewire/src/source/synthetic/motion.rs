//! What follows from the motion about an instant: velocities, accelerations and what motion trackers measure.

use super::body::Posed;
use posewire_motion::{DQuat, DVec3, Frame};
use std::f64::consts::FRAC_PI_2;

/// The poses at an instant and close before and after it.
#[derive(Debug)]
pub(super) struct Moment {
    pub(super) before: Posed,
    pub(super) now: Posed,
    pub(super) after: Posed,
}

impl Moment {
    /// Asks for the pose at three shifts from the instant, in seconds.
    pub(super) fn new(pose: impl Fn(f64, &mut Posed)) -> Self {
        let at = |shift: f64| {
            let mut posed = Posed::default();
            pose(shift, &mut posed);
            posed
        };
        Self {
            before: at(-STEP),
            now: at(0.0),
            after: at(STEP),
        }
    }

    /// Fills in the frame's velocities and accelerations.
    pub(super) fn fill(&self, frame: &mut Frame) {
        let moving = self
            .before
            .position
            .iter()
            .zip(&self.now.position)
            .zip(&self.after.position);
        (frame.velocity, frame.acceleration) = moving
            .map(|((before, now), after)| Some(Self::linear((*before)?, (*now)?, (*after)?)))
            .map(Option::unzip)
            .unzip();
        let turning = self
            .before
            .orientation
            .iter()
            .zip(&self.now.orientation)
            .zip(&self.after.orientation);
        (frame.angular_velocity, frame.angular_acceleration) = turning
            .map(|((before, now), after)| Some(angular((*before)?, (*now)?, (*after)?)))
            .map(Option::unzip)
            .unzip();
    }

    /// Velocity and acceleration of a point.
    pub(super) fn linear(before: DVec3, now: DVec3, after: DVec3) -> (DVec3, DVec3) {
        (
            (after - before) / (2.0 * STEP),
            (after - 2.0 * now + before) / (STEP * STEP),
        )
    }
}

/// Fills in what trackers on the segments' origins measure, from what the frame tells of the segments.
pub(super) fn sense(frame: &mut Frame) {
    for sensor in 0..frame.subject.skeleton.sensors.len() {
        let felt = feel(frame, frame.subject.skeleton.sensors[sensor]);
        frame.sensor_orientation.push(felt.map(|felt| felt.orientation));
        frame
            .sensor_free_acceleration
            .push(felt.map(|felt| felt.free_acceleration));
        frame.sensor_acceleration.push(felt.map(|felt| felt.acceleration));
        frame
            .sensor_angular_velocity
            .push(felt.map(|felt| felt.angular_velocity));
        frame.sensor_magnetic_field.push(felt.map(|felt| felt.magnetic_field));
    }
}

/// What one tracker measures; all but its orientation and its free acceleration in its own axes.
#[derive(Clone, Copy)]
struct Felt {
    orientation: DQuat,
    free_acceleration: DVec3,
    acceleration: DVec3,
    angular_velocity: DVec3,
    magnetic_field: DVec3,
}

fn feel(frame: &Frame, segment: usize) -> Option<Felt> {
    let orientation = frame.orientation.get(segment).copied().flatten()? * mount(segment);
    let free_acceleration = frame.acceleration.get(segment).copied().flatten()?;
    let angular_velocity = frame.angular_velocity.get(segment).copied().flatten()?;
    let inward = orientation.conjugate();
    Some(Felt {
        orientation,
        free_acceleration,
        acceleration: inward * (free_acceleration + GRAVITY),
        angular_velocity: inward * angular_velocity,
        magnetic_field: inward * NORTH,
    })
}

/// How a tracker is strapped to a segment: its Z axis points out of the body.
fn mount(segment: usize) -> DQuat {
    match segment {
        0..=6 => DQuat::from_rotation_y(-FRAC_PI_2),
        7..=10 | 15..=18 => DQuat::from_rotation_x(FRAC_PI_2),
        _ => DQuat::from_rotation_x(-FRAC_PI_2),
    }
}

/// Angular velocity and acceleration in the world.
fn angular(before: DQuat, now: DQuat, after: DQuat) -> (DVec3, DVec3) {
    let (first, second) = (turn(before, now) / STEP, turn(now, after) / STEP);
    (0.5 * (first + second), (second - first) / STEP)
}

/// The turn between two orientations that are close: its axis times its angle, exact down to the smallest.
fn turn(from: DQuat, to: DQuat) -> DVec3 {
    let turn = to * from.conjugate();
    let (axis, sine) = (turn.xyz(), turn.xyz().length());
    if sine < SMALLEST {
        2.0 * axis
    } else {
        axis * (2.0 * sine.atan2(turn.w) / sine)
    }
}

/// Seconds between the poses of a moment: short beside the motion, long beside the rounding of positions.
const STEP: f64 = 1e-3;
const SMALLEST: f64 = 1e-12;
/// What a tracker at rest feels, m/s².
const GRAVITY: DVec3 = DVec3::new(0.0, 0.0, 9.81);
/// The magnetic field: to the north along X, and down by 65 degrees, as in the middle of Europe; its norm is 1.
const NORTH: DVec3 = DVec3::new(0.422_618_261_740_699_4, 0.0, -0.906_307_787_036_65);
