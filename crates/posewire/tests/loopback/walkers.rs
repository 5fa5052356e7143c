//! The built-in walker, streamed and received.

use crate::harness::{Receiver, first_over_udp, over_udp, play_first, seconds, types};
use posewire::endpoint::Endpoint;
use posewire::sink::{MxtpSink, MxtpSinkOptions};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use posewire_motion::SegmentKind;
use posewire_mxtp::{MessageType, Revision};

#[test]
fn sixteen_people_arrive_whole() {
    let gathered = first_over_udp("synthetic:walk?people=16&rate=240", 16 * 480, types("02,20,12,13"));
    gathered.assert_whole();
    assert_eq!(gathered.frames.len(), 16 * 480);
    for character in 0..16 {
        let pose = gathered.statistics_of(character, MessageType::QUATERNION);
        assert_eq!((pose.counters.received, pose.counters.stride), (480, Some(1)));
    }
}

#[test]
fn props_and_fingers_arrive_in_their_places() {
    let gathered = over_udp(
        "synthetic:walk?rate=60&props=4&fingers=true",
        &seconds(0.5),
        types("02,12,13,21,22"),
    );
    gathered.assert_whole();
    let skeleton = &gathered.frames.last().unwrap().subject.skeleton;
    assert_eq!(skeleton.segments.len(), 67);
    assert_eq!(skeleton.count(SegmentKind::Prop), 4);
    assert_eq!(skeleton.finger_count(), 40);
    let frame = gathered.frames.last().unwrap();
    assert!(frame.position.iter().all(Option::is_some) && frame.angular_velocity.iter().all(Option::is_some));
    assert_eq!(
        gathered.statistics_of(0, MessageType::QUATERNION).counters.quirks.len(),
        0
    );
}

#[test]
fn split_datagrams_are_joined() {
    let whole = over_udp(
        "synthetic:walk?rate=60&fingers=true",
        &seconds(0.5),
        types("02,12,13,20,23"),
    );
    let options = MxtpSinkOptions {
        split: Some(400),
        ..types("02,12,13,20,23")
    };
    let split = over_udp("synthetic:walk?rate=60&fingers=true", &seconds(0.5), options);
    split.assert_whole();
    let pose = &split.statistics_of(0, MessageType::QUATERNION).counters;
    assert_eq!((pose.received, pose.datagrams), (30, 30 * 6));
    for (joined, sent) in split.frames.iter().zip(&whole.frames) {
        assert_eq!(joined.sample, sent.sample);
        assert_eq!(joined.position, sent.position);
        assert_eq!(joined.orientation, sent.orientation);
        assert_eq!(joined.sensor_acceleration, sent.sensor_acceleration);
    }
}

#[test]
fn revision_j_carries_the_same_poses() {
    let new = over_udp("synthetic:walk?rate=60&props=1", &seconds(0.5), types("02,12,13,24"));
    let options = MxtpSinkOptions {
        revision: Revision::J,
        ..types("02,12,13,24")
    };
    let old = over_udp("synthetic:walk?rate=60&props=1", &seconds(0.5), options);
    old.assert_whole();
    assert_eq!(old.frames.len(), new.frames.len());
    for (old, new) in old.frames.iter().zip(&new.frames) {
        assert_eq!(
            (old.sample, &old.position, &old.center_of_mass),
            (new.sample, &new.position, &new.center_of_mass)
        );
    }
}

#[test]
fn a_lower_stream_rate_is_a_stride_and_no_loss() {
    let playback = PlaybackOptions {
        rate_hz: Some(60.0),
        ..seconds(1.0)
    };
    let gathered = over_udp("synthetic:walk?rate=240", &playback, types("02"));
    gathered.assert_whole();
    assert!(
        gathered
            .frames
            .iter()
            .map(|frame| frame.sample)
            .eq((0..60).map(|sample| sample * 4))
    );
    let pose = gathered.statistics_of(0, MessageType::QUATERNION);
    assert_eq!(pose.counters.stride, Some(4));
    assert!((pose.rate_hz - 60.0).abs() < 15.0, "{}", pose.rate_hz);
}

#[test]
fn a_character_that_disconnects_comes_back() {
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let targets = [receiver.endpoint.clone()];
    let stream = |people: u64, character: u8| {
        let sink = MxtpSink::open(
            &targets,
            MxtpSinkOptions {
                character,
                ..types("02,12,13")
            },
        )
        .unwrap();
        play_first(&format!("synthetic:walk?people={people}&rate=600"), people * 300, sink);
        people * 300
    };
    // Each round begins at sample 0 again, as a new recording does.
    let sent = stream(2, 0) + stream(1, 1) + stream(2, 0);

    let gathered = receiver.finish(sent);
    let [first, second] = [0, 1].map(|character| &gathered.statistics_of(character, MessageType::QUATERNION).counters);
    assert_eq!((first.received, first.reset, first.missing), (600, 1, 0));
    assert_eq!((second.received, second.reset, second.missing), (900, 2, 0));
}

#[test]
fn a_playback_that_cannot_keep_up_ends_all_the_same() {
    let hopeless = PlaybackOptions {
        speed: 1e6,
        ..seconds(0.1)
    };
    let target: Endpoint = "mxtp+tcp://127.0.0.1:0?mode=listen".parse().unwrap();
    let sink = MxtpSink::open(&[target], types("02")).unwrap();
    let source = Source::open(&"synthetic:walk".parse().unwrap(), &hopeless).unwrap();
    let progress = sink.progress();
    Session::start([source], vec![Box::new(sink)], Stop::new())
        .wait()
        .unwrap();
    let sent = progress.lock().unwrap().frames;
    assert!(sent > 0 && sent < 24_000_000, "{sent}");
}
