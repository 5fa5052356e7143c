//! Sections that were asked for, and those that were not.

use crate::{walk, written_with};
use posewire::Error;
use posewire::endpoint::FileFormat;
use posewire::file::{Progress, Recording, WriteOptions, write};
use posewire_motion::{CenterOfMass, DVec3, Section, Take};
use posewire_mvnx::{Reader, read_take};
use std::io::Cursor;
use std::sync::Arc;

fn only(sections: &[Section]) -> WriteOptions {
    WriteOptions {
        sections: Some(sections.to_vec()),
        ..WriteOptions::default()
    }
}

/// A walk whose every pose is known, with the centre of mass and its derivatives.
fn with_center() -> Take {
    let walk = walk();
    let mut take = Take::new(Arc::clone(&walk.subject), walk.rate);
    for mut frame in walk.frames() {
        frame.position = frame.position.iter().map(|place| place.or(Some(DVec3::Z))).collect();
        frame.orientation = frame
            .orientation
            .iter()
            .map(|turn| turn.or(frame.orientation[0]))
            .collect();
        frame.center_of_mass = Some(CenterOfMass {
            position: DVec3::Z,
            velocity: Some(DVec3::X),
            acceleration: Some(DVec3::ZERO),
        });
        take.push(&frame).unwrap();
    }
    take
}

#[test]
fn mvnx_has_its_poses_and_what_was_asked_for() {
    let take = with_center();
    let (file, left_out) = written_with(FileFormat::Mvnx, &take, &only(&[Section::CenterOfMass]));
    assert!(left_out.is_empty(), "{left_out}");
    let back = read_take(&mut Reader::new(&file[..]).unwrap()).unwrap();
    let expected = [Section::Position, Section::Orientation, Section::CenterOfMass];
    assert_eq!(back.sections().collect::<Vec<_>>(), expected);
    assert!((0..back.len()).all(|frame| back.contacts(frame).is_empty()) && back.events().is_empty());
    let (file, _) = written_with(FileFormat::Mvnx, &take, &only(&[Section::CenterOfMassVelocity]));
    let back = read_take(&mut Reader::new(&file[..]).unwrap()).unwrap();
    assert!(back.column(Section::CenterOfMassVelocity).is_some());
}

#[test]
fn events_of_c3d_are_not_there_when_sections_were_asked_for() {
    let has = |file: &[u8], name: &[u8]| file.windows(name.len()).any(|found| found == name);
    let (all, _) = written_with(FileFormat::C3d, &walk(), &WriteOptions::default());
    let (some, _) = written_with(FileFormat::C3d, &walk(), &only(&[Section::Position]));
    assert!(has(&all, b"left") && !has(&some, b"left"));
}

#[test]
fn what_a_format_needs_and_was_not_asked_for_is_not_written() {
    let recording = Recording::from(walk());
    for (format, sections) in [
        (FileFormat::Bvh, [Section::Position, Section::JointAngles]),
        (FileFormat::Sto, [Section::Position, Section::JointAngles]),
        (FileFormat::Mot, [Section::Position, Section::Orientation]),
        (FileFormat::Trc, [Section::Orientation, Section::JointAngles]),
    ] {
        let mut out = Cursor::new(Vec::new());
        let result = write(format, &recording, &only(&sections), &Progress::default(), &mut out);
        assert!(matches!(result, Err(Error::Lacks { .. })), "{format}: {result:?}");
    }
}
