//! Servers that vanish, send elsewhere or send nonsense.

use super::motive::{Motive, Sockets, bodies, frame, of_version};
use crate::harness::{Gathered, Receiver, open};
use posewire::Notice;
use posewire::endpoint::{Endpoint, NatNetAddress};
use posewire::stop::Stop;
use posewire_natnet::Version;
use posewire_natnet::frame::{Frame, MarkerSet};
use posewire_natnet::model::{Camera, Description};
use posewire_natnet::server::{Delivery, ServerOptions};
use std::net::UdpSocket;
use std::time::Duration;

fn has_remark(notices: &[Notice], part: &str) -> bool {
    let mut remarks = notices.iter().map(ToString::to_string);
    remarks.any(|remark| remark.contains(part))
}

#[test]
fn a_server_that_vanishes_is_told_of_and_heard_again_when_it_is_back() {
    let motive = Motive::unicast(Version::new(3, 1), bodies(&["Wand"]));
    let at = motive.command();
    let receiver = motive.connect("");
    motive.send_to(&receiver, &frame(1), 1);
    drop(motive);
    let is_lost = |notice: &Notice| matches!(notice, Notice::Disconnected { .. });
    receiver
        .gatherer
        .wait_until(|gathered| gathered.notices.iter().any(is_lost));

    let motive = Sockets::bind_at(at).serve(of_version(Version::new(4, 1)), bodies(&["Wand"]));
    let is_there = |notice: &&Notice| matches!(notice, Notice::Connected { .. });
    motive.send_until(&receiver, 2, |gathered| {
        gathered.notices.iter().filter(is_there).count() == 2 && gathered.frames.len() > 1
    });
    let gathered = receiver.stop();
    let told: Vec<_> = gathered.notices.iter().map(ToString::to_string).collect();
    let expected = [
        format!("connected to Motive 3.1, NatNet 3.1, at {at}"),
        format!("lost the connection to Motive 3.1, NatNet 3.1, at {at}: nothing comes from it any more"),
        format!("connected to Motive 3.1, NatNet 4.1, at {at}"),
    ];
    assert_eq!(told, expected);
    assert_eq!(gathered.frames.last().unwrap().subject.name, "Wand");
    assert_eq!(gathered.subjects.len(), 1, "the same subject goes on");
}

#[test]
fn the_clock_of_a_server_that_is_gone_is_told_as_it_was_last_known() {
    let motive = Motive::unicast(Version::new(4, 1), bodies(&["Wand"]));
    let receiver = motive.connect("");
    let server = |gathered: &Gathered| gathered.statistics.as_ref().and_then(|all| all.server.clone());
    let has_clock = |gathered: &Gathered| server(gathered).is_some_and(|server| server.clock.is_some());
    motive.send_until(&receiver, 1, has_clock);
    drop(motive);
    receiver
        .gatherer
        .wait_until(|gathered| server(gathered).is_some_and(|server| !server.connected));
    assert!(has_clock(&receiver.stop()));
}

#[test]
fn frames_that_go_to_the_data_port_of_the_client_are_found_there() {
    let free = UdpSocket::bind("0.0.0.0:0").unwrap();
    let data_port = free.local_addr().unwrap().port();
    let mut sockets = Sockets::bind();
    sockets.redirected = Some(([127, 0, 0, 1], data_port).into());
    drop(free);
    let options = ServerOptions {
        data_port,
        ..of_version(Version::new(4, 1))
    };
    let motive = sockets.serve(options, bodies(&["Wand"]));
    let receiver = motive.connect("");
    motive.send_until(&receiver, 1, |gathered| gathered.frames.len() >= 3);
    let gathered = receiver.stop();
    assert_eq!(gathered.server().frames.counters.duplicate, 0);
}

#[test]
fn a_server_that_multicasts_is_answered_with_the_endpoint_to_use() {
    let options = ServerOptions {
        delivery: Delivery::Multicast([239, 255, 42, 98].into()),
        ..of_version(Version::new(4, 1))
    };
    let sockets = Sockets::bind();
    let at = sockets.command();
    let motive = sockets.serve(options, bodies(&["Wand"]));
    let receiver = motive.connect("");
    let is_late = |gathered: &Gathered| {
        let statistics = gathered.statistics.as_ref();
        statistics.is_some_and(|all| all.elapsed > Duration::from_millis(3500))
    };
    receiver.gatherer.wait_until(is_late);
    let gathered = receiver.stop();
    let wanted = format!("use natnet://{at}?mode=multicast&group=239.255.42.98");
    assert!(has_remark(&gathered.notices, &wanted), "{:?}", gathered.notices);
    assert!(
        !has_remark(&gathered.notices, "is it streaming"),
        "{:?}",
        gathered.notices
    );
    let better = gathered.server().better.map(|better| better.to_string());
    assert!(better.is_some_and(|better| wanted.ends_with(&better)));
}

#[test]
fn a_version_that_is_not_granted_is_told_of_and_a_copy_is_refused() {
    let motive = Motive::unicast(Version::new(3, 1), bodies(&["Wand"]));
    let receiver = motive.connect("?version=4.1");
    let wanted = "NatNet 4.1 was asked for, but the server sends 3.1";
    receiver
        .gatherer
        .wait_until(|gathered| has_remark(&gathered.notices, wanted));
    receiver.stop();
    let error = open(&format!("natnet://{}?copy=true", motive.command())).unwrap_err();
    assert!(error.to_string().contains("copy of a source"), "{error}");
}

