//! Joint angles and the centre of mass against those that MVN wrote into two takes.

use crate::scan::{Take, nominal, numbers, quaternions, vectors};
use posewire_motion::kinematics::{center_of_mass, ergonomic_angles, joint_angles};
use posewire_motion::rotation::Sequence;
use posewire_motion::{DQuat, DVec3, Skeleton};

/// The largest error that the six decimals of a file's quaternions explain, degrees.
const LARGEST_ERROR: f64 = 0.003;
/// 22 joints in both sequences and four ergonomic angles in one.
const ALL_OF_VERSION_4: [usize; 4] = [112 * 22, 112 * 4, 112 * 22, 0];

#[test]
fn angles_of_a_version_4_take_are_those_of_the_file() {
    let Some(take) = Take::read("test_mocap.mvnx") else {
        return;
    };
    let (body, isb) = (take.calibration("tpose"), take.calibration("tpose-isb"));
    let isb: Vec<_> = body
        .iter()
        .zip(&isb)
        .map(|(body, isb)| body.conjugate() * *isb)
        .collect();
    let skeleton = take.skeleton(&isb);
    assert_eq!(check(&take, &skeleton, |_, orientation| orientation), ALL_OF_VERSION_4);
    // A live stream has no T-pose frames: the nominal axes serve as well.
    assert_eq!(
        check(&take, &take.skeleton(&nominal()), |_, orientation| orientation),
        ALL_OF_VERSION_4
    );
}

#[test]
fn angles_of_a_version_3_take_are_those_of_the_file() {
    let Some(take) = Take::read("meri-020.mvnx") else {
        return;
    };
    let arms = take.calibration("npose");
    let skeleton = take.skeleton(&arms);
    let canonical = |place: usize, orientation: DQuat| orientation * arms[place].conjugate();
    assert_eq!(check(&take, &skeleton, canonical), [4 * 22, 0, 4 * 22, 0]);
}

#[test]
fn the_centre_of_mass_is_near_that_of_the_file() {
    for (name, version) in [("test_mocap.mvnx", 4), ("meri-020.mvnx", 3)] {
        let Some(take) = Take::read(name) else { return };
        let skeleton = take.skeleton(&nominal());
        let (mut largest, mut higher, mut frames) = (0.0_f64, 0.0, 0.0);
        for frame in take.frames("normal") {
            let position = vectors(frame, "position");
            let mut orientation = quaternions(frame, "orientation");
            if version == 3 {
                let arms = take.calibration("npose");
                orientation = orientation
                    .iter()
                    .zip(arms)
                    .map(|(turn, arm)| *turn * arm.conjugate())
                    .collect();
            }
            let position: Vec<_> = position.into_iter().map(Some).collect();
            let orientation: Vec<_> = orientation.into_iter().map(Some).collect();
            let found = center_of_mass(&skeleton, &position, &orientation).unwrap();
            let expected = DVec3::from_slice(&numbers(frame, "centerOfMass").unwrap()[..3]);
            largest = largest.max(found.distance(expected));
            (higher, frames) = (higher + found.z - expected.z, frames + 1.0);
        }
        let (within, higher) = (largest * 1000.0, higher / frames * 1000.0);
        println!("{name}: centre of mass within {within:.1} mm, {higher:.1} mm higher in the mean");
        assert!(largest < 0.025, "{name}: {largest}");
    }
}

/// Compares every angle of every sample, and gives how many there are: of joints and ergonomic ones, ZXY and XZY.
fn check(take: &Take, skeleton: &Skeleton, canonical: impl Fn(usize, DQuat) -> DQuat) -> [usize; 4] {
    let mut found = Vec::new();
    let mut worst = [0.0_f64; 4];
    let mut compared = [0; 4];
    for frame in take.frames("normal") {
        let turns = quaternions(frame, "orientation").into_iter().enumerate();
        let orientation: Vec<_> = turns.map(|(place, turn)| Some(canonical(place, turn))).collect();
        for (sequence, joints, ergonomic, slot) in [
            (Sequence::Zxy, "jointAngle", "jointAngleErgo", 0),
            (Sequence::Xzy, "jointAngleXZY", "jointAngleErgoXZY", 2),
        ] {
            joint_angles(skeleton, &orientation, sequence, &mut found);
            worst[slot] = worst[slot].max(largest_error(frame, joints, &found));
            compared[slot] += entries(frame, joints);
            ergonomic_angles(skeleton, &orientation, sequence, &mut found);
            worst[slot + 1] = worst[slot + 1].max(largest_error(frame, ergonomic, &found));
            compared[slot + 1] += entries(frame, ergonomic);
        }
    }
    println!("largest error in degrees, joints and ergonomic, ZXY and XZY: {worst:.4?}");
    assert!(worst.iter().all(|&error| error <= LARGEST_ERROR), "{worst:?}");
    compared
}

/// How many angles an element of a frame holds.
fn entries(frame: &str, element: &str) -> usize {
    numbers(frame, element).map_or(0, |numbers| numbers.len() / 3)
}

/// How far the angles are from those of an element, degrees; 0 when the frame has no such element.
fn largest_error(frame: &str, element: &str, found: &[Option<DVec3>]) -> f64 {
    if numbers(frame, element).is_none() {
        return 0.0;
    }
    let expected = vectors(frame, element);
    assert!(expected.len() <= found.len());
    let errors = expected.iter().zip(found).map(|(expected, found)| {
        let off = found.unwrap().to_array().map(f64::to_degrees);
        let off = off.into_iter().zip(expected.to_array()).map(|(found, expected)| {
            let turns = ((found - expected) / 360.0).round();
            (found - expected - 360.0 * turns).abs()
        });
        off.fold(0.0, f64::max)
    });
    errors.fold(0.0, f64::max)
}
