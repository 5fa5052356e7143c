use super::super::tests::{text_of, walk};
use crate::endpoint::FileFormat;
use crate::file::{Axes, BvhOptions, WriteOptions};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject, Take};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Pelvis and L5: in the second frame the pelvis has turned left and the back is bent forward.
fn bent() -> Take {
    let mut skeleton = Skeleton::standard(0, false);
    skeleton.segments.truncate(2);
    skeleton.joints.truncate(1);
    skeleton.sensors.clear();
    skeleton.ergonomic_angles.clear();
    skeleton.segments[0].origin = Some(DVec3::new(0.0, 0.0, 1.0));
    skeleton.segments[1].origin = Some(DVec3::new(0.0, 0.01, 1.1));
    let subject = Arc::new(Subject::new("Ada", skeleton));
    let mut take = Take::new(Arc::clone(&subject), 50.0);
    let mut frame = Frame::new(subject);
    frame.position = vec![Some(DVec3::new(0.0, 0.0, 1.0)), Some(DVec3::new(0.0, 0.01, 1.1))];
    frame.orientation = vec![Some(DQuat::IDENTITY); 2];
    take.push(&frame).unwrap();
    let left = DQuat::from_rotation_z(FRAC_PI_2);
    frame.position = vec![Some(DVec3::new(1.0, 2.0, 1.0)), Some(DVec3::new(0.99, 2.0, 1.13))];
    frame.orientation = vec![Some(left), Some(left * DQuat::from_rotation_y(0.5))];
    take.push(&frame).unwrap();
    take
}

#[test]
fn a_bent_back_turns_about_the_axes_of_the_file() {
    let text = text_of(FileFormat::Bvh, bent(), &WriteOptions::default());
    let expected = "HIERARCHY\nROOT Pelvis\n{\n\tOFFSET 0.000000 0.000000 0.000000\n\tCHANNELS 6 Xposition Yposition \
        Zposition Yrotation Xrotation Zrotation\n\tJOINT L5\n\t{\n\t\tOFFSET 1.000000 10.000000 0.000000\n\t\tCHANNELS 3 \
        Yrotation Xrotation Zrotation\n\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0.000000 9.000000 0.000000\n\t\t}\n\t}\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.0200000000\n\
        0.000000 100.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000\n\
        200.000000 100.000000 100.000000 90.000000 0.000000 0.000000 0.000000 28.647890 0.000000\n";
    assert_eq!(text, expected);
}

#[test]
fn translations_keep_what_was_measured() {
    let options = WriteOptions {
        bvh: BvhOptions {
            translations: true,
            ..BvhOptions::default()
        },
        ..WriteOptions::default()
    };
    let text = text_of(FileFormat::Bvh, bent(), &options);
    let last: Vec<_> = text.lines().last().unwrap().split(' ').collect();
    // In the pelvis, L5 is 1 cm to the left and 13 cm up.
    assert_eq!(last[6..9], ["1.000000", "13.000000", "0.000000"]);
}

#[test]
fn the_first_frame_can_be_the_t_pose() {
    let options = WriteOptions {
        bvh: BvhOptions {
            first_frame_is_t_pose: true,
            ..BvhOptions::default()
        },
        ..WriteOptions::default()
    };
    let text = text_of(FileFormat::Bvh, bent().slice(1..2), &options);
    let last = text.lines().last().unwrap();
    assert!(
        last.starts_with("0.000000 100.000000 0.000000 0.000000 0.000000"),
        "{last}"
    );
}

#[test]
fn z_can_point_up() {
    let options = WriteOptions {
        axes: Some(Axes::ZUp),
        ..WriteOptions::default()
    };
    let text = text_of(FileFormat::Bvh, bent(), &options);
    let last: Vec<_> = text.lines().last().unwrap().split(' ').collect();
    assert_eq!(
        last[..6],
        [
            "100.000000",
            "200.000000",
            "100.000000",
            "0.000000",
            "0.000000",
            "90.000000"
        ]
    );
}

#[test]
fn every_frame_has_a_number_for_each_channel() {
    let text = text_of(FileFormat::Bvh, walk(4), &WriteOptions::default());
    let counts: Vec<_> = text.lines().rev().take(4).map(|line| line.split(' ').count()).collect();
    assert_eq!(counts, [72; 4]);
    assert_eq!(text.matches("CHANNELS 3").count(), 22);
    assert_eq!(text.matches('{').count(), text.matches('}').count());
}

#[test]
fn what_is_not_tracked_stays_where_it_was_and_is_said() {
    let mut take = bent();
    let mut frame = take.frame(1);
    frame.position[0] = None;
    frame.orientation[1] = None;
    take.push(&frame).unwrap();
    let mut out = std::io::Cursor::new(Vec::new());
    let options = WriteOptions::default();
    let left_out = crate::file::write(
        FileFormat::Bvh,
        &take.into(),
        &options,
        &crate::file::Progress::default(),
        &mut out,
    );
    let text = String::from_utf8(out.into_inner()).unwrap();
    let lines: Vec<_> = text.lines().rev().take(2).collect();
    assert_eq!(lines[0], lines[1]);
    let left_out = left_out.unwrap().to_string();
    assert!(left_out.contains("not tracked in 1 of 3 frames"), "{left_out}");
    assert!(left_out.contains("up to 31.6 mm at jL5S1"), "{left_out}");
}

#[test]
fn the_pose_before_stays_over_missing_samples() {
    let bent = bent();
    let mut take = Take::new(Arc::clone(&bent.subject), 50.0);
    for (sample, place) in [(7, 0), (10, 1)] {
        let mut frame = bent.frame(place);
        frame.sample = sample;
        take.push(&frame).unwrap();
    }
    let lines = |take, options: &WriteOptions| {
        let text = text_of(FileFormat::Bvh, take, options);
        let motion = text.split_once("MOTION\n").unwrap().1;
        motion.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let usual = WriteOptions::default();
    let (close, wide) = (lines(bent, &usual), lines(take.clone(), &usual));
    assert_eq!(wide[0], "Frames: 4");
    assert_eq!(
        wide[2..],
        [&close[2], &close[2], &close[2], &close[3]].map(String::clone)
    );
    let mut standing = usual;
    standing.bvh.first_frame_is_t_pose = true;
    assert_eq!(lines(take, &standing)[3..], wide[3..]);
}
