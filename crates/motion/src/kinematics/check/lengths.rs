//! The lengths of quaternions.

use super::super::Largest;
use crate::Frame;
use glam::DQuat;

/// How far the lengths of quaternions are from 1, the length of a rotation.
///
/// Six decimals explain 0.000001. What is not finite is infinitely far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LengthErrors {
    segments: Vec<Option<Largest>>,
    sensors: Vec<Option<Largest>>,
}

impl LengthErrors {
    /// Of no sample yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a sample into account. All samples must be of one skeleton.
    pub fn add(&mut self, frame: &Frame) {
        compare(&mut self.segments, &frame.orientation, frame.sample);
        compare(&mut self.sensors, &frame.sensor_orientation, frame.sample);
    }

    /// Per segment: the largest `| |q| - 1 |`; `None` where it was never tracked.
    pub fn segments(&self) -> &[Option<Largest>] {
        &self.segments
    }

    /// The same, per sensor.
    pub fn sensors(&self) -> &[Option<Largest>] {
        &self.sensors
    }
}

fn compare(largest: &mut Vec<Option<Largest>>, orientations: &[Option<DQuat>], sample: u32) {
    largest.resize(orientations.len().max(largest.len()), None);
    for (largest, orientation) in largest.iter_mut().zip(orientations) {
        if let Some(orientation) = orientation {
            let error = (orientation.length() - 1.0).abs();
            let error = if error.is_finite() { error } else { f64::INFINITY };
            Largest::update(largest, error, sample);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Skeleton, Subject};
    use std::sync::Arc;

    #[test]
    fn the_largest_error_is_kept_per_segment_and_sensor() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        let mut errors = LengthErrors::new();
        for (sample, length) in [(1, 1.0), (2, 0.75), (3, 1.125)] {
            frame.sample = sample;
            frame.orientation = vec![
                Some(DQuat::IDENTITY * length),
                None,
                Some(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0)),
            ];
            frame.sensor_orientation = vec![Some(DQuat::IDENTITY)];
            errors.add(&frame);
        }
        let largest = |value, sample| Some(Largest { value, sample });
        assert_eq!(errors.segments(), [largest(0.25, 2), None, largest(f64::INFINITY, 1)]);
        assert_eq!(errors.sensors(), [largest(0.0, 1)]);
    }
}
