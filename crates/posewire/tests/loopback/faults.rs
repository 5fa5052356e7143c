//! What is done to a stream on purpose is what a receiver at the other end of a socket counts.

use crate::harness::{PATIENCE, Receiver, play, seconds, types};
use posewire::endpoint::Endpoint;
use posewire::faults::{FaultKind, FaultedStream};
use posewire::sink::{MxtpSink, MxtpSinkOptions, NatNetSink, NatNetSinkOptions};
use posewire::stop::Stop;
use posewire::{Session, Source};
use std::time::Instant;

/// The seed is one that spares the first and last sample of each session, which nobody could miss.
const PLAN: &str = "loss=1%,dup=1%,reorder=1%,truncate=0.5%,reset@1500ms,seed=5";

#[test]
fn a_receiver_counts_the_faults_that_were_made() {
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let options = MxtpSinkOptions {
        faults: Some(PLAN.parse().unwrap()),
        ..types("02,20,21,24,25")
    };
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), options).unwrap();
    let progress = play("synthetic:walk?rate=480", &seconds(3.0), sink);
    let made = progress.faults.unwrap();
    let gathered = receiver.stop();

    let statistics = gathered.statistics.unwrap();
    assert_eq!((statistics.kernel_dropped, statistics.datagrams), (0, made.sent));
    assert_eq!(statistics.malformed, made.of(FaultKind::Truncate));
    let streams: Vec<_> = statistics.streams().map(|(_, stream)| stream).collect();
    assert_eq!(streams.len(), 5);
    for stream in streams {
        let made = |kind| {
            let (character, of) = (Some(0), Some(stream.kind));
            made.in_stream(FaultedStream { character, kind: of }, kind)
        };
        let lost = made(FaultKind::Loss) + made(FaultKind::Truncate);
        let counters = &stream.counters;
        assert_eq!(
            (
                counters.received,
                counters.missing,
                counters.duplicate,
                counters.late,
                counters.reset
            ),
            (
                1440 - lost,
                lost,
                made(FaultKind::Duplicate),
                made(FaultKind::Reorder),
                1
            ),
            "{}",
            stream.kind
        );
        assert_eq!((counters.rewound, counters.jumped), (0, 0));
    }
}

/// The seed is one that spares the first and last frame: to a client, what is before the first is nothing new.
#[test]
fn a_natnet_client_counts_the_faults_in_its_frames() {
    let Endpoint::NatNet(address) = "natnet://127.0.0.1:0?data-port=0".parse().unwrap() else {
        panic!()
    };
    let options = NatNetSinkOptions {
        faults: Some("loss=3%,dup=3%,reorder=3%,seed=3".parse().unwrap()),
        ..NatNetSinkOptions::default()
    };
    let sink = NatNetSink::open(&address, options).unwrap();
    let progress = sink.progress();
    let endpoint = progress.lock().unwrap().targets[0].endpoint.clone();
    let receiver = Receiver::start(&endpoint.replace("data-port=0", ""));
    let begun = Instant::now();
    while !sink.is_ready() {
        assert!(begun.elapsed() < PATIENCE);
        std::thread::yield_now();
    }
    let source = Source::open(&"synthetic:walk?rate=240".parse().unwrap(), &seconds(2.0)).unwrap();
    let session = Session::start([source], vec![Box::new(sink)], Stop::new());
    session.wait().unwrap();
    let made = progress.lock().unwrap().faults.clone().unwrap();
    let frames = receiver.stop().server().frames.counters;
    let lost = made.of(FaultKind::Loss);
    assert!(lost > 0 && made.of(FaultKind::Duplicate) > 0 && made.of(FaultKind::Reorder) > 0);
    assert_eq!(
        (frames.received, frames.missing, frames.duplicate, frames.late),
        (
            480 - lost,
            lost,
            made.of(FaultKind::Duplicate),
            made.of(FaultKind::Reorder)
        )
    );
}
