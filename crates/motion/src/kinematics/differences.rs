//! Velocities and accelerations of a take that holds poses alone.

use crate::Frame;
use crate::rotation::turn_between;
use glam::{DQuat, DVec3};
use std::collections::VecDeque;

/// Works out velocities and accelerations from three samples in a row, for samples that lack them.
///
/// Filled are [`velocity`](Frame::velocity), [`acceleration`](Frame::acceleration),
/// [`angular_velocity`](Frame::angular_velocity), [`angular_acceleration`](Frame::angular_acceleration), those of the
/// centre of mass, and the angular velocity that [sensors](Frame::sensor_angular_velocity) measure. A section that a
/// frame has already stays as it is; an entry that is not tracked stays `None`.
///
/// Inside a run of samples differences are central. At both of its ends they are one-sided, over the same three samples:
/// exact for a constant acceleration. A run ends where the sample number jumps back, repeats, or jumps ahead too far; a
/// run of two samples has velocities alone. Angular velocity comes from the logarithm of the turn between two samples.
///
/// Samples come out in the order they went in, two samples later.
///
/// ```
/// use posewire_motion::kinematics::Differences;
/// use posewire_motion::{DVec3, Frame, Skeleton, Subject};
/// use std::sync::Arc;
///
/// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
/// let mut differences = Differences::new(60.0);
/// let mut done = Vec::new();
/// for sample in 0..5 {
///     let mut frame = Frame::new(subject.clone());
///     frame.sample = sample;
///     frame.position = vec![Some(DVec3::new(f64::from(sample) / 60.0, 0.0, 1.0)); 23];
///     done.extend(differences.push(frame));
/// }
/// done.extend(differences.finish());
/// assert_eq!(done.len(), 5);
/// assert!(done.iter().all(|frame| (frame.velocity[0].unwrap() - DVec3::X).length() < 1e-9));
/// ```
#[derive(Clone, Debug)]
pub struct Differences {
    rate: f64,
    longest_gap: u32,
    window: VecDeque<Sample>,
    waiting: VecDeque<Frame>,
    ready: VecDeque<Frame>,
}

impl Differences {
    /// Of samples taken at `rate` a second. With a rate that is not above zero nothing is filled.
    pub fn new(rate: f64) -> Self {
        Self {
            rate,
            longest_gap: USUAL_LONGEST_GAP,
            window: VecDeque::new(),
            waiting: VecDeque::new(),
            ready: VecDeque::new(),
        }
    }

    /// A run ends where more than `samples` sample numbers are left out: 16 when not said otherwise.
    #[must_use]
    pub fn longest_gap(self, samples: u32) -> Self {
        Self {
            longest_gap: samples,
            ..self
        }
    }

    /// Takes the next sample and gives the oldest that is complete. All samples must be of one subject.
    pub fn push(&mut self, frame: Frame) -> Option<Frame> {
        if self.window.back().is_some_and(|last| !self.continues(last, &frame)) {
            self.end_run();
        }
        let mut sample = self.recycled();
        sample.fill(&frame);
        self.window.push_back(sample);
        self.waiting.push_back(frame);
        if self.window.len() == WINDOW {
            self.release(1);
        }
        self.ready.pop_front()
    }

    /// Ends the run and gives all samples that are not given yet, up to two of them, in their order.
    pub fn finish(&mut self) -> impl Iterator<Item = Frame> {
        self.end_run();
        self.ready.drain(..)
    }

    fn end_run(&mut self) {
        self.release(0);
        self.window.clear();
    }

    fn continues(&self, last: &Sample, next: &Frame) -> bool {
        let step = next.sample.checked_sub(last.number).filter(|&step| step > 0);
        let same_skeleton = last.position.len() == next.position.len()
            && last.orientation.len() == next.orientation.len()
            && last.sensor_orientation.len() == next.sensor_orientation.len();
        self.rate > 0.0 && same_skeleton && step.is_some_and(|step| step - 1 <= self.longest_gap)
    }

    /// A sample to overwrite: the oldest of a full window, so that its memory serves again.
    fn recycled(&mut self) -> Sample {
        if self.window.len() < WINDOW {
            return Sample::default();
        }
        self.window.pop_front().unwrap_or_default()
    }

