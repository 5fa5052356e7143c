//! What the doctor says of streams that are as they should be, and of those that are not.
//!
//! All is sent before the listening begins, and listening ends at once: it reads what has arrived by then.

use crate::harness::{PATIENCE, types};
use posewire::doctor::{Check, Finding, Listened, Listener, Severity};
use posewire::endpoint::{Endpoint, Host, NatNetAddress};
use posewire::sink::{NatNetSink, NatNetSinkOptions};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

fn open(endpoint: &str) -> Listener {
    Listener::open(&endpoint.parse().unwrap(), &PlaybackOptions::default()).unwrap()
}

/// A listener on a port of its own, and where that is.
fn listener() -> (Listener, SocketAddr) {
    let listener = open("mxtp://127.0.0.1:0");
    let Endpoint::MxtpUdp(address) = listener.endpoint() else {
        panic!("{}", listener.endpoint());
    };
    let port = address.port;
    (listener, ([127, 0, 0, 1], port).into())
}

/// What it finds in what has arrived.
fn found(listener: Listener) -> Listened {
    let stop = Stop::new();
    stop.stop();
    listener.listen(PATIENCE, &stop).unwrap()
}

fn sender() -> UdpSocket {
    UdpSocket::bind("127.0.0.1:0").unwrap()
}

/// What is found in poses of one character after a change to each.
fn found_in(change: fn(&mut Frame)) -> Listened {
    let (listener, place) = listener();
    let sender = sender();
    for sample in 0..50 {
        send_pose(&sender, place, sample, change);
    }
    found(listener)
}

fn send_pose(sender: &UdpSocket, place: SocketAddr, sample: u32, change: fn(&mut Frame)) {
    for datagram in pose(sample, change).iter() {
        sender.send_to(datagram, place).unwrap();
    }
}

fn pose(sample: u32, change: fn(&mut Frame)) -> Datagrams {
    let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
    frame.position = frame.subject.skeleton.segments.iter().map(|one| one.origin).collect();
    frame.orientation = vec![Some(DQuat::IDENTITY); frame.position.len()];
    (frame.sample, frame.time) = (sample, Duration::from_millis(u64::from(sample) * 5));
    change(&mut frame);
    let mut datagrams = Datagrams::new();
    let types = types("02").types;
    let mut encoder = Encoder::new(EncoderOptions {
        types,
        ..EncoderOptions::default()
    });
    encoder.encode_frame(&frame, &mut datagrams);
    datagrams
}

fn for_positions(frame: &mut Frame, change: fn(DVec3) -> DVec3) {
    for position in frame.position.iter_mut().flatten() {
        *position = change(*position);
    }
}

fn for_orientations(frame: &mut Frame, change: fn(DQuat) -> DQuat) {
    for orientation in frame.orientation.iter_mut().flatten() {
        *orientation = change(*orientation);
    }
}

#[track_caller]
fn assert_broken(listened: &Listened, checks: &[Check]) {
    let broken = listened.findings.iter();
    let broken = broken.filter(|finding| finding.severity() == Severity::Broken);
    let broken: Vec<_> = broken.map(|finding| finding.check).collect();
    assert_eq!(broken, checks, "{:#?}", listened.findings);
}

#[track_caller]
fn finding(listened: &Listened, check: Check) -> &Finding {
    let found = listened.findings.iter().find(|finding| finding.check == check);
    found.unwrap_or_else(|| panic!("{check} is not in {:#?}", listened.findings))
}

#[test]
fn a_stream_that_is_as_it_should_be_has_nothing_broken() {
    let listened = found_in(|_| {});
    assert_broken(&listened, &[]);
    assert_eq!(listened.datagrams, 50);
    assert!(
        finding(&listened, Check::Stream)
            .what
            .starts_with("23 segments; type 02")
    );
}

#[test]
fn nothing_is_told_with_what_can_be_excluded() {
    let listened = found(listener().0);
    assert_broken(&listened, &[Check::NothingArrives]);
    assert!(
        listened.findings[0]
            .what
            .contains("Excluded: that another program has the port.")
    );
}

#[test]
fn a_taken_port_is_told_with_who_has_it() {
    let holder = sender();
    let endpoint = format!("mxtp://{}", holder.local_addr().unwrap());
    let listened = found(open(&endpoint));
    assert_broken(&listened, &[Check::PortTaken]);
}

#[test]
fn natnet_on_the_port_of_mxtp_is_found() {
    let (listener, place) = listener();
    sender().send_to(b"\x07\0\x04\0\0\0\0\0", place).unwrap();
    let listened = found(listener);
    assert_broken(&listened, &[Check::WrongProtocol]);
    assert!(
        finding(&listened, Check::WrongProtocol)
            .remedy
            .contains("natnet://127.0.0.1")
    );
}

#[test]
fn a_sender_that_uses_tcp_is_found_while_udp_is_listened_to() {
    let (listener, place) = listener();
    // Somebody else may have this port of TCP; then the connection is theirs, or there is none.
    let Ok(_peer) = TcpStream::connect(place) else {
        println!("skipped: the same port of TCP is taken");
        return;
    };
    let listened = found(listener);
    assert_broken(&listened, &[Check::OtherTransport]);
}