#[test]
fn a_group_whose_server_answers_nobody_is_read_as_the_version_that_is_named() {
    let (sockets, silent) = (Sockets::bind(), UdpSocket::bind("127.0.0.1:0").unwrap());
    let at = silent.local_addr().unwrap();
    let url = format!("natnet://{at}?mode=multicast&data-port=0&version=2.7");
    let source = open(&url).unwrap();
    let Endpoint::NatNet(NatNetAddress { data_port, group, .. }) = *source.endpoint() else {
        panic!("{}", source.endpoint())
    };
    let options = ServerOptions {
        delivery: Delivery::Multicast(group),
        data_port,
        ..of_version(Version::new(2, 7))
    };
    let motive = sockets.serve(options, bodies(&["Wand"]));
    let receiver = Receiver::run(source, Stop::new());
    motive.send_until(&receiver, 1, |gathered| gathered.frames.len() > 10);
    let gathered = receiver.stop();
    let first = &gathered.frames[0];
    assert_eq!((first.subject.name.as_str(), first.sample), ("Body 1", 1));
    let server = gathered.server();
    assert_eq!(
        (server.name.as_str(), server.address, server.connected),
        ("", at, false)
    );
    assert_eq!(server.version, Version::new(2, 7));
}

#[test]
fn a_server_that_answers_and_sends_no_frames_is_told_of_once_for_each_silence() {
    let motive = Motive::unicast(Version::new(4, 1), bodies(&["Wand"]));
    let receiver = motive.connect("");
    let told = |count: usize| {
        let is_remark = |notice: &&Notice| matches!(notice, Notice::Remark { .. });
        receiver
            .gatherer
            .wait_until(|gathered| gathered.notices.iter().filter(is_remark).count() == count);
    };
    told(1);
    motive.send_to(&receiver, &frame(1), 1);
    told(2);
    let notices = receiver.stop().notices;
    let expected = [
        "the server answers, but no frames come: is it streaming?",
        "the server answers, but no more frames come: is it paused?",
    ];
    assert_eq!([1, 2].map(|place| notices[place].to_string()), expected);
}

#[test]
fn a_server_that_never_answers_is_told_of() {
    let silent = UdpSocket::bind("127.0.0.1:0").unwrap();
    let at = silent.local_addr().unwrap();
    let receiver = Receiver::start(&format!("natnet://{at}"));
    receiver.gatherer.wait_until(|gathered| !gathered.notices.is_empty());
    let notices = receiver.stop().notices;
    assert!(has_remark(&notices, &format!("no answer from {at} yet")), "{notices:?}");
}

#[test]
fn what_a_server_describes_that_is_no_motion_is_told_of_once() {
    let filmed = |name: &str| {
        let mut model = bodies(&[name]);
        model.descriptions.push(Description::Camera(Camera::default()));
        model
    };
    let motive = Motive::unicast(Version::new(4, 1), filmed("Wand"));
    let receiver = motive.connect("");
    motive.send_to(&receiver, &frame(1), 1);
    motive.describe(filmed("Stick"));
    motive.send_until(&receiver, 2, |gathered| gathered.subjects.len() == 2);
    let notices = receiver.stop().notices;
    let told = notices.iter().filter(|notice| notice.to_string().contains("no motion"));
    let told: Vec<_> = told.map(ToString::to_string).collect();
    assert_eq!(told, ["left out, as they are no motion: 1 camera"]);
}

#[test]
fn frames_of_marker_sets_alone_are_told_of() {
    let motive = Motive::unicast(Version::new(2, 0), bodies(&["Wand"]));
    let receiver = motive.connect("");
    let set = MarkerSet {
        name: "Ada".into(),
        markers: vec![[0.0, 1.5, 0.0]],
    };
    let of_sets = Frame {
        marker_sets: vec![set],
        ..Frame::default()
    };
    motive.send(&of_sets).unwrap();
    let is_remark = |notice: &Notice| notice.to_string().contains("only marker sets");
    receiver
        .gatherer
        .wait_until(|gathered| gathered.notices.iter().any(is_remark));
    assert!(receiver.stop().frames.is_empty());
}

#[test]
fn nonsense_is_counted_and_the_stream_goes_on() {
    let motive = Motive::unicast(Version::new(4, 1), bodies(&["Wand"]));
    let receiver = motive.connect("");
    let mut bytes = Vec::new();
    let mut random = 1u32;
    for length in 0..400 {
        let id = length % 16;
        bytes.clear();
        bytes.extend([id as u8, 0, length as u8, (length >> 8) as u8]);
        bytes.extend((0..length).map(|_| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 24) as u8
        }));
        // Goodbyes and new introductions are understood.
        if ![1, 9, 11].contains(&id) {
            motive.send_raw(&bytes);
        }
    }
    motive.send_raw(&[]);
    motive.send_to(&receiver, &frame(7), 1);
    let gathered = receiver.finish(1);
    assert_eq!(gathered.frames.last().unwrap().sample, 7);
    assert!(gathered.server().frames.counters.malformed > 0);
    let statistics = gathered.statistics.unwrap();
    assert!(statistics.malformed > 20, "{}", statistics.malformed);
    assert!(statistics.last_malformed.is_some());
}
