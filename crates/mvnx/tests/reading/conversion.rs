//! Files in the version that they were not of.

use crate::contents::read;
use crate::made_up::MadeUp;
use crate::reference::reference;
use crate::round_trip::{assert_same, written};
use posewire_motion::{DQuat, DVec3, Frame};
use posewire_mvnx::{CalibrationKind, LeftOut, Reader, Reason, Version};

fn version_3() -> String {
    MadeUp {
        version: 3,
        fingers: true,
        ..MadeUp::default()
    }
    .write()
}

/// Compares two files word by word, numbers to a millionth.
fn assert_same_numbers(found: &str, expected: &str) {
    let words = |text: &str| -> Vec<String> {
        {
            let words = text.split(['<', '>', ' ', '\n', '\t']);
            words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
        }
    };
    let (found, expected) = (words(found), words(expected));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        let numbers = (found.parse::<f64>(), expected.parse::<f64>());
        let same = match numbers {
            (Ok(found), Ok(expected)) => (found - expected).abs() < 1.5e-6,
            _ => found == expected,
        };
        assert!(same, "{found} is not {expected}");
    }
}

/// Compares the poses of frames, which the conversion may round once more.
fn assert_same_poses(found: &[Frame], expected: &[Frame]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let pairs = found.orientation.iter().zip(&expected.orientation);
        let difference = |(a, b): (&Option<DQuat>, &Option<DQuat>)| (a.unwrap() - b.unwrap()).length();
        assert!(pairs.map(difference).fold(0.0, f64::max) < 2.5e-6);
        assert_eq!(found.position, expected.position);
        assert_eq!(
            (found.sample, found.time, found.timecode),
            (expected.sample, expected.time, expected.timecode)
        );
        assert_eq!(found.sensor_magnetic_field, expected.sensor_magnetic_field);
        assert_eq!(found.joint_angles, expected.joint_angles);
    }
}

fn left_out(what: &str, reason: Reason, times: u64) -> LeftOut {
    LeftOut {
        what: what.to_owned(),
        reason,
        times,
    }
}

/// What a conversion and its return change: the code, and attributes that version 4 asks for.
fn returned(text: &str) -> String {
    text.replace("code=\"0123abcd\"", "code=\"\"")
        .replace("odd=\"kept\"", "odd=\"kept\" configuration=\"\" userScenario=\"\"")
}

#[test]
fn version_3_becomes_4_and_3_again() {
    let text = version_3();
    let (four, left) = written(&text, Version::V4);
    assert_eq!(left, [left_out("securityCode", Reason::Converted, 1)]);
    assert!(four.contains(" version=\"4\">") && !four.contains("pos_s"));
    assert_same_poses(&read(&four), &read(&text));
    let (three, left) = written(&four, Version::V3);
    assert_eq!(left, []);
    let numbered = text
        .replacen("index=\"\" tc=\"00:00:00:00\"", "index=\"-3\" tc=\"00:00:00:00\"", 1)
        .replacen("index=\"\" tc=\"00:00:00:00\"", "index=\"-2\" tc=\"00:00:00:00\"", 1);
    assert_same_numbers(&three, &returned(&numbered));
}

#[test]
fn the_other_version_holds_the_same_skeleton_and_poses_of_calibration() {
    let (three, four) = (version_3(), written(&version_3(), Version::V4).0);
    let reader = Reader::new(four.as_bytes()).unwrap();
    let kinds: Vec<_> = reader.calibration().iter().map(|pose| pose.kind).collect();
    assert_eq!(
        kinds,
        [
            CalibrationKind::Identity,
            CalibrationKind::TPose,
            CalibrationKind::TPoseIsb
        ]
    );
    let expected = Reader::new(three.as_bytes()).unwrap().subject().clone();
    for (found, expected) in reader
        .subject()
        .skeleton
        .segments
        .iter()
        .zip(&expected.skeleton.segments)
    {
        assert_eq!((found.origin, found.isb), (expected.origin, expected.isb));
        assert_eq!((&found.name, &found.points), (&expected.name, &expected.points));
    }
    assert_eq!(reader.subject().skeleton.joints, expected.skeleton.joints);
    let arms: Vec<_> = reader.calibration().iter().map(|pose| pose.orientation[8]).collect();
    let held = Reader::new(three.as_bytes()).unwrap().calibration()[1].orientation[8];
    assert_eq!((arms[0], arms[2]), (Some(DQuat::IDENTITY), held));
}

