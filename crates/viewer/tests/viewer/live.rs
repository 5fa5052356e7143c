//! What pages of live streams get.

use crate::harness::{Stage, ada, ask};
use posewire::stats::Statistics;
use posewire::{Item, Notice};
use posewire_motion::{DVec3, Frame, Skeleton, Stamp, Subject};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

#[test]
fn a_page_first_hears_who_is_there_and_then_sees_them_move() {
    let mut stage = Stage::new();
    stage.walk(&ada(), 1, 0.25);
    let mut page = stage.page();
    let scene = page.words("scene");
    assert_eq!(
        (&scene["mode"], &scene["subjects"][0]["name"]),
        (&"live".into(), &"Ada".into())
    );
    assert_eq!(scene["source"][0], "mxtp://127.0.0.1:9763");
    assert_eq!(scene["subjects"][0]["kind"], "person");
    let first = page.moved();
    assert_eq!(
        (first.records[0].sample, first.records[0].position[0]),
        (1, [0.25, 0.0, 1.0])
    );

    stage.walk(&ada(), 2, 0.5);
    let second = page.moved();
    assert_eq!(
        (second.records[0].sample, second.records[0].position[0]),
        (2, [0.5, 0.0, 1.0])
    );
    assert!(second.clock_s >= first.clock_s && second.number > first.number);
    let told = ask(stage.address(), "/api/scene").json();
    assert_eq!(told["subjects"], scene["subjects"]);
    assert_eq!(told["type"], serde_json::Value::Null);
}

/// A sample of a subject.
fn sample(subject: &Arc<Subject>, number: u32) -> Arc<Frame> {
    let mut frame = Frame::new(Arc::clone(subject));
    frame.sample = number;
    frame.position = vec![Some(DVec3::Z); subject.skeleton.segments.len()];
    Arc::new(frame)
}

#[test]
fn a_sample_ahead_of_its_turn_is_shown_and_those_that_it_is_ahead_of_are_not() {
    let (mut stage, subject) = (Stage::new(), ada());
    let mut page = stage.page();
    let ahead = sample(&subject, 3);
    stage.push(&Item::Ahead {
        frame: Arc::clone(&ahead),
        due: None,
    });
    assert_eq!(page.moved().records[0].sample, 3);
    for frame in [sample(&subject, 2), ahead, sample(&subject, 4)] {
        stage.push(&Item::Frame { frame, due: None });
    }
    let next = std::iter::from_fn(|| Some(page.moved().records[0].sample)).find(|sample| *sample != 3);
    assert_eq!(next, Some(4));
}

#[test]
fn a_sample_that_was_held_for_long_is_not_shown_as_new() {
    let (mut stage, subject) = (Stage::new(), ada());
    let now = Stamp::from(SystemTime::now());
    let mut frame = Frame::clone(&sample(&subject, 1));
    frame.received = Some(Stamp(now.nanoseconds() - 5_000_000_000));
    stage.show(frame);
    let shown = &stage.page().moved().records[0];
    assert!((4.9..15.0).contains(&shown.age_s), "{}", shown.age_s);
    assert_eq!(shown.state, 2);
}

#[test]
fn only_subjects_with_something_new_are_in_a_tick() {
    let mut stage = Stage::new();
    let bob = Arc::new(Subject {
        id: 9,
        ..Subject::new("Bob", Skeleton::standard(0, false))
    });
    stage.walk(&ada(), 1, 0.0);
    stage.walk(&bob, 1, 1.0);
    let mut page = stage.page();
    assert_eq!(page.moved().records.len(), 2);
    stage.walk(&bob, 2, 2.0);
    let records = page.moved().records;
    assert_eq!((records.len(), records[0].id, records[0].sample), (1, 1, 2));
}

#[test]
fn a_subject_that_changes_or_sends_more_is_described_again() {
    let mut stage = Stage::new();
    let subject = ada();
    stage.walk(&subject, 1, 0.0);
    let mut page = stage.page();
    let scene = page.words("scene");
    assert_eq!(scene["subjects"][0]["channels"][0]["section"], "position");
    assert_eq!(
        scene["subjects"][0]["channels"].as_array().unwrap().len(),
        3,
        "velocities are worked out"
    );

    let mut frame = Frame::new(Arc::clone(&subject));
    frame.joint_angles = vec![Some(DVec3::ZERO); 22];
    stage.show(frame);
    let channels = &page.words("scene")["subjects"][0]["channels"];
    assert_eq!(
        (&channels[3]["section"], &channels[3]["unit"]),
        (&"joint_angles".into(), &"deg".into())
    );

    let renamed = Subject {
        name: "Grace".to_owned(),
        ..Subject::clone(&subject)
    };
    stage.push(&Item::Subject(Arc::new(renamed)));
    assert_eq!(page.words("scene")["subjects"][0]["name"], "Grace");
}

