//! When frames come, and in which order.

use crate::stream::{PERIOD, Receiver, Sender, character};
use posewire_mxtp::{Event, MessageType};
use std::time::Duration;

#[test]
fn a_frame_comes_with_the_last_message_of_its_sample() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, [0]);
    assert_eq!(receiver.frame_numbers(), []);
    receiver.feed_samples(&mut sender, [1]);
    assert_eq!(receiver.frame_numbers(), [0, 1]);
    let sample = sender.sample(2);
    receiver.feed(sample.iter().take(1));
    assert_eq!(receiver.frame_numbers(), [0, 1]);
    receiver.feed(sample.iter().skip(1));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2]);
    assert_eq!(receiver.assembler.timeout(), None);
}

#[test]
fn a_frame_says_what_its_messages_said() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,12,13,20"));
    let started = receiver.now;
    receiver.feed(sender.description().iter());
    receiver.feed_samples(&mut sender, [7]);
    receiver.finish();
    let (found, sent) = (receiver.frames()[0], &sender.frame);
    assert_eq!(
        (&found.position, &found.orientation),
        (&sent.position, &sent.orientation)
    );
    assert_eq!((&found.joint_angles, found.time), (&sent.joint_angles, PERIOD * 7));
    assert_eq!((found.subject.name.as_str(), found.received), ("Ada", Some(started)));
}

#[test]
fn a_lost_message_holds_newer_frames_back_until_the_timeout() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    let opened = receiver.now;
    receiver.feed(sender.sample(3).iter().take(1));
    receiver.feed_samples(&mut sender, [4]);
    assert_eq!(
        receiver.assembler.timeout(),
        Some(opened.after(Duration::from_millis(100)))
    );
    receiver.wait(Duration::from_millis(95));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2]);
    receiver.wait(Duration::from_millis(5));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3, 4]);
    assert!(receiver.frames()[3].joint_angles.is_empty());
    assert_eq!(receiver.counters(MessageType::JOINT_ANGLES).incomplete, 0);
}

#[test]
fn a_pause_in_the_middle_of_the_newest_sample_does_not_break_it() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    let sample = sender.sample(3);
    receiver.feed(sample.iter().take(1));
    receiver.wait(Duration::from_millis(999));
    receiver.feed(sample.iter().skip(1));
    assert!(!receiver.frames()[3].joint_angles.is_empty());

    receiver.feed(sender.sample(4).iter().take(1));
    receiver.wait(Duration::from_secs(1));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3, 4]);
}

#[test]
fn newer_frames_wait_for_an_older_one_up_to_four_samples() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    let sample = sender.sample(3);
    receiver.feed(sample.iter().take(1));
    receiver.feed_samples(&mut sender, 4..6);
    assert_eq!(receiver.frame_numbers(), [0, 1, 2]);
    receiver.feed(sample.iter().skip(1));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3, 4, 5]);

    receiver.feed(sender.sample(6).iter().take(1));
    receiver.feed_samples(&mut sender, 7..10);
    assert_eq!(receiver.frame_numbers().len(), 6);
    receiver.feed_samples(&mut sender, [10]);
    assert_eq!(receiver.frame_numbers()[6..], [6, 7, 8, 9, 10]);
}

#[test]
fn a_sample_that_comes_too_late_for_the_order_is_not_lost() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut sender, [0, 1, 2, 4, 3, 5]);
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 4, 3, 5]);
    let late = receiver
        .frames()
        .iter()
        .filter(|frame| frame.late)
        .map(|frame| frame.sample)
        .collect::<Vec<_>>();
    assert_eq!(late, [3]);
    let counters = receiver.counters(MessageType::QUATERNION);
    assert_eq!((counters.late, counters.missing, counters.received), (1, 0, 6));
}

#[test]
fn half_a_sample_that_comes_too_late_for_the_order_holds_nothing_back() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, [0, 1, 2, 4]);
    receiver.feed(sender.sample(3).iter().take(1));
    receiver.feed_samples(&mut sender, [5, 6]);
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 4, 5, 6]);
    receiver.wait(Duration::from_millis(100));
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 4, 5, 6, 3]);
}

#[test]
fn a_message_for_a_frame_that_is_done_is_late_and_makes_no_second_frame() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    let sample = sender.sample(3);
    receiver.feed(sample.iter().take(1));
    receiver.wait(Duration::from_secs(1));
    receiver.feed(sample.iter().skip(1));
    receiver.finish();
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3]);
    let counters = receiver.counters(MessageType::JOINT_ANGLES);
    assert_eq!((counters.late, counters.missing, counters.received), (1, 0, 4));
}

#[test]
fn a_type_that_appears_is_waited_for_from_the_next_sample_on() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut sender, 0..5);
    let mut sender = Sender::new("02,20");
    receiver.feed_samples(&mut sender, 5..8);
    let angles: Vec<_> = receiver.frames().iter().map(|frame| frame.joint_angles.len()).collect();
    assert_eq!(angles, [0, 0, 0, 0, 0, 0, 22, 22]);
}

#[test]
fn a_type_that_vanishes_is_soon_not_waited_for() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..5);
    let mut sender = Sender::new("02");
    receiver.feed_samples(&mut sender, 5..20);
    assert_eq!(receiver.frame_numbers(), (0..20).collect::<Vec<_>>());
}

#[test]
fn characters_do_not_wait_for_each_other() {
    let mut receiver = Receiver::new();
    let (mut one, mut other) = (Sender::new("02,20"), Sender::with("02", character(1)));
    receiver.feed_samples(&mut one, 0..3);
    receiver.feed(one.sample(3).iter().take(1));
    receiver.feed_samples(&mut other, 0..3);
    let of_other = |event: &&Event| matches!(event, Event::Frame(frame) if frame.subject.id == 1);
    assert_eq!(receiver.events.iter().filter(of_other).count(), 3);
}

#[test]
fn a_character_that_comes_back_goes_on() {
    let mut receiver = Receiver::new();
    let (mut one, mut other) = (Sender::new("02"), Sender::with("02", character(1)));
    for sample in 0..1000 {
        receiver.feed(one.sample(sample).iter());
        if !(300..600).contains(&sample) {
            receiver.feed(other.sample(sample).iter());
        }
        receiver.wait(PERIOD);
    }
    let counters: Vec<_> = receiver.assembler.counters().map(|(_, _, counters)| counters).collect();
    assert_eq!((counters[0].received, counters[0].missing), (1000, 0));
    assert_eq!((counters[1].received, counters[1].missing), (700, 300));
    assert_eq!(receiver.frames().len(), 1700);
}