#[test]
fn two_senders_of_one_character_are_found() {
    let (listener, place) = listener();
    let senders = [sender(), sender()];
    for sample in 0..20 {
        for (number, sender) in senders.iter().enumerate() {
            send_pose(sender, place, sample + 7 * number as u32, |_| {});
        }
    }
    let listened = found(listener);
    assert_broken(&listened, &[Check::TwoSenders]);
    let of_numbering = [Check::Loss, Check::Duplicates, Check::SenderRestarts];
    let mut checks = listened.findings.iter().map(|finding| finding.check);
    assert!(
        !checks.any(|check| of_numbering.contains(&check)),
        "{:#?}",
        listened.findings
    );
    for sender in &senders {
        let address = sender.local_addr().unwrap().to_string();
        assert!(finding(&listened, Check::TwoSenders).what.contains(&address));
    }
}

#[test]
fn centimetres_are_found() {
    let listened = found_in(|frame| for_positions(frame, |position| position * 100.0));
    assert_broken(&listened, &[Check::WrongUnit]);
    assert_eq!(
        finding(&listened, Check::WrongUnit).place.as_deref(),
        Some("character 0")
    );
}

#[test]
fn y_up_is_found() {
    let listened = found_in(|frame| {
        for_positions(frame, |position| DVec3::new(position.y, position.z, position.x));
    });
    assert_broken(&listened, &[Check::WrongUpAxis]);
}

#[test]
fn w_last_is_found() {
    let listened = found_in(|frame| for_orientations(frame, |q| DQuat::from_xyzw(q.y, q.z, q.w, q.x)));
    assert_broken(&listened, &[Check::QuaternionOrder]);
}

#[test]
fn quaternions_of_another_length_and_numbers_that_are_none_are_found() {
    let listened = found_in(|frame| for_orientations(frame, |q| q * 3.0));
    assert_broken(&listened, &[Check::QuaternionNorm]);
    let listened = found_in(|frame| frame.position[5] = Some(DVec3::NAN));
    assert_broken(&listened, &[Check::NotFinite]);
}

#[test]
fn a_clock_that_leaps_and_samples_that_are_missing_are_found() {
    let listened = found_in(|frame| {
        if frame.sample >= 30 {
            frame.time += Duration::from_secs(9);
        }
        frame.sample += 3 * u32::from(frame.sample > 10 && frame.sample < 40);
    });
    assert_broken(&listened, &[]);
    finding(&listened, Check::ClockJump);
    finding(&listened, Check::Loss);
}

/// The kernel tells of what it dropped with the first datagram that found room again.
#[cfg(target_os = "linux")]
#[test]
fn what_this_machine_drops_is_counted_as_lost_here() {
    let (listener, place) = listener();
    let (sender, stop) = (sender(), Stop::new());
    let pose = pose(0, |_| {});
    // More than the 16 MiB at most that the kernel grants, by its own count.
    for _ in 0..10_000 {
        sender.send_to(pose.as_bytes(), place).unwrap();
    }
    let ended = stop.clone();
    let sending = thread::spawn(move || {
        for sample in 1..300 {
            send_pose(&sender, place, sample, |_| {});
            ended.wait(Duration::from_millis(1));
        }
        ended.stop();
    });
    let listened = listener.listen(PATIENCE, &stop).unwrap();
    sending.join().unwrap();
    assert_broken(&listened, &[Check::KernelDrops]);
    assert!(listened.lost_here > 0);
}

#[test]
fn bones_that_are_taken_for_relative_are_found() {
    let listened = of_walkers("?skeleton=local");
    assert_broken(&listened, &[Check::RelativeBones]);
}

#[test]
fn a_natnet_server_that_streams_has_nothing_broken() {
    let listened = of_walkers("");
    assert_broken(&listened, &[]);
    let stream = finding(&listened, Check::Stream);
    assert!(stream.what.contains("NatNet 4."), "{}", stream.what);
}

#[test]
fn bones_in_the_other_up_axis_are_found_and_the_option_is_named() {
    let listened = of_walkers("?up=z");
    let wrong = finding(&listened, Check::WrongUpAxis);
    assert!(wrong.remedy.starts_with("Leave ?up=z out"), "{}", wrong.remedy);
}

/// What is found of walkers that a NatNet server sends, which are listened to with these options.
fn of_walkers(options: &str) -> Listened {
    let loopback = Host::Address([127, 0, 0, 1].into());
    let address = NatNetAddress {
        data_port: 0,
        ..NatNetAddress::new(loopback, 0)
    };
    let sink = NatNetSink::open(&address, NatNetSinkOptions::default()).unwrap();
    let progress = sink.progress();
    let served: Endpoint = progress.lock().unwrap().targets[0].endpoint.parse().unwrap();
    let Endpoint::NatNet(served) = served else {
        panic!("{served}");
    };
    let endpoint = format!("natnet://127.0.0.1:{}{options}", served.port);
    let listener = open(&endpoint);

    let (streaming, listening) = (Stop::new(), Stop::new());
    let walkers = Source::open(&"synthetic:walk".parse().unwrap(), &PlaybackOptions::default()).unwrap();
    let session = Session::start([walkers], vec![Box::new(sink)], streaming.clone());
    let enough = listening.clone();
    let watching = thread::spawn(move || {
        let sent = || {
            progress.lock().unwrap().targets[0]
                .clients
                .iter()
                .map(|client| client.frames)
                .sum::<u64>()
        };
        let begun = Instant::now();
        while sent() < 100 && begun.elapsed() < PATIENCE {
            enough.wait(Duration::from_millis(5));
        }
        enough.stop();
    });
    let listened = listener.listen(PATIENCE, &listening).unwrap();
    watching.join().unwrap();
    streaming.stop();
    session.wait().unwrap();
    listened
}
