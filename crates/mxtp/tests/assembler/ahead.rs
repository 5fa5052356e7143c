//! Samples that are complete while an older one is waited for.

use crate::stream::{PERIOD, Receiver, Sender};
use posewire_motion::Frame;
use posewire_mxtp::{AssemblerOptions, Event};
use std::sync::Arc;
use std::time::Duration;

fn receiver() -> Receiver {
    Receiver::with(AssemblerOptions {
        ahead: true,
        ..AssemblerOptions::default()
    })
}

/// The frames in the order in which they came, and whether each was ahead.
fn given(receiver: &Receiver) -> Vec<(bool, &Arc<Frame>)> {
    let events = receiver.events.iter();
    let frames = events.filter_map(|event| match event {
        Event::Frame(frame) => Some((false, frame)),
        Event::Ahead(frame) => Some((true, frame)),
        _ => None,
    });
    frames.collect()
}

/// The numbers of those that were ahead, since the last call.
fn ahead(receiver: &mut Receiver) -> Vec<u32> {
    let found = given(receiver).into_iter().filter(|(is_ahead, _)| *is_ahead);
    let numbers = found.map(|(_, frame)| frame.sample).collect();
    receiver.events.retain(|event| !matches!(event, Event::Ahead(_)));
    numbers
}

#[test]
fn a_complete_sample_is_given_before_the_one_that_it_waits_for() {
    let (mut receiver, mut sender) = (receiver(), Sender::new("02,25"));
    sender.frame.timecode = Some(posewire_motion::Timecode::from_milliseconds(1));
    receiver.feed_samples(&mut sender, 0..3);
    receiver.feed(sender.sample(3).iter().take(1));
    assert_eq!(ahead(&mut receiver), []);
    for sample in 4..7 {
        receiver.feed_samples(&mut sender, [sample]);
        assert_eq!(ahead(&mut receiver), [sample]);
    }
    assert_eq!(receiver.frame_numbers(), [0, 1, 2]);
    receiver.feed_samples(&mut sender, [7, 8]);
    assert_eq!(ahead(&mut receiver), []);
    assert_eq!(receiver.frame_numbers(), (0..9).collect::<Vec<_>>());
}

#[test]
fn a_frame_that_was_given_ahead_comes_in_its_turn_without_a_copy() {
    let (mut receiver, mut sender) = (receiver(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    receiver.feed(sender.sample(3).iter().take(1));
    receiver.feed_samples(&mut sender, [4]);
    receiver.wait(Duration::from_millis(100));
    let given = given(&receiver);
    let [.., ahead, before, again] = given[..] else {
        panic!("{given:?}")
    };
    assert_eq!((ahead.0, before.1.sample, again.0), (true, 3, false));
    assert!(Arc::ptr_eq(ahead.1, again.1));
    assert_eq!(ahead.1.sample, 4);
}

#[test]
fn none_is_given_that_a_newer_one_was_given_before() {
    let (mut receiver, mut sender) = (receiver(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    let (three, four) = (sender.sample(3), sender.sample(4));
    receiver.feed(three.iter().take(1));
    receiver.feed(four.iter().take(1));
    receiver.feed_samples(&mut sender, [5]);
    assert_eq!(ahead(&mut receiver), [5]);
    receiver.feed(four.iter().skip(1));
    assert_eq!(ahead(&mut receiver), []);
    receiver.feed(three.iter().skip(1));
    assert_eq!(ahead(&mut receiver), []);
    assert_eq!(receiver.frame_numbers(), [0, 1, 2, 3, 4, 5]);
}

#[test]
fn one_that_still_gets_something_is_given_again_and_the_first_stays_as_it_was() {
    let (mut receiver, mut sender) = (receiver(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    receiver.feed(sender.sample(3).iter().take(1));
    let mut more = Sender::new("02,20,24");
    more.frame.center_of_mass = Some(posewire_motion::CenterOfMass {
        position: posewire_motion::DVec3::Z,
        velocity: None,
        acceleration: None,
    });
    receiver.feed(more.sample(4).iter());
    receiver.wait(Duration::from_millis(100));
    let given = given(&receiver);
    let centers = given.iter().map(|(_, frame)| frame.center_of_mass.is_some());
    assert_eq!(centers.skip(3).collect::<Vec<_>>(), [false, true, false, true]);
}

#[test]
fn where_nothing_is_lost_nothing_is_given_ahead() {
    let (mut receiver, mut sender) = (receiver(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..20);
    // Overtaken as a whole: nothing waits for it.
    receiver.feed_samples(&mut sender, [21, 20, 22]);
    receiver.feed_samples(&mut sender, 0..4);
    assert_eq!(ahead(&mut receiver), []);
}

#[test]
fn only_who_asks_is_given_samples_ahead() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
    receiver.feed_samples(&mut sender, 0..3);
    receiver.feed(sender.sample(3).iter().take(1));
    receiver.feed_samples(&mut sender, 4..9);
    receiver.wait(PERIOD);
    assert_eq!(ahead(&mut receiver), []);
}
