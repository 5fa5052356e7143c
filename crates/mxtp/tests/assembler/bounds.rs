//! What an assembler holds is bounded.

use crate::stream::{Receiver, Sender, character};
use posewire_motion::Stamp;
use posewire_mxtp::body::{Body, QuaternionSegment};
use posewire_mxtp::ids::SegmentId;
use posewire_mxtp::{Assembler, Datagram, DatagramCounter, Event, Header, MessageType};
use std::time::Duration;

#[test]
fn a_65th_character_is_refused_until_another_falls_silent() {
    let mut receiver = Receiver::new();
    let mut senders: Vec<_> = (0..65).map(|number| Sender::with("02", character(number))).collect();
    for sender in &mut senders {
        receiver.feed(sender.sample(0).iter());
    }
    assert_eq!(
        (receiver.assembler.subjects().count(), receiver.assembler.refused()),
        (64, 1)
    );
    receiver.now = receiver.now.after(Duration::from_secs(11));
    for sender in &mut senders[1..] {
        receiver.feed(sender.sample(1).iter());
    }
    let ids: Vec<_> = receiver.assembler.subjects().map(|subject| subject.id).collect();
    assert_eq!((ids.len(), ids.contains(&0), ids.contains(&64)), (64, false, true));
    receiver.feed(senders[0].sample(2).iter());
    assert_eq!(receiver.assembler.refused(), 2);
}

#[test]
fn a_character_that_gives_way_leaves_its_open_frames() {
    let mut receiver = Receiver::new();
    for number in 0..64 {
        receiver.feed(Sender::with("02", character(number)).sample(0).iter());
    }
    receiver.now = receiver.now.after(Duration::from_secs(11));
    receiver.feed(Sender::with("02", character(64)).sample(0).iter());
    assert_eq!(receiver.frames().len(), 1);
    assert_eq!((receiver.frames()[0].subject.id, receiver.assembler.refused()), (0, 0));
}

#[test]
fn a_character_gives_way_after_more_than_ten_seconds_of_silence() {
    let mut receiver = Receiver::new();
    for number in 0..64 {
        receiver.feed(Sender::with("02", character(number)).sample(0).iter());
    }
    let mut one_more = Sender::with("02", character(64));
    receiver.now = receiver.now.after(Duration::from_secs(10));
    receiver.feed(one_more.sample(0).iter());
    assert_eq!(receiver.assembler.refused(), 1);
    receiver.now = receiver.now.after(Duration::from_nanos(1));
    receiver.feed(one_more.sample(1).iter());
    assert_eq!((receiver.assembler.refused(), receiver.frames().len()), (1, 1));
}

#[test]
fn no_more_than_four_samples_are_open() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::with("02", |options| options.split = Some(400)));
    for number in 0..50 {
        receiver.feed(sender.sample(number).iter().take(1));
        let open = number as usize + 1 - receiver.frames().len();
        assert!(open <= 4, "{open}");
    }
    assert_eq!(receiver.counters(MessageType::QUATERNION).incomplete, 46);
    receiver.finish();
    assert_eq!(receiver.counters(MessageType::QUATERNION).incomplete, 50);
}

#[test]
fn parts_of_a_sample_are_bounded() {
    let mut receiver = Receiver::new();
    let segments = vec![QuaternionSegment::new(SegmentId(1), [0.0; 3], [1.0, 0.0, 0.0, 0.0]); 255];
    for sample in 0..8 {
        for index in 0..127 {
            let header = Header::rev_j(MessageType::QUATERNION, sample, 0);
            let header = header.with_counter(DatagramCounter::part(index, false));
            let mut bytes = Vec::new();
            Datagram::new(header, Body::Quaternion(&segments))
                .unwrap()
                .encode(&mut bytes);
            receiver.feed([&bytes[..]]);
            assert!(receiver.assembler.buffered() <= 4 * (256 << 10));
        }
    }
    receiver.finish();
    assert_eq!((receiver.assembler.buffered(), receiver.frames().len()), (0, 8));
}

#[test]
fn parts_that_just_fit_are_kept() {
    let mut receiver = Receiver::new();
    let segment = QuaternionSegment::new(SegmentId(1), [0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let mut part = |index, segments: usize| {
        let header = Header::rev_j(MessageType::QUATERNION, 0, 0).with_counter(DatagramCounter::part(index, false));
        let mut bytes = Vec::new();
        Datagram::new(header, Body::Quaternion(&vec![segment; segments]))
            .unwrap()
            .encode(&mut bytes);
        receiver.feed([&bytes[..]]);
        receiver.assembler.buffered()
    };
    for index in 0..35 {
        part(index, 227);
    }
    assert_eq!(part(35, 221), 35 * (24 + 227 * 32));
    assert_eq!(part(35, 220), 256 << 10);
    assert_eq!(part(36, 0), 256 << 10);
}

#[test]
fn events_that_nobody_takes_are_dropped_and_counted() {
    let (mut assembler, mut sender) = (Assembler::new(), Sender::new("02"));
    let sample = sender.sample(0);
    let bytes = sample.iter().next().unwrap();
    for number in 0..10_000_u32 {
        let mut bytes = bytes.to_vec();
        bytes[6..10].copy_from_slice(&number.to_be_bytes());
        assembler.handle(Stamp(i64::from(number) * 4_000_000), &bytes);
    }
    let left = std::iter::from_fn(|| assembler.poll()).count();
    assert_eq!(left, 1024);
    // A subject, and for each sample a message and, but for the last, a frame.
    assert!(assembler.events_dropped() >= 2 * 10_000 - 1024);
}

#[test]
fn frames_are_used_again_only_when_nobody_holds_them() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut sender, 0..50);
    let kept = receiver.frame_numbers();
    receiver.events.retain(|event| !matches!(event, Event::Frame(_)));
    receiver.feed_samples(&mut sender, 50..100);
    assert_eq!(kept, (0..50).collect::<Vec<_>>());
    assert_eq!(receiver.frame_numbers(), (50..100).collect::<Vec<_>>());
}
