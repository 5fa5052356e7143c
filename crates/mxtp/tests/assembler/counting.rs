//! What is counted of each stream.

use crate::stream::{Receiver, Sender};
use posewire_motion::Skeleton;
use posewire_mxtp::{Datagram, Event, Header, MessageType, Quirk, SampleCounts};

const POSE: MessageType = MessageType::QUATERNION;

#[test]
fn a_stride_is_shown_and_losses_are_counted_in_it() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, (0..400).step_by(4).filter(|sample| *sample != 200));
    for message_type in [POSE, MessageType::JOINT_ANGLES] {
        let counters = receiver.counters(message_type);
        assert_eq!((counters.stride, counters.missing, counters.received), (Some(4), 1, 99));
        assert_eq!(
            (counters.last_sample, counters.last_time_ms),
            (Some(396), Some(4 * 396))
        );
    }
    assert_eq!(receiver.frames().len(), 99);
}

#[test]
fn a_stride_that_changes_is_learnt_anew() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut sender, (0..100).chain((100..400).step_by(4)));
    let counters = receiver.counters(POSE);
    assert_eq!((counters.stride, counters.missing, counters.reset), (Some(4), 0, 0));
    assert_eq!(receiver.frames().len(), 175);
}

#[test]
fn the_counter_may_wrap_around() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, (u32::MAX - 20..=u32::MAX).chain(0..20));
    let counters = receiver.counters(POSE);
    assert_eq!((counters.missing, counters.late, counters.reset), (0, 0, 0));
    assert_eq!(receiver.frame_numbers()[20..23], [u32::MAX, 0, 1]);
    assert_eq!(receiver.frames().len(), 41);
}

#[test]
fn a_new_session_is_a_reset_and_closes_what_was_open() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 5000..5100);
    receiver.feed(sender.sample(5100).iter().take(1));
    receiver.feed_samples(&mut sender, 0..100);
    let counters = receiver.counters(POSE);
    assert_eq!((counters.reset, counters.missing, counters.late), (1, 0, 0));
    assert_eq!(receiver.frame_numbers()[99..103], [5099, 5100, 0, 1]);
    assert_eq!(receiver.frames().len(), 201);
}

#[test]
fn a_recording_that_is_wound_back_is_no_reset_and_loses_nothing_of_the_counts() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, (0..100).chain(50..150));
    for message_type in [POSE, MessageType::JOINT_ANGLES] {
        let counters = receiver.counters(message_type);
        assert_eq!(
            (counters.reset, counters.rewound, counters.jumped),
            (0, 1, 0),
            "{message_type}"
        );
        assert_eq!((counters.missing, counters.late, counters.duplicate), (0, 0, 0));
        assert_eq!((counters.datagrams, counters.received), (200, 200));
    }
    let expected: Vec<_> = (0..100).chain(50..150).collect();
    assert_eq!(receiver.frame_numbers(), expected);
}

#[test]
fn what_is_left_of_the_session_before_is_late_and_makes_no_session() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 5000..5100);
    let last = sender.sample(5100);
    receiver.feed(last.iter().take(1));
    receiver.feed_samples(&mut sender, 0..8);
    receiver.feed(last.iter().skip(1));
    receiver.feed_samples(&mut sender, 8..100);
    for (message_type, late) in [(POSE, 0), (MessageType::JOINT_ANGLES, 1)] {
        let counters = receiver.counters(message_type);
        assert_eq!((counters.reset, counters.rewound, counters.jumped), (1, 0, 0));
        assert_eq!((counters.missing, counters.late, counters.received), (0, late, 201));
    }
    assert_eq!(receiver.samples(), sample_counts(201, 0, 0));
}

#[test]
fn samples_that_lack_a_type_and_samples_that_are_gone_are_told_apart() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    for number in 0..100 {
        let sample = sender.sample(number);
        match number {
            30 => {}
            50 | 51 => receiver.feed(sample.iter().take(1)),
            60 => receiver.feed(sample.iter().skip(1)),
            _ => receiver.feed(sample.iter()),
        }
        receiver.wait(crate::stream::PERIOD);
    }
    receiver.finish();
    assert_eq!(receiver.samples(), sample_counts(99, 3, 1));
    assert_eq!(receiver.counters(POSE).missing, 2);
    assert_eq!(receiver.counters(MessageType::JOINT_ANGLES).missing, 3);
}

#[test]
fn samples_are_whole_when_none_is_partial_and_none_gone() {
    let whole = |partial, gone| sample_counts(10, partial, gone).are_whole();
    assert_eq!(
        [whole(0, 0), whole(1, 0), whole(0, 1), whole(2, 3)],
        [true, false, false, false]
    );
}

#[test]
fn a_sample_is_not_partial_when_what_it_lacked_comes_after_all() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..20);
    let held = sender.sample(20);
    receiver.feed(held.iter().take(1));
    receiver.feed_samples(&mut sender, 21..30);
    assert_eq!(receiver.samples().partial, 1);
    receiver.feed(held.iter().skip(1));
    receiver.feed_samples(&mut sender, 30..40);
    assert_eq!(receiver.samples(), sample_counts(40, 0, 0));
}

#[test]
fn a_type_that_is_streamed_no_more_is_soon_no_longer_missed() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..100);
    let mut fewer = Sender::new("02");
    receiver.feed_samples(&mut fewer, 100..200);
    assert_eq!(receiver.samples(), sample_counts(200, 16, 0));
}

