//! The reference takes, where they are: every number against an independent reading of the text.

use crate::contents::{assert_equal, section};
use posewire_motion::kinematics::{LargestGaps, ergonomic_angles, joint_angles};
use posewire_motion::rotation::{Sequence, continuous};
use posewire_motion::{DQuat, DVec3, Frame};
use posewire_mvnx::Reader;
use std::path::Path;

/// The text of a reference take.
pub(crate) fn reference(name: &str) -> Option<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data/mvnx")
        .join(name);
    let text = std::fs::read_to_string(path).ok();
    if text.is_none() {
        println!("skipped: reference data not here");
    }
    text
}

/// The normal frames as a plain scan of the text finds them: sections by name.
fn scan(text: &str) -> Vec<Vec<(&str, Vec<f64>)>> {
    let blocks = text.split("<frame ").skip(1);
    let normal = blocks.filter(|block| block.lines().next().unwrap().contains("\"normal\""));
    normal
        .map(|block| block.lines().skip(1).filter_map(scan_line).collect())
        .collect()
}

/// A line `<name>numbers</name>`.
fn scan_line(line: &str) -> Option<(&str, Vec<f64>)> {
    let (name, rest) = line.trim().strip_prefix('<')?.split_once('>')?;
    let (numbers, _) = rest.split_once('<')?;
    Some((
        name,
        numbers
            .split_whitespace()
            .map(|number| number.parse().unwrap())
            .collect(),
    ))
}

fn frames(text: &str) -> Vec<Frame> {
    Reader::new(text.as_bytes()).unwrap().map(Result::unwrap).collect()
}

/// Compares every section but those named.
fn assert_same(frames: &[Frame], scanned: &[Vec<(&str, Vec<f64>)>], sections: usize, but: &str) {
    assert_eq!(frames.len(), scanned.len());
    for (frame, expected) in frames.iter().zip(scanned) {
        assert_eq!(expected.len(), sections);
        for (name, expected) in expected.iter().filter(|(name, _)| *name != but) {
            assert_equal(&section(frame, name, 23), expected, name);
        }
    }
}

fn largest_gap(frames: &[Frame]) -> f64 {
    let mut gaps = LargestGaps::new();
    for frame in frames {
        gaps.add(frame);
    }
    assert!(gaps.joints().iter().all(Option::is_some));
    gaps.worst().unwrap().1
}

/// The largest difference between angles worked out from orientations and those of the file, degrees.
fn largest_difference(found: &[Option<DVec3>], expected: &[Option<DVec3>]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let difference = |(found, expected): (&Option<DVec3>, &Option<DVec3>)| {
        let difference = (found.unwrap() - expected.unwrap()).abs().max_element();
        difference.to_degrees()
    };
    found.iter().zip(expected).map(difference).fold(0.0, f64::max)
}

/// Joint angles tell whether the segments' ISB axes are right.
fn assert_joint_angles(frames: &[Frame]) {
    let (mut angles, mut xzy) = (Vec::new(), Vec::new());
    for frame in frames {
        let skeleton = &frame.subject.skeleton;
        joint_angles(skeleton, &frame.orientation, Sequence::Zxy, &mut angles);
        assert!(largest_difference(&angles, &frame.joint_angles) < 0.003);
        joint_angles(skeleton, &frame.orientation, Sequence::Xzy, &mut xzy);
        assert!(largest_difference(&xzy, &frame.joint_angles_xzy) < 0.003);
        if !frame.ergonomic_angles.is_empty() {
            ergonomic_angles(skeleton, &frame.orientation, Sequence::Zxy, &mut angles);
            assert!(largest_difference(&angles, &frame.ergonomic_angles) < 0.003);
        }
    }
}

