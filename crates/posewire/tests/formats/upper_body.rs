//! A take of MVN's `UpperBody` configuration: all 23 segments, and the first 11 of the 17 sensors.

use crate::{formats, written};
use posewire::endpoint::FileFormat;
use posewire_motion::{DQuat, DVec3, Frame, Section, Skeleton, Subject, Take};
use posewire_mvnx::{Reader, read_take};
use std::sync::Arc;

fn upper_body() -> Take {
    let mut skeleton = Skeleton::standard(0, false);
    skeleton.sensors.truncate(11);
    let subject = Arc::new(Subject::new("Ada", skeleton));
    let mut take = Take::new(Arc::clone(&subject), 60.0);
    for sample in 0..4_u32 {
        let mut frame = Frame::new(Arc::clone(&subject));
        let turn = DQuat::from_rotation_y(0.1 * f64::from(sample));
        frame.sample = sample;
        frame.position = subject.skeleton.segments.iter().map(|segment| segment.origin).collect();
        frame.orientation = vec![Some(turn); 23];
        frame.joint_angles = vec![Some(DVec3::ZERO); 22];
        frame.sensor_orientation = vec![Some(turn); 11];
        frame.sensor_free_acceleration = vec![Some(DVec3::Z * f64::from(sample)); 11];
        take.push(&frame).unwrap();
    }
    take
}

#[test]
fn a_take_of_eleven_sensors_becomes_a_file_of_every_format() {
    let take = upper_body();
    for format in formats() {
        let (file, left_out) = written(format, &take);
        assert!(!file.is_empty(), "{format}");
        let holds_sensors = matches!(
            format,
            FileFormat::Mvnx | FileFormat::MvnxGz | FileFormat::Csv | FileFormat::Npz | FileFormat::Parquet
        );
        let told = left_out.iter().any(|what| what == "sensor orientation");
        assert_eq!(told, !holds_sensors, "{format}: {left_out}");
    }
}

#[test]
fn eleven_sensors_are_read_back() {
    let take = upper_body();
    let (file, _) = written(FileFormat::Mvnx, &take);
    let back = read_take(&mut Reader::new(&file[..]).unwrap()).unwrap();
    assert_eq!(back.subject.skeleton.sensors, take.subject.skeleton.sensors);
    let shape = |take: &Take| take.column(Section::SensorOrientation).unwrap().shape();
    assert_eq!((shape(&back), shape(&take)), ([4, 11, 4], [4, 11, 4]));
    let (csv, _) = written(FileFormat::Csv, &take);
    let names = String::from_utf8(csv).unwrap().lines().next().unwrap().to_owned();
    let sensors = names
        .split(',')
        .filter(|name| name.starts_with("Sensor Orientation - Quat "));
    assert_eq!(sensors.count(), 44);
}
