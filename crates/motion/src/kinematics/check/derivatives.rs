//! Velocities that a source sends against the differences of its poses.

use super::super::{Differences, Largest};
use crate::Frame;
use glam::DVec3;
use std::collections::VecDeque;
use std::sync::Arc;

/// How far velocities and angular velocities of samples are from the [differences](Differences) of their poses.
///
/// Nobody measures velocities exactly: a source filters them, and differences of three samples blur what is fast. Those
/// that are off by a large part of their size were computed at another rate, in another unit or in other axes.
#[derive(Clone, Debug)]
pub struct DerivativeDifferences {
    differences: Differences,
    /// The velocities of the samples that are on their way through `differences`.
    given: VecDeque<Frame>,
    velocity: Comparison,
    angular_velocity: Comparison,
}

/// Vectors of a source against those that were computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Per segment: the largest distance between the two; `None` where nothing could be compared.
    pub largest: Vec<Option<Largest>>,
    /// How many vectors were compared.
    pub count: u64,
    /// The sum of the squares of their distances.
    off: f64,
    /// The sum of the squares of the lengths of those that the source sent.
    given: f64,
}

impl DerivativeDifferences {
    /// Of samples whose numbers count `rate` a second.
    pub fn new(rate: f64) -> Self {
        Self {
            differences: Differences::new(rate).longest_gap(0),
            given: VecDeque::new(),
            velocity: Comparison::default(),
            angular_velocity: Comparison::default(),
        }
    }

    /// Takes a sample into account. All samples must be of one skeleton.
    pub fn add(&mut self, frame: &Frame) {
        if frame.velocity.is_empty() && frame.angular_velocity.is_empty() {
            return;
        }
        let mut given = Frame::new(Arc::clone(&frame.subject));
        given.sample = frame.sample;
        let mut poses = given.clone();
        given.velocity.clone_from(&frame.velocity);
        given.angular_velocity.clone_from(&frame.angular_velocity);
        poses.position.clone_from(&frame.position);
        poses.orientation.clone_from(&frame.orientation);
        self.given.push_back(given);
        let computed = self.differences.push(poses);
        self.compare(computed);
    }

    /// Takes the last samples into account.
    pub fn finish(&mut self) {
        let last: Vec<_> = self.differences.finish().collect();
        for computed in last {
            self.compare(Some(computed));
        }
    }

    /// Of the velocities of the segments' origins, m/s.
    pub fn velocity(&self) -> &Comparison {
        &self.velocity
    }

    /// Of their angular velocities, rad/s.
    pub fn angular_velocity(&self) -> &Comparison {
        &self.angular_velocity
    }

    fn compare(&mut self, computed: Option<Frame>) {
        if let Some((computed, given)) = computed.and_then(|computed| Some((computed, self.given.pop_front()?))) {
            self.velocity.add(given.sample, &given.velocity, &computed.velocity);
            self.angular_velocity
                .add(given.sample, &given.angular_velocity, &computed.angular_velocity);
        }
    }
}

impl Comparison {
    /// The root mean square of the distances; `None` when nothing was compared.
    pub fn difference(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.off / self.count as f64).sqrt())
    }

    /// The root mean square of the lengths of the source's vectors; `None` when nothing was compared.
    pub fn given(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.given / self.count as f64).sqrt())
    }

    fn add(&mut self, sample: u32, given: &[Option<DVec3>], computed: &[Option<DVec3>]) {
        self.largest.resize(given.len().max(self.largest.len()), None);
        for (place, (given, computed)) in given.iter().zip(computed).enumerate() {
            if let Some((given, computed)) = given.zip(*computed) {
                let distance = given.distance(computed);
                self.count += 1;
                self.off += distance * distance;
                self.given += given.length_squared();
                Largest::update(&mut self.largest[place], distance, sample);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, Skeleton, Subject};

    /// Someone who goes round at one turn in 2 pi seconds and a metre's distance, with velocities of this size.
    fn walk(speed: f64) -> DerivativeDifferences {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut check = DerivativeDifferences::new(100.0);
        for sample in 0..200 {
            let mut frame = Frame::new(Arc::clone(&subject));
            frame.sample = sample;
            let turn = DQuat::from_rotation_z(f64::from(sample) / 100.0);
            frame.position = vec![Some(turn * DVec3::X); 23];
            frame.orientation = vec![Some(turn); 23];
            frame.velocity = vec![Some(turn * DVec3::Y * speed); 23];
            frame.angular_velocity = vec![Some(DVec3::Z); 23];
            check.add(&frame);
        }
        check.finish();
        check
    }

    #[test]
    fn velocities_that_fit_are_hardly_off() {
        let check = walk(1.0);
        assert_eq!((check.velocity().count, check.angular_velocity().count), (4600, 4600));
        assert!(check.velocity().difference().unwrap() < 1e-4);
        assert!(check.angular_velocity().difference().unwrap() < 1e-9);
    }

    #[test]
    fn velocities_of_another_rate_are_off() {
        let check = walk(2.4);
        assert!((check.velocity().difference().unwrap() - 1.4).abs() < 1e-3);
        assert!((check.velocity().given().unwrap() - 2.4).abs() < 1e-9);
        let (_, largest) = Largest::of_all(&check.velocity().largest).unwrap();
        assert!((largest.value - 1.4).abs() < 1e-3);
    }

    #[test]
    fn without_velocities_nothing_is_compared() {
        let mut check = DerivativeDifferences::new(100.0);
        check.add(&Frame::new(Arc::new(Subject::new("Ada", Skeleton::default()))));
        check.finish();
        assert_eq!((check.velocity().difference(), check.velocity().given()), (None, None));
    }
}