#[test]
fn every_number_of_the_version_4_take_is_read() {
    let Some(text) = reference("test_mocap.mvnx") else {
        return;
    };
    let (frames, scanned) = (frames(&text), scan(&text));
    assert_eq!(frames.len(), 112);
    assert_same(&frames, &scanned, 14, "");
    assert!(largest_gap(&frames) < 0.04, "{}", largest_gap(&frames));
    assert_joint_angles(&frames);
    let last = &frames[111];
    assert_eq!((last.sample, last.subject.rate), (111, Some(60.0)));
    assert_eq!(frames[1].timecode.unwrap().to_string(), "04:17:11.859");
}

#[test]
fn the_version_4_take_is_described() {
    let Some(text) = reference("test_mocap.mvnx") else {
        return;
    };
    let mut reader = Reader::new(text.as_bytes()).unwrap();
    assert_eq!(reader.by_ref().count(), 112);
    let (header, skeleton) = (reader.header(), &reader.subject().skeleton);
    assert_eq!(header.subject_attribute("configuration"), Some("UpperBody"));
    assert_eq!(
        header
            .segments
            .iter()
            .map(|segment| segment.points.len())
            .sum::<usize>(),
        127
    );
    assert!(header.security_code.is_some() && header.unknown.is_empty());
    assert_eq!(
        (
            skeleton.sensors.len(),
            skeleton.contacts.len(),
            skeleton.ergonomic_angles.len()
        ),
        (11, 4, 4)
    );
    assert!(
        skeleton
            .joints
            .iter()
            .all(|joint| joint.parent.point > 0 && joint.child.point > 0)
    );
    assert!(skeleton.segments.iter().all(|segment| segment.origin.is_some()));
    assert_eq!(skeleton.segments[3].isb, DQuat::IDENTITY);
    assert_eq!((reader.sections().len(), reader.counts().calibration), (14, 3));
    assert!(
        reader
            .sections()
            .iter()
            .all(|section| section.known && section.frames == 112)
    );
}

#[test]
fn every_number_of_the_version_3_take_is_read_and_its_arms_are_turned() {
    let Some(text) = reference("meri-020.mvnx") else {
        return;
    };
    let (frames, scanned) = (frames(&text), scan(&text));
    assert_eq!(frames.len(), 4);
    assert_same(&frames, &scanned, 13, "orientation");
    let nominal = posewire_motion::standard::BODY_SEGMENTS;
    for (frame, expected) in frames.iter().zip(&scanned) {
        let orientation = &expected[0].1;
        for (place, segment) in nominal.iter().enumerate() {
            let n = &orientation[4 * place..];
            let (found, written) = (
                frame.orientation[place].unwrap(),
                DQuat::from_xyzw(n[1], n[2], n[3], n[0]),
            );
            let turn = segment.isb();
            if turn == DQuat::IDENTITY {
                assert_eq!(found, written, "{}", segment.name);
            } else {
                let back = continuous(found * turn, written);
                assert!((back - written).length() < 2e-6, "{}: {back} {written}", segment.name);
            }
        }
    }
    assert!(largest_gap(&frames) < 0.04, "{}", largest_gap(&frames));
    assert_joint_angles(&frames);
    assert_eq!(frames[3].timecode.unwrap().to_string(), "15:59:46.284");
}

#[test]
fn joints_tell_the_origins_that_calibration_gives() {
    for name in ["test_mocap.mvnx", "meri-020.mvnx"] {
        let Some(text) = reference(name) else { return };
        let begin = text.find("<frame ").unwrap();
        let recording = text[..text.find("type=\"normal\"").unwrap()].rfind("<frame ").unwrap();
        let bare = text[..begin].to_owned() + &text[recording..];
        let [calibrated, bare] = [&text, &bare].map(|text| Reader::new(text.as_bytes()).unwrap());
        assert!(bare.calibration().is_empty());
        let segments = |reader: &Reader<_>| reader.subject().skeleton.segments.clone();
        for (bare, calibrated) in segments(&bare).iter().zip(&segments(&calibrated)) {
            let distance = bare.origin.unwrap().distance(calibrated.origin.unwrap());
            assert!(distance < 3e-6, "{name} {}: {distance}", bare.name);
        }
    }
}
