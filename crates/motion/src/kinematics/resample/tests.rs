use super::*;
use crate::kinematics::complete;
use crate::{DQuat, DVec3, Skeleton};
use proptest::prelude::*;

fn subject() -> Arc<Subject> {
    Arc::new(Subject::new("Ada", Skeleton::standard(0, false)))
}

/// A sample of someone who moves along X by 1 m a sample and turns about Z.
fn moving(subject: &Arc<Subject>, sample: u32) -> Frame {
    let mut frame = Frame::new(Arc::clone(subject));
    frame.sample = sample;
    let sign = if sample.is_multiple_of(2) { 1.0 } else { -1.0 };
    frame.position = vec![Some(DVec3::X * f64::from(sample)); 23];
    frame.orientation = vec![Some(DQuat::from_rotation_z(0.1 * f64::from(sample)) * sign); 23];
    frame.contacts = vec![sample.is_multiple_of(2); 4];
    frame
}

fn resampled(from: f64, to: f64, frames: impl IntoIterator<Item = Frame>) -> Vec<Frame> {
    let mut resampler = Resampler::new(from, to).unwrap();
    let mut done: Vec<_> = frames
        .into_iter()
        .flat_map(|frame| resampler.push(frame).collect::<Vec<_>>())
        .collect();
    done.extend(resampler.finish());
    done
}

fn numbers(frames: &[Frame]) -> Vec<u32> {
    frames.iter().map(|frame| frame.sample).collect()
}

fn events(frames: &[Frame]) -> Vec<(u32, String)> {
    let events = frames
        .iter()
        .flat_map(|frame| frame.events.iter().map(|event| (frame.sample, event.clone())));
    events.collect()
}

#[test]
fn each_fourth_sample_of_240_makes_60() {
    let subject = subject();
    let done = resampled(240.0, 60.0, (6..=21).map(|sample| moving(&subject, sample)));
    assert_eq!(numbers(&done), [2, 3, 4, 5]);
    let x: Vec<_> = done.iter().map(|frame| frame.position[3].unwrap().x).collect();
    assert_eq!(x, [8.0, 12.0, 16.0, 20.0]);
    assert_eq!(done[1].time, Duration::from_millis(50));
    assert_eq!(done[1].subject.rate, Some(60.0));
}

#[test]
fn angles_between_are_those_of_the_orientations_between() {
    let subject = subject();
    let bent = |sample: u32| {
        let mut frame = moving(&subject, sample);
        for (segment, turn) in frame.orientation.iter_mut().enumerate() {
            let angle = 0.4 * f64::from(sample) * (segment as f64).sin();
            *turn = Some(DQuat::from_euler(glam::EulerRot::ZXY, angle, 1.1 * angle, 0.3 * angle));
        }
        complete(&mut frame);
        frame.ergonomic_angles[5] = None;
        frame
    };
    for frame in resampled(60.0, 240.0, (0..6).map(bent)) {
        let mut expected = Frame::new(Arc::clone(&subject));
        expected.orientation.clone_from(&frame.orientation);
        complete(&mut expected);
        expected.ergonomic_angles[5] = None;
        for (found, expected) in [
            (&frame.joint_angles, &expected.joint_angles),
            (&frame.joint_angles_xzy, &expected.joint_angles_xzy),
            (&frame.ergonomic_angles, &expected.ergonomic_angles),
            (&frame.ergonomic_angles_xzy, &expected.ergonomic_angles_xzy),
        ] {
            let same = |(a, b): (&Option<DVec3>, &Option<DVec3>)| match (a, b) {
                (Some(a), Some(b)) => (a - b).length() < 1e-9,
                (a, b) => a.is_none() && b.is_none(),
            };
            assert!(found.iter().zip(expected).all(same), "sample {}", frame.sample);
        }
    }
}

#[test]
fn angles_without_orientations_are_interpolated() {
    let subject = subject();
    let frames = (0..3).map(|sample| {
        let mut frame = Frame::new(Arc::clone(&subject));
        frame.sample = sample;
        frame.joint_angles = vec![Some(DVec3::X * 0.1 * f64::from(sample)); 22];
        frame
    });
    let done = resampled(60.0, 120.0, frames);
    assert!((done[1].joint_angles[7].unwrap().x - 0.05).abs() < 1e-12);
}

#[test]
fn samples_between_are_on_the_way_and_signs_go_on() {
    let subject = subject();
    let done = resampled(60.0, 100.0, (0..=6).map(|sample| moving(&subject, sample)));
    assert_eq!(numbers(&done), (0..=10).collect::<Vec<_>>());
    for frame in &done {
        let instant = 0.6 * f64::from(frame.sample);
        assert!((frame.position[0].unwrap().x - instant).abs() < 1e-9);
        let expected = DQuat::from_rotation_z(0.1 * instant);
        assert!((frame.orientation[0].unwrap() - expected).length() < 1e-9, "{instant}");
    }
    assert_eq!(done[1].contacts, vec![false; 4], "0.6 is nearer to sample 1");
}