#[test]
fn what_version_3_has_no_place_for_is_left_out_and_told() {
    let text = MadeUp::default().write();
    let (three, left) = written(&text, Version::V3);
    assert_eq!(
        left,
        [
            left_out("footContactDefinition", Reason::Version(Version::V3), 1),
            left_out("sensorFreeAcceleration", Reason::Version(Version::V3), 3),
            left_out("footContacts", Reason::Version(Version::V3), 3),
            left_out("securityCode", Reason::Converted, 1),
        ]
    );
    assert_eq!(left[2].to_string(), "footContacts: no place in version 3 (3 times)");
    assert_eq!(
        left[3].to_string(),
        "securityCode: holds for the file before it was converted only"
    );
    let frames = read(&three);
    assert_same_poses(&frames, &read(&text));
    assert!(frames[0].contacts.is_empty() && frames[0].sensor_free_acceleration.is_empty());
    assert_eq!(frames[0].sensor_orientation.len(), 17);
}

#[test]
fn frames_of_other_types_are_not_converted() {
    let text = MadeUp::default().write();
    let ghost = text.replace(
        "index=\"6\" tc=\"04:17:11:84\" ms=\"1542082631852\" type=\"normal\"",
        "type=\"ghost\"",
    );
    let (three, left) = written(&ghost, Version::V3);
    assert_eq!(read(&three).len(), 2);
    assert!(left.contains(&left_out("frame of type ghost", Reason::Converted, 1)));
    assert_same(&crate::round_trip::again(&ghost), &ghost);
}

#[test]
fn without_poses_of_calibration_the_nominal_ones_are_written() {
    let made = MadeUp {
        calibration: false,
        ..MadeUp::default()
    };
    let (three, _) = written(&made.write(), Version::V3);
    let reader = Reader::new(three.as_bytes()).unwrap();
    assert_eq!(reader.calibration().len(), 2);
    assert_same_poses(&read(&three), &read(&made.write()));
}

#[test]
fn the_takes_of_mvn_return_to_their_version() {
    for (name, other) in [("meri-020.mvnx", Version::V4), ("test_mocap.mvnx", Version::V3)] {
        let Some(text) = reference(name) else { return };
        let own = Reader::new(text.as_bytes()).unwrap().document().version();
        let (converted, _) = written(&text, other);
        assert_same_poses(&read(&converted), &read(&text));
        let (back, _) = written(&converted, own);
        let changed = ["securityCode", "ootContact", "contactDef", "sensorFree"];
        let section = |line: &&str| !changed.iter().any(|part| line.contains(part));
        let lines = |text: &str| {
            text.lines()
                .map(str::trim)
                .filter(section)
                .collect::<Vec<_>>()
                .join("\n")
                .replace(" configuration=\"\" userScenario=\"\"", "")
        };
        assert_same_numbers(&lines(&back), &lines(&text));
    }
}

#[test]
fn an_arm_of_a_take_of_mvn_points_the_same_way_in_both_versions() {
    let Some(text) = reference("test_mocap.mvnx") else {
        return;
    };
    let (three, _) = written(&text, Version::V3);
    let (own, converted) = (read(&text), read(&three));
    let elbow = |frame: &Frame| {
        let offset = frame.subject.skeleton.segments[8].point(2).unwrap().offset;
        frame.pose(8).unwrap().transform(offset)
    };
    let distance = |(a, b): (&Frame, &Frame)| DVec3::distance(elbow(a), elbow(b));
    assert!(own.iter().zip(&converted).map(distance).fold(0.0, f64::max) < 1e-6);
    // As the file has it, the arm is in ISB axes: not the same number.
    let first = |text: &str| {
        text.split("type=\"normal\"")
            .nth(1)
            .unwrap()
            .lines()
            .nth(1)
            .unwrap()
            .to_owned()
    };
    assert_ne!(first(&three), first(&text));
}
