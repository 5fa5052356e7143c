//! What pages get of takes.

use crate::decode::{self, Record};
use crate::harness::{Answer, Page, ask};
use posewire::endpoint::Walk;
use posewire::source::synthetic;
use posewire_motion::kinematics::completed;
use posewire_motion::{Section, Take, Timecode};
use posewire_viewer::{Content, Options, Server, Takes};
use std::sync::Arc;

/// The walker's first person, so many samples of it.
fn walk(samples: impl IntoIterator<Item = u32>) -> Take {
    let walk = synthetic::Walk::new(&(&Walk::default()).into());
    let mut take = Take::new(Arc::clone(&walk.subjects()[0]), walk.rate());
    for sample in samples {
        take.push(&walk.frame(0, sample)).unwrap();
    }
    take
}

fn serve(takes: Takes) -> Server {
    let options = Options {
        listen: ([127, 0, 0, 1], 0).into(),
        ..Options::default()
    };
    Server::start(Content::Takes(takes), &options).unwrap()
}

fn frames(server: &Server, take: u32, from: usize, count: usize) -> Answer {
    ask(
        server.address(),
        &format!("/api/takes/{take}/frames?from={from}&count={count}"),
    )
}

fn records(answer: &Answer) -> Vec<Record> {
    assert_eq!(answer.status, 200);
    decode::records(&answer.body).unwrap()
}

#[test]
fn frames_have_the_numbers_of_the_take() {
    let take = walk(0..700);
    let server = serve(Takes::new([("walk.mvnx".to_owned(), take.clone())]));
    let mut read = records(&frames(&server, 0, 0, 600));
    read.extend(records(&frames(&server, 0, 600, 600)));
    assert_eq!(read.len(), 700);
    let positions = take.column(Section::Position).unwrap();
    let orientations = take.column(Section::Orientation).unwrap();
    for (place, record) in read.iter().enumerate() {
        let single = |row: &[f64]| row.iter().map(|value| *value as f32).collect::<Vec<_>>();
        assert_eq!(record.position.as_flattened(), single(positions.row(place)));
        assert_eq!(record.orientation.as_flattened(), single(orientations.row(place)));
        assert_eq!((record.sample, record.id), (take.samples()[place], 0));
        assert_eq!((record.state, record.age_s.to_bits()), (0, 0));
        assert!((record.time_s - take.times()[place].as_secs_f64()).abs() < 1e-12);
    }
}

#[test]
fn a_series_is_a_channel_of_every_frame() {
    let take = walk(0..300);
    let server = serve(Takes::new([("walk.mvnx".to_owned(), take.clone())]));
    let read = |channel: &str| {
        let answer = ask(server.address(), &format!("/api/takes/0/series?channel={channel}"));
        decode::series(&answer.body).unwrap()
    };
    let head = read("position/Head/z");
    let angles = read("joint_angles/jRightKnee/z");
    assert_eq!((head.times_s.len(), angles.values.len()), (300, 300));
    for place in 0..300 {
        let frame = take.frame(place);
        assert!((head.times_s[place] - frame.time.as_secs_f64()).abs() < 1e-12);
        assert_eq!(
            head.values[place].to_bits(),
            (frame.position[6].unwrap().z as f32).to_bits()
        );
        let knee = frame
            .subject
            .skeleton
            .joints
            .iter()
            .position(|joint| joint.name == "jRightKnee");
        let degrees = frame.joint_angles[knee.unwrap()].unwrap().z.to_degrees() as f32;
        assert!((angles.values[place] - degrees).abs() < 1e-4);
    }
}

#[test]
fn what_the_take_lacks_is_worked_out_from_its_poses() {
    let mut take = walk(0..50);
    let sent = take.remove_column(Section::JointAngles).unwrap();
    take.remove_column(Section::Velocity);
    let whole = completed(&take).unwrap();
    let server = serve(Takes::new([("walk.mvnx".to_owned(), take)]));
    let scene = ask(server.address(), "/api/scene").json();
    let sections = scene["subjects"][0]["channels"].as_array().unwrap();
    for section in ["joint_angles", "velocity", "acceleration"] {
        assert!(sections.iter().any(|group| group["section"] == section), "{section}");
    }
    let read = |channel: &str| {
        let answer = ask(server.address(), &format!("/api/takes/0/series?channel={channel}"));
        decode::series(&answer.body).unwrap().values
    };
    let (angles, speeds) = (read("joint_angles/jRightKnee/z"), read("velocity/Pelvis/x"));
    let knee = whole
        .subject
        .skeleton
        .joints
        .iter()
        .position(|joint| joint.name == "jRightKnee")
        .unwrap();
    for place in 0..50 {
        let told = sent.row(place)[3 * knee + 2].to_degrees();
        assert!(
            (f64::from(angles[place]) - told).abs() < 0.1,
            "{} {told}",
            angles[place]
        );
        assert_eq!(
            speeds[place].to_bits(),
            (whole.frame(place).velocity[0].unwrap().x as f32).to_bits()
        );
    }
}

