//! Messages that come in several datagrams.

use crate::stream::{PERIOD, Receiver, Sender, rev_j};
use posewire_motion::Skeleton;
use posewire_mxtp::{Header, MessageType, Quirk};
use std::time::Duration;

/// A sender with fingers whose pose takes several datagrams.
fn sender() -> Sender {
    Sender::with("02", |options| options.split = Some(800)).skeleton(Skeleton::standard(1, true))
}

#[test]
fn parts_make_a_whole_in_any_order() {
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0], [2, 0, 1]] {
        let (mut receiver, mut sender) = (Receiver::new(), sender());
        for number in 0..5 {
            let parts = sender.sample(number);
            let parts: Vec<_> = parts.iter().collect();
            assert_eq!(parts.len(), 3);
            receiver.feed(order.map(|part| parts[part]));
        }
        assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3, 4]);
        assert!(
            receiver
                .frames()
                .iter()
                .all(|frame| frame.position == sender.frame.position)
        );
        let counters = receiver.counters(MessageType::QUATERNION);
        assert_eq!((counters.datagrams, counters.received, counters.missing), (15, 5, 0));
        assert_eq!((counters.duplicate, counters.late, counters.incomplete), (0, 0, 0));
        assert_eq!(receiver.assembler.buffered(), 0);
    }
}

#[test]
fn parts_are_held_until_their_message_is_whole() {
    let (mut receiver, mut sender) = (Receiver::new(), sender());
    receiver.feed_samples(&mut sender, 0..2);
    let parts = sender.sample(2);
    let held = parts.iter().take(2).map(<[u8]>::len).sum::<usize>();
    receiver.feed(parts.iter().take(2));
    assert_eq!(receiver.assembler.buffered(), held);
    receiver.feed(parts.iter().skip(2));
    assert_eq!(receiver.assembler.buffered(), 0);
}

#[test]
fn parts_of_samples_may_mix() {
    let (mut receiver, mut sender) = (Receiver::new(), sender());
    receiver.feed_samples(&mut sender, 0..2);
    let (first, second) = (sender.sample(2), sender.sample(3));
    receiver.feed(first.iter().take(2));
    receiver.feed(second.iter());
    receiver.feed(first.iter().skip(2));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3]);
    assert_eq!(receiver.frames()[2].position, sender.frame.position);
}

#[test]
fn a_part_that_comes_again_is_a_duplicate() {
    let (mut receiver, mut sender) = (Receiver::new(), sender());
    receiver.feed_samples(&mut sender, 0..2);
    let parts = sender.sample(2);
    let parts: Vec<_> = parts.iter().collect();
    receiver.feed([parts[0], parts[0], parts[1], parts[2], parts[2]]);
    receiver.finish();
    assert_eq!(receiver.frame_numbers(), [0, 1, 2]);
    let counters = receiver.counters(MessageType::QUATERNION);
    assert_eq!((counters.duplicate, counters.received), (2, 3));
}

#[test]
fn a_lost_part_leaves_its_segments_unknown() {
    for lost in 0..3 {
        let (mut receiver, mut sender) = (Receiver::new(), sender());
        receiver.feed_samples(&mut sender, 0..2);
        let parts = sender.sample(2);
        receiver.feed(
            parts
                .iter()
                .enumerate()
                .filter(|(part, _)| *part != lost)
                .map(|(_, part)| part),
        );
        receiver.wait(Duration::from_secs(1));
        let frame = receiver.frames()[2];
        let known = frame
            .position
            .iter()
            .zip(&sender.frame.position)
            .filter(|(a, b)| a == b)
            .count();
        let unknown = frame.position.iter().filter(|position| position.is_none()).count();
        assert!(unknown > 0 && known > 0 && known + unknown == 64, "{known} {unknown}");
        let counters = receiver.counters(MessageType::QUATERNION);
        assert_eq!((counters.incomplete, counters.received, counters.missing), (1, 2, 0));

        receiver.feed(parts.iter().skip(lost).take(1));
        receiver.finish();
        assert_eq!(receiver.frames().len(), 3);
        let counters = receiver.counters(MessageType::QUATERNION);
        assert_eq!((counters.late, counters.duplicate), (1, 0));
    }
}

#[test]
fn an_old_header_leaves_the_segment_count_to_the_parts_together() {
    let change = |options: &mut _| {
        rev_j(options);
        options.split = Some(800);
    };
    let (mut receiver, mut sender) = (
        Receiver::new(),
        Sender::with("02", change).skeleton(Skeleton::standard(0, true)),
    );
    receiver.feed_samples(&mut sender, 0..3);
    assert!(
        receiver
            .frames()
            .iter()
            .all(|frame| frame.position == sender.frame.position)
    );
    assert_eq!(receiver.frames()[2].subject.skeleton.segments.len(), 63);
}

#[test]
fn parts_with_ids_from_zero_are_told_by_their_place_in_the_message() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::with("02", |options| options.split = Some(400)));
    for number in 0..3 {
        let sample = sender.sample(number);
        let parts = sample.iter().map(|part| {
            let mut part = part.to_vec();
            for record in part[Header::SIZE..].chunks_mut(32) {
                record[3] -= 1;
            }
            part
        });
        let parts: Vec<_> = parts.collect();
        assert_eq!(parts.len(), 3);
        receiver.feed(parts.iter().map(Vec::as_slice));
        receiver.wait(PERIOD);
    }
    for frame in receiver.frames() {
        assert_eq!(frame.position, sender.frame.position);
    }
    let quirks = receiver.counters(MessageType::QUATERNION).quirks;
    assert_eq!(quirks.iter().collect::<Vec<_>>(), [(Quirk::SegmentIdsFromZero, 3 * 3)]);
}

#[test]
fn many_types_may_be_split_at_once() {
    let (mut receiver, mut sender) = (
        Receiver::new(),
        Sender::with("01,02,05,20", |options| options.split = Some(300)),
    );
    receiver.feed_samples(&mut sender, 0..3);
    assert_eq!(receiver.frame_numbers(), [0, 1, 2]);
    for frame in receiver.frames() {
        assert_eq!(
            (&frame.position, frame.joint_angles.len()),
            (&sender.frame.position, 22)
        );
        assert_eq!(frame.ergonomic_angles, sender.frame.ergonomic_angles);
    }
}
