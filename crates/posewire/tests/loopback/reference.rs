//! Takes that MVN recorded, streamed with every type and compared number by number. They are not part of this
//! repository: without them the tests say so and pass.

use crate::harness::{Gathered, Receiver, over_udp, play, types};
use posewire::endpoint::Endpoint;
use posewire::sink::MxtpSink;
use posewire::source::PlaybackOptions;
use posewire_motion::{DQuat, DVec3, Frame, Skeleton};
use posewire_mxtp::MessageType;
use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

/// The path of a reference take, if it is here.
fn reference(name: &str) -> Option<String> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data/mvnx")
        .join(name);
    if !path.exists() {
        println!("skipped: reference data not here");
    }
    path.exists().then(|| path.to_string_lossy().into_owned())
}

fn frames_of(path: &str) -> Vec<Frame> {
    let reader = posewire_mvnx::Reader::new(BufReader::new(File::open(path).unwrap())).unwrap();
    reader.collect::<Result<_, _>>().unwrap()
}

fn playback() -> PlaybackOptions {
    PlaybackOptions::default()
}

#[test]
fn every_number_arrives_over_udp() {
    let Some(path) = reference("test_mocap.mvnx") else {
        return;
    };
    assert_every_number(&over_udp(&path, &playback(), types("all")), &path);
}

#[test]
fn every_number_arrives_over_tcp_when_we_connect() {
    let Some(path) = reference("test_mocap.mvnx") else {
        return;
    };
    let receiver = Receiver::start("mxtp+tcp://127.0.0.1:0");
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), types("all")).unwrap();
    let progress = play(&path, &playback(), sink);
    assert_every_number(&receiver.finish(progress.frames), &path);
}

#[test]
fn every_number_arrives_over_tcp_when_the_receiver_connects() {
    let Some(path) = reference("test_mocap.mvnx") else {
        return;
    };
    let listen: Endpoint = "mxtp+tcp://127.0.0.1:0?mode=listen".parse().unwrap();
    let sink = MxtpSink::open(&[listen], types("all")).unwrap();
    let ours = sink.progress().lock().unwrap().targets[0].endpoint.clone();
    let receiver = Receiver::start(&ours.replace("listen", "connect"));
    let progress = play(&path, &playback(), sink);
    assert_every_number(&receiver.finish(progress.frames), &path);
}

fn assert_every_number(gathered: &Gathered, path: &str) {
    gathered.assert_whole();
    for number in [1, 2, 3, 5, 20, 21, 22, 23, 24, 25] {
        let of_type = gathered.statistics_of(0, MessageType::new(number).unwrap());
        assert_eq!(of_type.counters.received, 112, "type {number}");
        assert!(
            (of_type.rate_hz - 60.0).abs() < 15.0,
            "type {number} at {} Hz",
            of_type.rate_hz
        );
    }
    let sent = frames_of(path);
    assert_eq!(gathered.frames.len(), sent.len());
    for (found, sent) in gathered.frames.iter().zip(&sent) {
        assert_same_frame(found, sent);
    }
}

fn assert_same_frame(found: &Frame, sent: &Frame) {
    assert_eq!(
        (found.sample, found.time, found.timecode),
        (sent.sample, sent.time, sent.timecode)
    );
    assert_eq!(vectors(&found.position, 1.0), vectors(&sent.position, 1.0));
    assert_eq!(quaternions(&found.orientation), quaternions(&sent.orientation));
    assert_eq!(vectors(&found.velocity, 1.0), vectors(&sent.velocity, 1.0));
    assert_eq!(vectors(&found.acceleration, 1.0), vectors(&sent.acceleration, 1.0));
    assert_eq!(
        vectors(&found.angular_velocity, 1.0),
        vectors(&sent.angular_velocity, 1.0)
    );
    assert_eq!(
        vectors(&found.angular_acceleration, 1.0),
        vectors(&sent.angular_acceleration, 1.0)
    );
    let degrees = 1_f64.to_degrees();
    assert_eq!(
        vectors(&found.joint_angles, degrees),
        vectors(&sent.joint_angles, degrees)
    );
    assert_eq!(found.ergonomic_angles.len(), 6);
    let ergonomic = &found.ergonomic_angles[..sent.ergonomic_angles.len()];
    assert_eq!(vectors(ergonomic, degrees), vectors(&sent.ergonomic_angles, degrees));
    let center = |frame: &Frame| vectors(&[frame.center_of_mass.map(|center| center.position)], 1.0);
    assert_eq!(center(found), center(sent));

    let (skeleton, sent_skeleton) = (&found.subject.skeleton, &sent.subject.skeleton);
    let free = by_segment(skeleton, &found.sensor_free_acceleration);
    assert_eq!(
        vectors(&free, 1.0),
        vectors(&by_segment(sent_skeleton, &sent.sensor_free_acceleration), 1.0)
    );
    let field = by_segment(skeleton, &found.sensor_magnetic_field);
    assert_eq!(
        vectors(&field, 1.0),
        vectors(&by_segment(sent_skeleton, &sent.sensor_magnetic_field), 1.0)
    );
    let orientation = by_segment(skeleton, &found.sensor_orientation);
    assert_eq!(
        quaternions(&orientation),
        quaternions(&by_segment(sent_skeleton, &sent.sensor_orientation))
    );
}

/// A section of the sensors, in the order of the segments that wear them.
fn by_segment<T: Copy>(skeleton: &Skeleton, section: &[Option<T>]) -> Vec<Option<T>> {
    let mut values = vec![None; skeleton.segments.len()];
    for (segment, value) in skeleton.sensors.iter().zip(section) {
        values[*segment] = *value;
    }
    values
}

/// As they are on the wire, where `f32` bits are what can be the same.
fn vectors(section: &[Option<DVec3>], unit: f64) -> Vec<Option<[u32; 3]>> {
    section
        .iter()
        .map(|v| v.map(|v| (v * unit).to_array().map(bits)))
        .collect()
}

fn quaternions(section: &[Option<DQuat>]) -> Vec<Option<[u32; 4]>> {
    section.iter().map(|q| q.map(|q| q.to_array().map(bits))).collect()
}

fn bits(value: f64) -> u32 {
    (value as f32).to_bits()
}

#[test]
fn a_version_3_take_has_its_arms_in_place() {
    let Some(path) = reference("meri-020.mvnx") else { return };
    let gathered = over_udp(&path, &playback(), types("02,12,13"));
    gathered.assert_whole();
    assert_eq!(gathered.frames.len(), 4);
    for frame in &gathered.frames {
        for (place, segment) in frame.subject.skeleton.segments.iter().enumerate() {
            let Some(parent) = segment.parent else { continue };
            let origin = |place: usize| frame.subject.skeleton.segments[place].origin.unwrap();
            let predicted = frame.pose(parent).unwrap().transform(origin(place) - origin(parent));
            let miss = (predicted - frame.position[place].unwrap()).length();
            assert!(
                miss < 0.04,
                "{} misses by {miss} m in sample {}",
                segment.name,
                frame.sample
            );
        }
    }
}