#[test]
fn takes_are_described_with_their_gaps() {
    let takes = [("a.mvnx", walk((0..100).chain(110..200))), ("b.mvnx", walk(50..60))];
    let server = serve(Takes::new(takes.map(|(file, take)| (file.to_owned(), take))));
    let mut page = Page::open(server.address());
    let scene = page.words("scene");
    assert_eq!(
        (&scene["mode"], &scene["source"][1]),
        (&"takes".into(), &"b.mvnx".into())
    );
    let take = &scene["takes"][0];
    assert_eq!(take["frames"], 190);
    assert_eq!(take["gaps"], serde_json::json!([[99, 10]]));
    assert_eq!((&take["rate_hz"], &take["first_sample"]), (&240.0.into(), &0.into()));
    assert!((take["duration_s"].as_f64().unwrap() - 200.0 / 240.0).abs() < 1e-9);
    assert_eq!(
        (&scene["takes"][1]["subject"], &scene["takes"][1]["first_sample"]),
        (&1.into(), &50.into())
    );
    assert_eq!(ask(server.address(), "/api/scene").json()["takes"], scene["takes"]);
}

/// The walker's take, whose first frame has this timecode, s of the day.
fn walk_at(samples: u32, second: u64) -> Take {
    let walk = walk(0..samples);
    let mut take = Take::new(Arc::clone(&walk.subject), walk.rate);
    for mut frame in walk.frames() {
        frame.timecode = Some(Timecode::from_milliseconds(
            second * 1000 + u64::from(frame.sample) * 1000 / 240,
        ));
        frame.received = None;
        take.push(&frame).unwrap();
    }
    take
}

#[test]
fn takes_that_have_no_moment_in_common_begin_together() {
    let takes = [
        ("noon.mvnx", walk_at(480, 43_200)),
        ("later.mvnx", walk_at(480, 43_201)),
        ("evening.mvnx", walk_at(10, 72_000)),
        ("evening.mvnx", walk_at(10, 72_003)),
    ];
    let server = serve(Takes::new(takes.map(|(file, take)| (file.to_owned(), take))));
    let scene = ask(server.address(), "/api/scene").json();
    let starts: Vec<_> = (0..4)
        .map(|take| scene["takes"][take]["start_s"].as_f64().unwrap())
        .collect();
    assert_eq!(starts, [0.0, 1.0, 0.0, 3.0], "those of one file keep their distance");
}

#[test]
fn frames_without_a_pose_are_told_and_show_the_last_one() {
    let whole = walk(0..10);
    let mut take = Take::new(Arc::clone(&whole.subject), whole.rate);
    for mut frame in whole.frames() {
        if matches!(frame.sample, 3 | 4) {
            frame.position.clear();
            frame.orientation.clear();
        }
        take.push(&frame).unwrap();
    }
    let server = serve(Takes::new([("walk.mcap".to_owned(), take)]));
    let scene = ask(server.address(), "/api/scene").json();
    assert_eq!(scene["takes"][0]["lost_poses"], serde_json::json!([[3, 2]]));
    assert_eq!(scene["takes"][0]["gaps"], serde_json::json!([]));
    let read = records(&frames(&server, 0, 0, 10));
    assert_eq!((read[4].sample, read[4].flags & 3), (4, 3));
    assert_eq!(read[4].position, read[2].position);
    assert_ne!(read[5].position, read[2].position);
}

#[test]
fn what_a_take_does_not_have_is_refused() {
    let server = serve(Takes::new([("walk.mvnx".to_owned(), walk(0..10))]));
    for (path, status) in [
        ("/api/takes/1/frames?from=0&count=1", 404),
        ("/api/takes/0/frames?from=10&count=1", 404),
        ("/api/takes/0/frames?from=0&count=601", 400),
        ("/api/takes/0/frames?from=-1&count=1", 400),
        ("/api/takes/0/frames?from=99999999999999999999&count=1", 400),
        ("/api/takes/0/frames", 400),
        ("/api/takes/x/frames?from=0&count=1", 400),
        ("/api/takes/0/series", 400),
        ("/api/takes/0/series?channel=position/Tail/z", 404),
        ("/api/takes/0/series?channel=", 404),
    ] {
        let answer = ask(server.address(), path);
        assert_eq!(answer.status, status, "{path}");
        assert!(answer.json()["error"].is_string(), "{path}");
    }
    assert_eq!(records(&frames(&server, 0, 9, 600)).len(), 1);
    assert_eq!(records(&frames(&server, 0, 0, 0)).len(), 0);
}