#[test]
fn nothing_is_made_up_where_samples_are_missing() {
    let subject = subject();
    let frames = [0, 1, 2, 5, 6].map(|sample| moving(&subject, sample));
    let done = resampled(60.0, 120.0, frames.clone());
    assert_eq!(numbers(&done), [0, 1, 2, 3, 4, 10, 11, 12]);
    let mut resampler = Resampler::new(60.0, 120.0).unwrap().longest_gap(2);
    let count: usize = frames.into_iter().map(|frame| resampler.push(frame).count()).sum();
    assert_eq!(count + resampler.finish().count(), 13);
}

#[test]
fn what_is_not_tracked_is_not_made_up() {
    let subject = subject();
    let mut frames: Vec<_> = (0..=3).map(|sample| moving(&subject, sample)).collect();
    frames[1].position[7] = None;
    frames[2].orientation[9] = Some(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0));
    let done = resampled(60.0, 120.0, frames);
    let untracked: Vec<_> = done.iter().map(|frame| frame.position[7].is_none()).collect();
    assert_eq!(untracked, [false, true, true, true, false, false, false]);
    assert_eq!((done[3].orientation[9], done[5].orientation[9]), (None, None));
}

#[test]
fn every_event_goes_to_the_nearest_sample_once() {
    let subject = subject();
    let frames = (0..=10).map(|sample| {
        let mut frame = moving(&subject, sample);
        frame.events = vec![sample.to_string()];
        frame
    });
    let expected = [
        (0, "0"),
        (0, "1"),
        (1, "2"),
        (1, "3"),
        (1, "4"),
        (1, "5"),
        (2, "6"),
        (2, "7"),
        (2, "8"),
        (2, "9"),
    ];
    let expected = expected.into_iter().chain([(2, "10")]);
    let expected: Vec<_> = expected.map(|(sample, name)| (sample, name.to_owned())).collect();
    assert_eq!(events(&resampled(240.0, 60.0, frames)), expected);
}

#[test]
fn a_counter_that_starts_anew_starts_a_run() {
    let subject = subject();
    let done = resampled(60.0, 30.0, [7, 8, 9, 0, 1, 2].map(|sample| moving(&subject, sample)));
    assert_eq!(numbers(&done), [4, 0, 1]);
}

#[test]
fn rates_that_are_none_are_refused() {
    for (from, to, found) in [
        (0.0, 60.0, 0.0),
        (60.0, -1.0, -1.0),
        (f64::INFINITY, 60.0, f64::INFINITY),
        (1.0, 1001.0, 1001.0),
    ] {
        assert_eq!(
            Resampler::new(from, to).err(),
            Some(Error::Rate { found }),
            "{from} to {to}"
        );
    }
    assert!(Resampler::new(f64::NAN, 60.0).is_err());
}

proptest! {
    #[test]
    fn at_the_same_rate_samples_stay_as_they_are(
        steps in prop::collection::vec(1_u32..4, 1..20),
        rate in prop::sample::select(vec![24.0, 59.94, 60.0, 100.0, 240.0]),
        first in 0_u32..4_000_000_000,
    ) {
        let subject = Arc::new(Subject { rate: Some(rate), ..Subject::clone(&subject()) });
        let numbers = steps.iter().scan(first, |sample, step| { *sample += step; Some(*sample) });
        let frames: Vec<_> = numbers.map(|sample| {
            let mut frame = moving(&subject, sample);
            frame.time = Duration::from_secs_f64(f64::from(sample) / rate);
            frame.orientation = vec![Some(DQuat::from_rotation_z(0.01 * f64::from(sample % 100))); 23];
            frame.events = vec!["clap".to_owned(); (sample % 3) as usize];
            frame
        }).collect();
        prop_assert_eq!(resampled(rate, rate, frames.clone()), frames);
    }

    #[test]
    fn any_samples_at_any_rates_give_rising_numbers_and_every_event(
        steps in prop::collection::vec((0_u32..6, any::<bool>()), 1..30),
        from in 1.0..500.0_f64,
        to in 1.0..500.0_f64,
    ) {
        let subject = subject();
        let numbers = steps.iter().scan(0, |sample, (step, _)| { *sample += step; Some(*sample) });
        let frames: Vec<_> = numbers.zip(&steps).map(|(sample, (_, event))| {
            let mut frame = moving(&subject, sample);
            frame.events = vec!["clap".to_owned(); usize::from(*event)];
            frame
        }).collect();
        let given = events(&frames).len();
        let done = resampled(from, to, frames);
        prop_assert!(done.is_empty() || events(&done).len() == given);
        let turns: Vec<_> = done.iter().map(|frame| frame.orientation[0].unwrap()).collect();
        prop_assert!(turns.windows(2).all(|pair| pair[0].dot(pair[1]) >= 0.0));
    }
}
