//! How true the gaps between datagrams are when a recording is replayed and recorded again.
//!
//! Eight people of the built-in walker are streamed over UDP and received with the kernel's times, which are written to a capture;
//! that is replayed and received in the same way. The gap before each datagram is compared with the one that it had at first.

use posewire::capture::PcapWriter;
use posewire::endpoint::{Endpoint, Host, UdpAddress};
use posewire::histogram::DurationHistogram;
use posewire::net::UdpReceiver;
use posewire::replay::{Replay, ReplayOptions};
use posewire::sink::{MxtpSink, MxtpSinkOptions};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Datagram, Session, Source, Wire};
use std::net::Ipv4Addr;
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Records, replays and records again.
pub(crate) fn run() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("take.pcapng");
    let (target, receiving) = receive();
    stream(&target);
    let first = receiving.join().expect("no panic");
    let mut writer = PcapWriter::create(&path, false).expect("a new file");
    for datagram in &first {
        writer.write(datagram).expect("room");
    }
    writer.finish().expect("room");

    let (target, receiving) = receive();
    let replay = Replay::open(&path, &[target], &ReplayOptions::default()).expect("a capture");
    let replayed = replay.run(&Stop::new()).expect("loopback");
    let second = receiving.join().expect("no panic");
    let same = first.len() == second.len() && first.iter().zip(&second).all(|(a, b)| a.bytes == b.bytes);
    println!("replay: {} datagrams in {STREAMED:?}, of {PEOPLE} people", first.len());
    println!("  same payloads in the same order   {same}");
    println!("  lateness                          {}", replayed.lateness);
    println!(
        "  gaps differ by                    {}",
        differences(&first, &second).summary()
    );
}

fn differences(first: &[Datagram], second: &[Datagram]) -> DurationHistogram {
    let mut differences = DurationHistogram::new();
    for (a, b) in first.windows(2).zip(second.windows(2)) {
        if let ([a0, a1], [b0, b1]) = (a, b) {
            let gaps = [a1.received - a0.received, b1.received - b0.received];
            differences.record(Duration::from_nanos(gaps[0].abs_diff(gaps[1])));
        }
    }
    differences
}

/// Receives until nothing has come for a second.
fn receive() -> (Endpoint, JoinHandle<Vec<Datagram>>) {
    let address = |port| UdpAddress::new(Host::Address(Ipv4Addr::LOCALHOST.into()), port);
    let mut receiver = UdpReceiver::bind(&address(0)).expect("loopback");
    let to = receiver.local_address();
    let receiving = thread::spawn(move || {
        let mut datagrams = Vec::new();
        let mut take = |received: posewire::net::Received<'_>| {
            datagrams.push(Datagram {
                wire: Wire::MxtpUdp,
                from: received.from,
                to,
                received: received.stamp,
                bytes: received.bytes.into(),
            });
        };
        let mut patience = Duration::from_secs(10);
        while receiver.receive(patience, &mut take).expect("loopback") > 0 {
            patience = Duration::from_secs(1);
        }
        datagrams
    });
    (Endpoint::MxtpUdp(address(to.port())), receiving)
}

fn stream(target: &Endpoint) {
    let playback = PlaybackOptions {
        duration: Some(STREAMED),
        ..PlaybackOptions::default()
    };
    let walk = format!("synthetic:walk?people={PEOPLE}").parse().expect("a walker");
    let source = Source::open(&walk, &playback).expect("a walker");
    let sink = MxtpSink::open(std::slice::from_ref(target), MxtpSinkOptions::default()).expect("loopback");
    let session = Session::start([source], vec![Box::new(sink)], Stop::new());
    session.wait().expect("loopback");
}

const PEOPLE: u32 = 8;
const STREAMED: Duration = Duration::from_secs(10);