    /// Completes all waiting samples but the newest `keep`.
    fn release(&mut self, keep: usize) {
        while self.waiting.len() > keep {
            let place = self.window.len().saturating_sub(self.waiting.len());
            if let Some(mut frame) = self.waiting.pop_front() {
                self.fill(&mut frame, place);
                self.ready.push_back(frame);
            }
        }
    }

    /// Fills in what the frame, which stands at `place` of the window, lacks.
    fn fill(&self, frame: &mut Frame, place: usize) {
        if self.window.len() < 2 {
            return;
        }
        let steps = Steps {
            seconds: [self.seconds_after(0), self.seconds_after(1)],
            place,
        };
        fill_sections(
            frame.position.len(),
            |entry| steps.linear(self.each(|sample| sample.position[entry])),
            &mut frame.velocity,
            &mut frame.acceleration,
        );
        fill_sections(
            frame.orientation.len(),
            |entry| steps.angular(self.each(|sample| sample.orientation[entry])),
            &mut frame.angular_velocity,
            &mut frame.angular_acceleration,
        );
        if frame.sensor_angular_velocity.is_empty() {
            let measured = frame.sensor_orientation.iter().enumerate().map(|(entry, orientation)| {
                let motion = steps.angular(self.each(|sample| sample.sensor_orientation[entry]));
                Some((*orientation)?.conjugate() * motion.velocity?)
            });
            frame.sensor_angular_velocity = measured.collect();
        }
        if let Some(center) = &mut frame.center_of_mass {
            let motion = steps.linear(self.each(|sample| sample.center));
            center.velocity = center.velocity.or(motion.velocity);
            center.acceleration = center.acceleration.or(motion.acceleration);
        }
    }

    /// One thing of each sample in the window.
    fn each<T>(&self, thing: impl Fn(&Sample) -> Option<T>) -> [Option<T>; WINDOW] {
        [0, 1, 2].map(|place| self.window.get(place).and_then(&thing))
    }

    /// The time from the sample at `place` of the window to the next; zero when there is none.
    fn seconds_after(&self, place: usize) -> f64 {
        let number = |place: usize| self.window.get(place).map(|sample| sample.number);
        let step = number(place + 1).zip(number(place)).map(|(next, this)| next - this);
        step.map_or(0.0, |step| f64::from(step) / self.rate)
    }
}

fn fill_sections(
    entries: usize,
    motion: impl Fn(usize) -> Motion,
    velocity: &mut Vec<Option<DVec3>>,
    acceleration: &mut Vec<Option<DVec3>>,
) {
    let (fill_velocity, fill_acceleration) = (velocity.is_empty(), acceleration.is_empty());
    for motion in (0..entries).map(motion) {
        if fill_velocity {
            velocity.push(motion.velocity);
        }
        if fill_acceleration {
            acceleration.push(motion.acceleration);
        }
    }
}

/// What differences need of a sample.
#[derive(Clone, Debug, Default)]
struct Sample {
    number: u32,
    position: Vec<Option<DVec3>>,
    orientation: Vec<Option<DQuat>>,
    sensor_orientation: Vec<Option<DQuat>>,
    center: Option<DVec3>,
}

impl Sample {
    fn fill(&mut self, frame: &Frame) {
        self.number = frame.sample;
        self.position.clone_from(&frame.position);
        self.orientation.clone_from(&frame.orientation);
        self.sensor_orientation.clone_from(&frame.sensor_orientation);
        self.center = frame.center_of_mass.map(|center| center.position);
    }
}

/// Velocity and acceleration of one entry, as far as they can be told.
#[derive(Clone, Copy)]
struct Motion {
    velocity: Option<DVec3>,
    acceleration: Option<DVec3>,
}

/// The times between the samples of a window, and which of them is asked for.
struct Steps {
    seconds: [f64; WINDOW - 1],
    place: usize,
}

impl Steps {
    fn linear(&self, positions: [Option<DVec3>; WINDOW]) -> Motion {
        let step = |from: usize| Some((positions[from + 1]? - positions[from]?) / self.seconds[from]);
        self.motion(positions[self.place].is_some(), step(0), step(1))
    }

    fn angular(&self, orientations: [Option<DQuat>; WINDOW]) -> Motion {
        let step = |from: usize| Some(turn_between(orientations[from]?, orientations[from + 1]?) / self.seconds[from]);
        self.motion(orientations[self.place].is_some(), step(0), step(1))
    }