fn sample_counts(done: u64, partial: u64, gone: u64) -> SampleCounts {
    SampleCounts { done, partial, gone }
}

#[test]
fn a_message_that_comes_again_is_a_duplicate() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    for number in 0..20 {
        let sample = sender.sample(number);
        receiver.feed(sample.iter().chain(sample.iter()));
    }
    let counters = receiver.counters(POSE);
    assert_eq!(
        (counters.datagrams, counters.received, counters.duplicate),
        (40, 20, 20)
    );
    assert_eq!(receiver.frames().len(), 20);
    let messages = receiver
        .events
        .iter()
        .filter(|event| matches!(event, Event::Message { .. }));
    assert_eq!(messages.count(), 40);
}

#[test]
fn descriptions_are_counted_but_never_missing() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,12,13"));
    for _ in 0..3 {
        receiver.feed(sender.description().iter());
        receiver.feed_samples(&mut sender, 0..1);
    }
    let meta = receiver.counters(MessageType::META);
    assert_eq!(
        (meta.datagrams, meta.received, meta.duplicate, meta.missing),
        (3, 3, 0, 0)
    );
    let scale = receiver.counters(MessageType::SCALE);
    assert_eq!((scale.datagrams, scale.received, scale.last_sample), (18, 3, None));
}

#[test]
fn types_that_are_not_understood_are_passed_on() {
    let mut receiver = Receiver::new();
    for number in [4, 10, 11, 77] {
        let mut bytes = Header::rev_j(MessageType::new(number).unwrap(), 9, 0).encode().to_vec();
        bytes.extend([1, 2, 3]);
        receiver.feed([&bytes[..]]);
        let expected = MessageType::new(number).unwrap();
        assert!(receiver.events.iter().any(|event| matches!(
            event,
            Event::Opaque { message_type, sample: 9, payload, .. } if *message_type == expected && payload == &[1, 2, 3]
        )));
        assert_eq!(receiver.counters(expected).received, 1);
    }
    receiver.finish();
    assert_eq!(receiver.frames().len(), 0);
}

#[test]
fn malformed_datagrams_are_counted_by_kind_and_by_stream() {
    let mut receiver = Receiver::new();
    let mut cut = Header::rev_j(POSE, 0, 0).encode().to_vec();
    cut.extend([0; 33]);
    receiver.feed([&b"MXTP"[..], &b"GARBAGE GARBAGE GARBAGE GARBAGE"[..], &cut[..]]);
    receiver.feed([&b"MXTP1x sixteen more bytes"[..]]);
    let scale = Header::rev_j(MessageType::SCALE, 0, 0).encode();
    receiver.feed([&scale[..], &[&scale[..], &[0, 0, 0, 9]].concat()]);
    let kinds: Vec<_> = receiver.assembler.malformed().collect();
    let names = [
        "count",
        "magic",
        "payload-size",
        "short-header",
        "truncated",
        "type-digits",
    ];
    assert_eq!(kinds, names.map(|name| (name, 1)));
    assert_eq!(receiver.counters(POSE).malformed, 1);
    assert_eq!(receiver.counters(MessageType::SCALE).malformed, 2);
    assert!(matches!(receiver.events[2], Event::Malformed { header: Some(_), .. }));
}

#[test]
fn quirks_are_counted_once_a_datagram() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    for number in 0..5 {
        let mut bytes = sender.sample(number).iter().next().unwrap().to_vec();
        for id in 0..23 {
            bytes[Header::SIZE + 32 * id + 3] = id as u8;
        }
        assert!(Datagram::decode(&bytes).is_ok());
        receiver.feed([&bytes[..]]);
    }
    let counters = receiver.counters(POSE);
    let quirks: Vec<_> = counters.quirks.iter().collect();
    assert_eq!(quirks, [(Quirk::SegmentIdsFromZero, 5)]);
    assert_eq!(receiver.frames()[4].position, sender.frame.position);
}

#[test]
fn quirks_that_show_when_a_message_is_read_are_counted_too() {
    for split in [None, Some(400)] {
        let (mut receiver, mut poses) = (Receiver::new(), Sender::new("02"));
        let mut with_a_prop =
            Sender::with("01", |options| options.split = split).skeleton(Skeleton::standard(1, false));
        for number in 0..10 {
            receiver.feed(poses.sample(number).iter());
            receiver.feed(with_a_prop.sample(number).iter());
        }
        let counters = receiver.counters(MessageType::EULER);
        let quirks: Vec<_> = counters.quirks.iter().collect();
        assert_eq!(quirks, [(Quirk::SegmentIds, 10)]);
        assert_eq!(receiver.counters(POSE).quirks.iter().count(), 0);
    }
}

#[test]
fn quirks_of_a_message_that_does_not_become_whole_are_counted() {
    let (mut receiver, mut poses) = (Receiver::new(), Sender::new("02"));
    let mut with_a_prop =
        Sender::with("01", |options| options.split = Some(400)).skeleton(Skeleton::standard(1, false));
    receiver.feed(poses.sample(0).iter());
    receiver.feed(with_a_prop.sample(0).iter().skip(1));
    receiver.finish();
    let counters = receiver.counters(MessageType::EULER);
    let quirks: Vec<_> = counters.quirks.iter().collect();
    assert_eq!((counters.incomplete, quirks), (1, vec![(Quirk::SegmentIds, 1)]));
}
