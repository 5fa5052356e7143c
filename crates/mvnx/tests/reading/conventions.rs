//! Files of both versions come out in the one canonical convention.

use crate::contents::{assert_equal, read, section};
use crate::made_up::{MadeUp, values};
use posewire_motion::{DQuat, DVec3};
use posewire_mvnx::{CalibrationKind, Reader};

fn quaternion(numbers: &[f64]) -> DQuat {
    DQuat::from_xyzw(numbers[1], numbers[2], numbers[3], numbers[0])
}

fn version_3() -> MadeUp {
    MadeUp {
        version: 3,
        ..MadeUp::default()
    }
}

#[test]
fn arms_of_version_3_are_turned_and_nothing_else_is() {
    for calibration in [true, false] {
        let made = MadeUp {
            calibration,
            ..version_3()
        };
        for (frame, number) in read(&made.write()).iter().zip(0..) {
            let written = values(number, "orientation", 92);
            for (place, segment) in made.skeleton().segments.iter().enumerate() {
                let found = frame.orientation[place].unwrap();
                let written = quaternion(&written[4 * place..]);
                if segment.isb == DQuat::IDENTITY {
                    assert_eq!(found, written, "{}", segment.name);
                } else {
                    let expected = written * segment.isb.conjugate();
                    assert!((found - expected).length() < 2e-6, "{}", segment.name);
                }
            }
            for (name, count) in made.sections().into_iter().filter(|(name, _)| *name != "orientation") {
                assert_equal(&section(frame, name, 23), &values(number, name, count), name);
            }
        }
    }
}

#[test]
fn version_3_takes_origins_and_axes_from_its_npose() {
    let (made, expected) = (version_3(), version_3().skeleton());
    let text = made.write();
    let reader = Reader::new(text.as_bytes()).unwrap();
    assert_eq!(reader.calibration()[0].kind, CalibrationKind::NPose);
    for (found, expected) in reader.subject().skeleton.segments.iter().zip(&expected.segments) {
        assert_eq!(found.origin, expected.origin);
        assert!(found.isb.angle_between(expected.isb) < 1e-5);
        assert_eq!(found.isb == DQuat::IDENTITY, expected.isb == DQuat::IDENTITY);
    }
}

#[test]
fn without_calibration_joints_tell_origins_and_axes_are_nominal() {
    let made = MadeUp {
        calibration: false,
        ..MadeUp::default()
    };
    let text = made.write();
    let reader = Reader::new(text.as_bytes()).unwrap();
    let segments = made.skeleton().segments;
    let toe = DVec3::Z * segments[22].origin.unwrap().z;
    for (found, expected) in reader.subject().skeleton.segments.iter().zip(&segments) {
        let expected_origin = expected.origin.unwrap() - toe;
        assert!(found.origin.unwrap().distance(expected_origin) < 1e-9);
        assert_eq!(found.isb, expected.isb);
    }
}

#[test]
fn axes_of_version_4_are_the_turn_between_its_two_t_poses() {
    // The right upper arm, half a turn about x between the poses instead of a quarter.
    let text = MadeUp::default().write();
    let nominal = posewire_motion::standard::BODY_SEGMENTS[8].isb();
    let arm = format!("{:.6} {:.6} {:.6} {:.6}", nominal.w, nominal.x, nominal.y, nominal.z);
    let turned = text.replacen(&arm, "0.000000 -1.000000 0.000000 0.000000", 1);
    let reader = Reader::new(turned.as_bytes()).unwrap();
    let isb = reader.subject().skeleton.segments[8].isb;
    assert!((isb - DQuat::from_xyzw(-1.0, 0.0, 0.0, 0.0)).length() < 1e-9, "{isb}");
    // A quaternion that is none says nothing: the nominal axes hold.
    let broken = text.replacen(&arm, "0.000000 0.000000 0.000000 0.000000", 1);
    let reader = Reader::new(broken.as_bytes()).unwrap();
    assert_eq!(reader.subject().skeleton.segments[8].isb, nominal);
}