    /// From the mean velocities of both steps, which are those in the middle of each.
    fn motion(&self, tracked: bool, first: Option<DVec3>, second: Option<DVec3>) -> Motion {
        let [before, after] = self.seconds;
        let acceleration = first
            .zip(second)
            .map(|(first, second)| (second - first) / (0.5 * (before + after)));
        let bend = acceleration.unwrap_or_default();
        let velocity = match self.place {
            0 => first.map(|first| first - bend * (0.5 * before)),
            1 => first
                .map(|first| first + bend * (0.5 * before))
                .or(second.map(|second| second - bend * (0.5 * after))),
            _ => second.map(|second| second + bend * (0.5 * after)),
        };
        Motion {
            velocity: velocity.filter(|_| tracked),
            acceleration: acceleration.filter(|_| tracked),
        }
    }
}

const WINDOW: usize = 3;
const USUAL_LONGEST_GAP: u32 = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CenterOfMass, Skeleton, Subject};
    use std::sync::Arc;

    const RATE: f64 = 50.0;

    /// Frames at these sample numbers, with poses by time in seconds.
    fn take(numbers: &[u32], pose: impl Fn(f64) -> (DVec3, DQuat)) -> Vec<Frame> {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let frame = |&number: &u32| {
            let (position, orientation) = pose(f64::from(number) / RATE);
            let mut frame = Frame::new(subject.clone());
            frame.sample = number;
            frame.position = vec![Some(position); 23];
            frame.orientation = vec![Some(orientation); 23];
            frame.center_of_mass = Some(CenterOfMass {
                position,
                velocity: None,
                acceleration: None,
            });
            frame
        };
        numbers.iter().map(frame).collect()
    }

    fn filled(frames: Vec<Frame>) -> Vec<Frame> {
        let mut differences = Differences::new(RATE).longest_gap(10);
        let mut done: Vec<_> = frames.into_iter().filter_map(|frame| differences.push(frame)).collect();
        done.extend(differences.finish());
        done
    }

    fn assert_near(found: Option<DVec3>, expected: DVec3) {
        assert!(
            (found.unwrap() - expected).length() < 1e-9,
            "{found:?} is not {expected}"
        );
    }

    #[test]
    fn a_sensor_measures_its_turning_in_its_own_axes() {
        let tilt = DQuat::from_rotation_x(1.0);
        let mut frames = take(&[0, 1, 2], |_| (DVec3::ZERO, DQuat::IDENTITY));
        for (frame, seconds) in frames.iter_mut().zip([0.0, 0.02, 0.04]) {
            frame.sensor_orientation = vec![Some(tilt * DQuat::from_rotation_y(2.0 * seconds)), None];
        }
        for frame in filled(frames) {
            assert_near(frame.sensor_angular_velocity[0], DVec3::new(0.0, 2.0, 0.0));
            assert_eq!(frame.sensor_angular_velocity[1], None);
        }
    }

    #[test]
    fn a_constant_acceleration_is_found_at_every_sample() {
        let (start, speed, pull) = (DVec3::Z, DVec3::new(1.0, -2.0, 0.5), DVec3::new(0.3, 0.0, -9.81));
        let pose = |t: f64| (start + speed * t + pull * (0.5 * t * t), DQuat::IDENTITY);
        let done = filled(take(&[0, 1, 2, 3, 4, 5], pose));
        assert_eq!(done.len(), 6);
        for frame in &done {
            let t = f64::from(frame.sample) / RATE;
            assert_near(frame.velocity[22], speed + pull * t);
            assert_near(frame.acceleration[22], pull);
            assert_near(frame.angular_velocity[22], DVec3::ZERO);
            assert_near(frame.center_of_mass.unwrap().velocity, speed + pull * t);
            assert_near(frame.center_of_mass.unwrap().acceleration, pull);
            assert_eq!(frame.check(), Ok(()));
        }
    }

    #[test]
    fn left_out_samples_stretch_the_step() {
        let pull = DVec3::new(0.0, 1.0, 2.0);
        let pose = |t: f64| (pull * (0.5 * t * t), DQuat::from_rotation_z(3.0 * t));
        for frame in filled(take(&[0, 1, 4, 5, 11, 12], pose)) {
            assert_near(frame.velocity[0], pull * (f64::from(frame.sample) / RATE));
            assert_near(frame.acceleration[0], pull);
            assert_near(frame.angular_velocity[0], DVec3::Z * 3.0);
        }
    }

    #[test]
    fn a_uniform_turn_about_a_tilted_axis_has_its_angular_velocity_whatever_the_signs() {
        let axis = DVec3::new(1.0, -2.0, 0.5).normalize();
        let start = DQuat::from_rotation_x(0.8);
        let turning = |t: f64| (DVec3::ZERO, DQuat::from_axis_angle(axis, 7.0 * t) * start);
        let mut frames = take(&[0, 1, 2, 3, 4, 5, 6], turning);
        for frame in frames.iter_mut().filter(|frame| frame.sample % 3 == 1) {
            frame.orientation = vec![frame.orientation[0].map(|turn| -turn); 23];
        }
        for frame in filled(frames) {
            assert_near(frame.angular_velocity[3], axis * 7.0);
            assert!(frame.angular_acceleration[3].unwrap().length() < 1e-6);
        }
    }

    #[test]
    fn a_turn_that_speeds_up_has_its_angular_acceleration() {
        let spinning = |t: f64| (DVec3::ZERO, DQuat::from_rotation_z(t * t));
        for frame in filled(take(&[0, 1, 2, 3], spinning)) {
            assert_near(
                frame.angular_velocity[0],
                DVec3::Z * (2.0 * f64::from(frame.sample) / RATE),
            );
            assert!((frame.angular_acceleration[0].unwrap() - DVec3::Z * 2.0).length() < 1e-6);
        }
    }

    #[test]
    fn a_rewind_a_repeat_or_a_long_gap_starts_anew() {
        let moving = |t: f64| (DVec3::X * t, DQuat::IDENTITY);
        for numbers in [[5, 6, 0, 1], [5, 6, 6, 7], [5, 6, 18, 19]] {
            let done = filled(take(&numbers, moving));
            assert_eq!(done.iter().map(|frame| frame.sample).collect::<Vec<_>>(), numbers);
            for frame in done {
                assert_near(frame.velocity[0], DVec3::X);
                assert_eq!(frame.acceleration[0], None);
            }
        }
    }

    #[test]
    fn a_lone_sample_and_a_rate_of_zero_give_nothing() {
        let done = filled(take(&[7], |_| (DVec3::X, DQuat::IDENTITY)));
        assert!(done[0].velocity.is_empty());
        let mut differences = Differences::new(0.0);
        for frame in take(&[0, 1], |_| (DVec3::X, DQuat::IDENTITY)) {
            assert!(differences.push(frame).is_none_or(|done| done.velocity.is_empty()));
        }
        assert!(differences.finish().all(|done| done.velocity.is_empty()));
    }

    #[test]
    fn samples_come_out_two_later_and_never_pile_up() {
        let mut differences = Differences::new(RATE);
        let numbers = [0, 1, 2, 3, 1, 2, 2, 3, 4, 90, 91];
        let mut out = Vec::new();
        for frame in take(&numbers, |_| (DVec3::X, DQuat::IDENTITY)) {
            out.push(differences.push(frame).map(|done| done.sample));
        }
        let expected: Vec<_> = [None, None].into_iter().chain(numbers.map(Some)).collect();
        assert_eq!(out, expected[..numbers.len()]);
        assert_eq!(
            differences.finish().map(|done| done.sample).collect::<Vec<_>>(),
            [90, 91]
        );
        assert_eq!(differences.finish().count(), 0);
    }

    #[test]
    fn what_is_not_tracked_stays_unknown_and_its_neighbours_make_do() {
        let mut frames = take(&[0, 1, 2, 3, 4], |t| (DVec3::Y * t, DQuat::IDENTITY));
        frames[2].position[4] = None;
        let done = filled(frames);
        assert_eq!((done[2].velocity[4], done[2].acceleration[4]), (None, None));
        assert_near(done[1].velocity[4], DVec3::Y);
        assert_near(done[3].velocity[4], DVec3::Y);
        assert_eq!(done[1].acceleration[4], None);
    }

    #[test]
    fn what_the_source_sent_is_kept() {
        let mut frames = take(&[0, 1, 2], |t| (DVec3::Y * t, DQuat::IDENTITY));
        frames[1].velocity = vec![Some(DVec3::Z); 23];
        let done = filled(frames);
        assert_eq!(done[1].velocity, vec![Some(DVec3::Z); 23]);
        assert_near(done[1].acceleration[0], DVec3::ZERO);
    }
}
