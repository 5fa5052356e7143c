//! Kinematics of whole takes.

use super::check::Dropouts;
use super::{ContinuousSigns, Differences, Resampler, complete};
use crate::{Error, Frame, Take};
use std::sync::Arc;

/// The take at another rate: its samples through a [`Resampler`].
///
/// # Errors
/// [`Error::Rate`] when the take's rate or the new one is none.
///
/// ```
/// use posewire_motion::kinematics::resampled;
/// use posewire_motion::{DVec3, Frame, Section, Skeleton, Subject, Take};
/// use std::sync::Arc;
///
/// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
/// let mut take = Take::new(subject.clone(), 240.0);
/// let mut frame = Frame::new(subject);
/// for sample in 0..9 {
///     frame.sample = sample;
///     frame.position = vec![Some(DVec3::X * f64::from(sample)); 23];
///     take.push(&frame)?;
/// }
/// let slow = resampled(&take, 60.0)?;
/// assert_eq!((slow.samples(), slow.rate), ([0, 1, 2].as_slice(), 60.0));
/// assert_eq!(slow.frame(2).position[0], Some(DVec3::X * 8.0));
/// # Ok::<(), posewire_motion::Error>(())
/// ```
pub fn resampled(take: &Take, rate: f64) -> Result<Take, Error> {
    let mut resampler = Resampler::new(take.rate, rate)?;
    let subject = resampler.resampled_subject(&take.subject);
    let frames = (take.len() as f64 * rate / take.rate) as usize + 1;
    let mut done = Take::with_capacity(subject, rate, frames);
    for frame in take.frames() {
        for frame in resampler.push(frame) {
            done.push(&frame)?;
        }
    }
    for frame in resampler.finish() {
        done.push(&frame)?;
    }
    Ok(done)
}

/// The take with all that its poses tell: its samples through [`complete`] and [`Differences`].
///
/// What is there already stays as it is. The centre of mass of a take that has none is an estimate.
///
/// # Errors
/// [`Error::SectionLength`] when what was computed does not fit the take.
pub fn completed(take: &Take) -> Result<Take, Error> {
    let mut differences = Differences::new(take.rate);
    let mut done = Take::with_capacity(Arc::clone(&take.subject), take.rate, take.len());
    for mut frame in take.frames() {
        complete(&mut frame);
        if let Some(frame) = differences.push(frame) {
            done.push(&frame)?;
        }
    }
    for frame in differences.finish() {
        done.push(&frame)?;
    }
    Ok(done)
}

/// The take with signs of its quaternions that go on from one sample to the next: its samples through
/// [`ContinuousSigns`].
///
/// # Errors
/// None of a take whose sections fit its subject.
pub fn continuous(take: &Take) -> Result<Take, Error> {
    let mut signs = ContinuousSigns::new();
    let mut done = Take::with_capacity(Arc::clone(&take.subject), take.rate, take.len());
    let mut frame = Frame::new(Arc::clone(&take.subject));
    for place in 0..take.len() {
        take.read_frame(place, &mut frame);
        signs.apply(&mut frame);
        done.push(&frame)?;
    }
    Ok(done)
}

/// What is missing of a take: samples, and segments in them.
pub fn dropouts(take: &Take) -> Dropouts {
    let mut dropouts = Dropouts::new();
    let mut frame = Frame::new(Arc::clone(&take.subject));
    for place in 0..take.len() {
        take.read_frame(place, &mut frame);
        dropouts.add(&frame);
    }
    dropouts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, DVec3, Section, Skeleton, Subject};

    fn take(samples: impl IntoIterator<Item = u32>) -> Take {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        let mut frame = Frame::new(subject);
        for sample in samples {
            frame.sample = sample;
            let segments = &frame.subject.skeleton.segments;
            let walked = DVec3::X * f64::from(sample) / 60.0;
            frame.position = segments.iter().map(|segment| Some(segment.origin? + walked)).collect();
            frame.orientation = vec![Some(DQuat::IDENTITY); 23];
            take.push(&frame).unwrap();
        }
        take
    }

    #[test]
    fn a_resampled_take_keeps_its_gaps() {
        let fast = resampled(&take([0, 1, 2, 5, 6]), 120.0).unwrap();
        assert_eq!(fast.samples(), [0, 1, 2, 3, 4, 10, 11, 12]);
        assert_eq!((fast.rate, fast.subject.rate), (120.0, Some(120.0)));
        assert_eq!(resampled(&fast, 0.0), Err(Error::Rate { found: 0.0 }));
        assert_eq!(resampled(&take([]), 120.0).unwrap().len(), 0);
    }

    #[test]
    fn what_is_missing_of_a_take_is_told() {
        let mut take = take([0, 1, 2, 5, 6]);
        let mut frame = take.frame(4);
        (frame.sample, frame.orientation[9]) = (7, None);
        take.push(&frame).unwrap();
        let dropouts = dropouts(&take);
        assert_eq!(dropouts.missing().runs, [[3, 4]]);
        let untracked: Vec<_> = dropouts.untracked().map(|runs| runs.count).collect();
        assert_eq!((untracked[9], untracked.iter().sum()), (1, 1_u64));
    }

    #[test]
    fn signs_of_a_take_go_on() {
        let mut flipping = take([0]);
        let mut frame = flipping.frame(0);
        for sample in 1..4 {
            frame.sample = sample;
            frame.orientation = vec![Some(-frame.orientation[0].unwrap()); 23];
            flipping.push(&frame).unwrap();
        }
        let signs = continuous(&flipping).unwrap();
        let turns = signs.column(Section::Orientation).unwrap();
        assert!((0..4).all(|sample| turns.quaternion(sample, 22) == Some(DQuat::IDENTITY)));
    }

    #[test]
    fn a_take_of_poses_is_completed() {
        let done = completed(&take(0..5)).unwrap();
        let velocity = done.column(Section::CenterOfMassVelocity).unwrap();
        assert!((velocity.vector(4, 0).unwrap() - DVec3::X).length() < 1e-9);
        assert!(done.column(Section::JointAnglesXzy).is_some());
        assert_eq!(done.len(), 5);
        assert_eq!(completed(&done).unwrap(), done);
    }
}