#[test]
fn a_plot_gets_every_sample_in_degrees() {
    let mut stage = Stage::new();
    let subject = ada();
    let knee = |sample: u32| {
        let mut frame = Frame::new(Arc::clone(&subject));
        frame.sample = sample;
        frame.time = Duration::from_millis(u64::from(sample) * 4);
        frame.joint_angles = vec![Some(DVec3::Z * f64::from(sample).to_radians()); 22];
        frame
    };
    stage.show(knee(0));
    let mut page = stage.page();
    let wish = r#"{"id":5,"subject":0,"channel":"joint_angles/jRightKnee/z"}"#;
    let unknown = r#"{"id":6,"subject":0,"channel":"joint_angles/jTail/z"}"#;
    page.send(&format!(r#"{{"type":"plot","channels":[{wish},{unknown}]}}"#));
    let mut plotted = Vec::new();
    let mut sample = 0;
    // Samples that come before the wish is heard are not in it.
    while plotted.is_empty() || sample % 100 != 0 {
        sample += 1;
        stage.show(knee(sample));
        plotted.extend(page.series_until_sample(sample));
    }
    while plotted
        .last()
        .is_none_or(|(time, _): &(f64, f32)| *time < f64::from(sample) * 0.004)
    {
        let series = page.series();
        assert_eq!(series.id, 5);
        plotted.extend(series.samples());
    }
    let first = (plotted[0].0 / 0.004).round() as u32;
    assert_eq!(plotted.len() as u32, sample - first + 1);
    for (at, (time, angle)) in (first..).zip(plotted) {
        assert!(
            (time - f64::from(at) * 0.004).abs() < 1e-9 && (angle - at as f32).abs() < 1e-3,
            "{at}: {time} {angle}"
        );
    }
}

#[test]
fn a_sample_that_lost_its_pose_shows_the_one_before() {
    let mut stage = Stage::new();
    let subject = ada();
    stage.walk(&subject, 1, 0.25);
    let mut frame = Frame::new(subject);
    frame.sample = 2;
    frame.joint_angles = vec![Some(DVec3::ZERO); 22];
    stage.show(frame);
    let record = &stage.page().moved().records[0];
    assert_eq!(
        (record.sample, record.flags, record.position[0]),
        (2, 1, [0.25, 0.0, 1.0])
    );
}

#[test]
fn a_sample_that_newer_ones_have_overtaken_is_not_shown() {
    let mut stage = Stage::new();
    let subject = ada();
    stage.walk(&subject, 2, 0.5);
    let mut late = Frame::new(Arc::clone(&subject));
    (late.sample, late.late) = (1, true);
    late.position = vec![Some(DVec3::X); 23];
    stage.show(late);
    let record = &stage.page().moved().records[0];
    assert_eq!((record.sample, record.position[0]), (2, [0.5, 0.0, 1.0]));
    assert_eq!(stage.metric("posewire_viewer_frames_total"), 2);
}

#[test]
fn states_follow_the_stream_and_come_back() {
    let mut stage = Stage::new();
    stage.walk(&ada(), 1, 0.0);
    let mut page = stage.page();
    let mut states = Vec::new();
    while states.last() != Some(&2) {
        states.push(page.moved().records[0].state);
    }
    // A busy machine may be too slow to see it live.
    assert!(states == [0, 1, 2] || states == [1, 2] || states == [2], "{states:?}");
    for sample in 2.. {
        stage.walk(&ada(), sample, 0.0);
        let record = page.moved().records.remove(0);
        if (record.state, record.sample) == (0, sample) {
            break;
        }
    }
}

#[test]
fn how_the_streams_are_doing_is_told_as_monitor_tells_it() {
    let mut stage = Stage::new();
    let mut page = stage.page();
    assert_eq!(page.words("statistics")["sources"], serde_json::json!([]));
    let statistics = Statistics {
        datagrams: 7,
        malformed: 2,
        ..Statistics::default()
    };
    stage.push(&Item::Statistics(Arc::new(statistics)));
    let told = page.words("statistics");
    let source = &told["sources"][0];
    assert_eq!(
        (&source["source"], &source["server"]),
        (&0.into(), &serde_json::Value::Null)
    );
    assert_eq!(
        (&source["receiver"]["datagrams"], &source["receiver"]["malformed"]),
        (&7.into(), &2.into())
    );
    assert_eq!(told["page"]["connections"], 1);
    let label = "posewire_malformed_total{source=\"mxtp://127.0.0.1:9763\"}";
    assert_eq!(stage.metric(label), 2);
}

#[test]
fn notices_and_the_end_are_told() {
    let mut stage = Stage::new();
    let mut page = stage.page();
    let peer = "10.0.0.5:1510".to_owned();
    stage.push(&Item::Notice(Notice::Connected { peer }));
    assert_eq!(page.words("notice")["text"], "connected to 10.0.0.5:1510");
    drop(stage.server);
    assert_eq!(u16::from(page.closed()), 1001);
}
