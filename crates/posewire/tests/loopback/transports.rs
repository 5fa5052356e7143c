//! UDP to many, TCP both ways of connecting, and peers that come late, stall or go.

use crate::harness::{Gathered, Receiver, over_udp, play, play_first, seconds, types};
use posewire::endpoint::Endpoint;
use posewire::sink::MxtpSink;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use posewire_mxtp::MessageType;
use std::net::{TcpListener, TcpStream};

const WALK: &str = "synthetic:walk?people=2&rate=60";

fn assert_same_motion(gathered: &Gathered) {
    gathered.assert_whole();
    let expected = over_udp(WALK, &seconds(0.5), types("02,12,13,25"));
    let of = |gathered: &Gathered| {
        let mut frames: Vec<_> = gathered
            .frames
            .iter()
            .map(|frame| (frame.subject.id, frame.sample, frame.position.clone()))
            .collect();
        frames.sort_by_key(|frame| (frame.0, frame.1));
        frames
    };
    assert_eq!(of(gathered), of(&expected));
}

#[test]
fn we_connect_and_the_receiver_listens() {
    let receiver = Receiver::start("mxtp+tcp://127.0.0.1:0");
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), types("02,12,13,25")).unwrap();
    let progress = play(WALK, &seconds(0.5), sink);
    assert_same_motion(&receiver.finish(progress.frames));
}

#[test]
fn we_listen_and_the_receiver_connects() {
    let listen: Endpoint = "mxtp+tcp://127.0.0.1:0?mode=listen".parse().unwrap();
    let sink = MxtpSink::open(&[listen], types("02,12,13,25")).unwrap();
    let ours = sink.progress().lock().unwrap().targets[0].endpoint.clone();
    let receiver = Receiver::start(&ours.replace("listen", "connect"));
    let progress = play(WALK, &seconds(0.5), sink);
    assert_same_motion(&receiver.finish(progress.frames));
}

#[test]
fn many_targets_all_get_everything() {
    let receivers = ["mxtp://127.0.0.1:0", "mxtp://127.0.0.1:0", "mxtp+tcp://127.0.0.1:0"].map(Receiver::start);
    let targets: Vec<_> = receivers.iter().map(|receiver| receiver.endpoint.clone()).collect();
    let progress = play(
        WALK,
        &seconds(0.5),
        MxtpSink::open(&targets, types("02,12,13,25")).unwrap(),
    );
    for receiver in receivers {
        assert_same_motion(&receiver.finish(progress.frames));
    }
}

#[test]
fn a_peer_that_stalls_loses_whole_samples_and_delays_nobody() {
    let stalled = TcpListener::bind("127.0.0.1:0").unwrap();
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let stalling = format!("mxtp+tcp://{}", stalled.local_addr().unwrap());
    let targets = [stalling.parse().unwrap(), receiver.endpoint.clone()];
    let sink = MxtpSink::open(&targets, types("02,12,13,20,21,22,23")).unwrap();
    let (peer, _) = stalled.accept().unwrap();
    let progress = sink.progress();
    let source = Source::open(&"synthetic:walk?people=8&rate=240".parse().unwrap(), &seconds(2.0)).unwrap();
    Session::start([source], vec![Box::new(sink)], Stop::new())
        .wait()
        .unwrap();
    let progress = progress.lock().unwrap().clone();
    assert!(progress.targets[0].dropped > 0, "{progress:?}");
    assert_eq!((progress.targets[1].dropped, progress.targets[1].failed), (0, 0));
    receiver.finish(progress.frames).assert_whole();
    drop::<TcpStream>(peer);
}

#[test]
fn a_receiver_connects_again_when_the_streamer_comes_back() {
    let walk = "synthetic:walk?rate=600";
    let listen: Endpoint = "mxtp+tcp://127.0.0.1:0?mode=listen".parse().unwrap();
    let sink = MxtpSink::open(&[listen], types("02,12,13")).unwrap();
    let ours = sink.progress().lock().unwrap().targets[0].endpoint.clone();
    let receiver = Receiver::start(&ours.replace("listen", "connect"));
    play_first(walk, 300, sink);
    let again = MxtpSink::open(&[ours.parse().unwrap()], types("02,12,13")).unwrap();
    play_first(walk, 300, again);

    let gathered = receiver.finish(600);
    let pose = &gathered.statistics_of(0, MessageType::QUATERNION).counters;
    assert_eq!((pose.received, pose.missing, pose.reset), (600, 0, 1));
}

#[test]
fn a_streamer_connects_again_when_the_receiver_comes_back() {
    let receiver = Receiver::start("mxtp+tcp://127.0.0.1:0");
    let place = receiver.endpoint.clone();
    let sink = MxtpSink::open(std::slice::from_ref(&place), types("02,12,13")).unwrap();
    let (progress, stop) = (sink.progress(), Stop::new());
    let source = Source::open(&WALK.parse().unwrap(), &PlaybackOptions::default()).unwrap();
    let session = Session::start([source], vec![Box::new(sink)], stop.clone());
    receiver.finish(20);

    let receiver = Receiver::start(&place.to_string());
    let gathered = receiver.finish(20);
    stop.stop();
    session.wait().unwrap();
    assert!(gathered.frames[0].sample > 0);
    assert!(
        progress.lock().unwrap().targets[0].dropped > 0,
        "what came while nobody was there is counted"
    );
}

#[test]
fn a_broadcast_reaches_who_listens_on_its_address() {
    let receiver = Receiver::start("mxtp://127.255.255.255:0");
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), types("02,12,13,25")).unwrap();
    let progress = play(WALK, &seconds(0.5), sink);
    assert_same_motion(&receiver.finish(progress.frames));
}

#[test]
fn a_multicast_group_is_joined_on_the_named_interface() {
    let group = "mxtp://239.255.76.3:0?interface=lo";
    let Ok(source) = Source::open(&group.parse().unwrap(), &PlaybackOptions::default()) else {
        println!("skipped: no multicast on the loopback here");
        return;
    };
    drop(source);
    let receiver = Receiver::start(group);
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), types("02,12,13,25")).unwrap();
    let progress = play(WALK, &seconds(0.5), sink);
    assert_same_motion(&receiver.finish(progress.frames));
}

#[test]
fn a_peer_that_came_to_us_may_leave_without_loss() {
    let listen: Endpoint = "mxtp+tcp://127.0.0.1:0?mode=listen".parse().unwrap();
    let sink = MxtpSink::open(&[listen], types("02,12,13")).unwrap();
    let (progress, stop) = (sink.progress(), Stop::new());
    let ours = progress.lock().unwrap().targets[0].endpoint.clone();
    let source = Source::open(&WALK.parse().unwrap(), &PlaybackOptions::default()).unwrap();
    let session = Session::start([source], vec![Box::new(sink)], stop.clone());
    for _ in 0..2 {
        let gathered = Receiver::start(&ours.replace("listen", "connect")).finish(20);
        assert!(gathered.frames.len() >= 20);
    }
    stop.stop();
    session.wait().unwrap();
    assert_eq!(progress.lock().unwrap().lost(), 0);
}
