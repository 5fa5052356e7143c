//! How long samples were on their way, by the clocks of both ends.

use crate::harness::Receiver;
use posewire::clock::Clock;
use posewire::endpoint::Endpoint;
use posewire::stats::{Clocks, Transit};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject, Timecode};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use std::net::UdpSocket;
use std::sync::Arc;
use std::time::Duration;

/// Sends samples 4 ms apart by the source's clock, with the time of day where `code` gives one, and gives what was measured.
fn measured(code: impl Fn(Timecode) -> Option<Timecode>) -> Transit {
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let Endpoint::MxtpUdp(address) = receiver.endpoint.clone() else {
        panic!("{}", receiver.endpoint)
    };
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
    frame.position = vec![Some(DVec3::ZERO); 23];
    frame.orientation = vec![Some(DQuat::IDENTITY); 23];
    let (mut datagrams, mut encoder) = (Datagrams::new(), Encoder::new(EncoderOptions::default()));
    for sample in 0..SAMPLES {
        frame.sample = sample;
        frame.time = Duration::from_millis(4) * sample;
        frame.timecode = code(Timecode::of_day(Clock::new().now()));
        datagrams.clear();
        encoder.encode_frame(&frame, &mut datagrams);
        for datagram in datagrams.iter() {
            sender.send_to(datagram, ("127.0.0.1", address.port)).unwrap();
        }
    }
    let gathered = receiver.finish(SAMPLES.into());
    let statistics = gathered.statistics.unwrap();
    statistics.subjects[0].transit.unwrap()
}

#[test]
fn within_a_machine_the_latency_is_known_by_the_time_code() {
    let transit = measured(Some);
    assert_eq!(transit.clocks, Clocks::Same);
    assert_eq!(transit.latency.unwrap().count, u64::from(SAMPLES));
    assert_eq!(transit.variation.unwrap().count, u64::from(SAMPLES) - 1);
}

#[test]
fn the_latency_of_a_recording_is_not_known_and_its_variation_is() {
    let hours_ago = |now: Timecode| {
        Some(Timecode::from_milliseconds(
            u64::from(now.milliseconds()) + 20 * 3_600_000,
        ))
    };
    let transit = measured(hours_ago);
    assert_eq!((transit.latency, transit.clocks), (None, Clocks::Differ));
    assert!(transit.variation.is_some());
    let transit = measured(|_| None);
    assert_eq!((transit.latency, transit.clocks), (None, Clocks::NoTimecode));
    assert!(transit.variation.is_some());
}

const SAMPLES: u32 = 50;
