//! Rotations, positions and samples in between, of real motion.

use crate::scan::Take;
use posewire_motion::kinematics::{ContinuousSigns, Resampler, forward_kinematics, local_rotations};
use posewire_motion::{DQuat, Frame};

const TAKES: [&str; 2] = ["test_mocap.mvnx", "meri-020.mvnx"];

/// A body that is posed by rotations alone differs from the measured one: its segments are rigidly linked.
#[test]
fn local_rotations_pose_the_body_to_some_millimetres() {
    for name in TAKES {
        let Some(take) = Take::read(name) else { return };
        let mut largest = 0.0_f64;
        let (mut local, mut orientation, mut position) = (Vec::new(), Vec::new(), Vec::new());
        for frame in take.poses() {
            let skeleton = &frame.subject.skeleton;
            local_rotations(skeleton, &frame.orientation, &mut local);
            let root = frame.position[0].unwrap();
            forward_kinematics(skeleton, root, &local, &mut orientation, &mut position);
            for (found, measured) in orientation.iter().zip(&frame.orientation) {
                assert!((found.unwrap() - measured.unwrap()).length() < 1e-12);
            }
            let off = position.iter().zip(&frame.position);
            let off = off.map(|(found, measured)| found.unwrap().distance(measured.unwrap()));
            largest = off.fold(largest, f64::max);
        }
        println!(
            "{name}: positions from rotations alone are off by {:.1} mm at most",
            largest * 1000.0
        );
        assert!(largest < 0.005, "{name}: {largest}");
    }
}

/// Every other sample is left out and interpolated again.
#[test]
fn interpolated_samples_are_near_those_measured() {
    for name in TAKES {
        let Some(take) = Take::read(name) else { return };
        let measured = take.poses();
        let mut resampler = Resampler::new(30.0, 60.0).unwrap();
        let half = measured.iter().step_by(2).map(|frame| Frame {
            sample: frame.sample / 2,
            ..frame.clone()
        });
        let mut found: Vec<_> = half
            .flat_map(|frame| resampler.push(frame).collect::<Vec<_>>())
            .collect();
        found.extend(resampler.finish());
        let (mut turned, mut moved) = (0.0_f64, 0.0_f64);
        for (found, measured) in found.iter().zip(&measured) {
            assert_eq!(found.sample, measured.sample);
            for segment in 0..23 {
                let (found, measured) = (found.pose(segment).unwrap(), measured.pose(segment).unwrap());
                turned = turned.max(angle(found.orientation, measured.orientation).to_degrees());
                moved = moved.max(found.position.distance(measured.position));
            }
        }
        println!(
            "{name}: every other sample is interpolated to {turned:.2} degrees and {:.1} mm",
            moved * 1000.0
        );
        assert!(turned < 1.0 && moved < 0.005, "{name}: {turned} {moved}");
        assert_eq!(found.len(), measured.len() - (measured.len() + 1) % 2);
    }
}

#[test]
fn signs_of_a_take_are_made_continuous() {
    for name in TAKES {
        let Some(take) = Take::read(name) else { return };
        let mut signs = ContinuousSigns::new();
        let mut before: Option<Frame> = None;
        for mut frame in take.poses() {
            // As a writer that takes the sign with a positive w would flip them.
            for turn in frame.orientation.iter_mut().flatten() {
                *turn = if turn.w < 0.0 { -*turn } else { *turn };
            }
            signs.apply(&mut frame);
            if let Some(before) = before {
                let pairs = before.orientation.iter().zip(&frame.orientation);
                assert!(pairs.into_iter().all(|(a, b)| a.unwrap().dot(b.unwrap()) > 0.9));
            }
            before = Some(frame);
        }
    }
}

fn angle(a: DQuat, b: DQuat) -> f64 {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    4.0 * ((a - b).length() / 2.0).asin()
}
