//! A source that begins again loses nothing, and neither does one that a stray datagram comes between.

use crate::stream::{PERIOD, Receiver, Sender};
use posewire_motion::Skeleton;
use posewire_mxtp::{Event, MessageType};
use proptest::prelude::*;
use std::time::Duration;

const POSE: MessageType = MessageType::QUATERNION;

/// What comes out of samples of one message each, a period apart.
fn received(samples: impl IntoIterator<Item = u32>) -> Receiver {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut sender, samples);
    receiver.finish();
    receiver
}

/// Each datagram is received or a duplicate.
fn assert_sum(receiver: &Receiver) {
    for (_, message_type, counters) in receiver.assembler.counters() {
        let known = counters.received + counters.duplicate;
        assert_eq!(known, counters.datagrams, "{message_type}: {counters:?}");
    }
}

#[test]
fn a_source_that_begins_again_five_times_gives_all_its_samples() {
    for (length, types) in [(60, "02"), (60, "02,20"), (40, "02"), (8, "02,20")] {
        let (mut receiver, mut sender) = (Receiver::new(), Sender::new(types));
        for _ in 0..5 {
            receiver.feed_samples(&mut sender, 0..length);
        }
        // The last is as long as it takes to see that it is one.
        receiver.feed_samples(&mut sender, 0..60);
        receiver.finish();
        let expected: Vec<_> = (0..5).flat_map(|_| 0..length).chain(0..60).collect();
        assert_eq!(receiver.frame_numbers(), expected, "{length} {types}");
        let counters = receiver.counters(POSE);
        assert_eq!((counters.reset, counters.missing, counters.late), (5, 0, 0));
        assert_eq!((counters.received, counters.duplicate), (counters.datagrams, 0));
        assert_sum(&receiver);
    }
}

#[test]
fn fewer_than_eight_samples_that_come_again_are_copies() {
    for copied in 1..8 {
        let receiver = received((0..copied).chain(0..copied).chain(copied..60));
        assert_eq!(receiver.frame_numbers(), (0..60).collect::<Vec<_>>());
        let counters = receiver.counters(POSE);
        assert_eq!((counters.reset, counters.duplicate), (0, copied.into()));
        assert_sum(&receiver);
    }
}

#[test]
fn an_old_datagram_comes_between_and_nothing_of_the_stream_is_lost() {
    for (first, stray) in [(1000, 1090), (1300, 900), (1000, 90_000), (1000, 1390)] {
        let receiver = received((first..1400).chain([stray]).chain(1400..1600));
        assert_eq!(receiver.frame_numbers(), (first..1600).collect::<Vec<_>>(), "{stray}");
        let counters = receiver.counters(POSE);
        assert_eq!((counters.late + counters.duplicate, counters.missing), (1, 0));
        assert_eq!((counters.reset, counters.rewound, counters.jumped), (0, 0, 0));
        assert_eq!(u64::from(1600 - first), receiver.samples().done);
        assert_sum(&receiver);
    }
}

#[test]
fn samples_put_aside_have_the_times_at_which_they_came() {
    let receiver = received((500..900).chain(0..20));
    let times: Vec<_> = receiver.frames().iter().map(|frame| frame.received.unwrap()).collect();
    assert!(times.is_sorted_by(|one, next| next.since(*one) == PERIOD));
    assert!(receiver.frames().iter().all(|frame| !frame.late));
}

#[test]
fn a_session_with_other_segments_is_whole_from_its_first_sample_on() {
    let (mut receiver, mut one) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut one, 0..60);
    let mut other = Sender::new("02").skeleton(Skeleton::standard(2, true));
    receiver.feed_samples(&mut other, 0..60);
    receiver.finish();
    let counts: Vec<_> = receiver.frames().iter().map(|frame| frame.position.len()).collect();
    assert_eq!(counts, [vec![23; 60], vec![65; 60]].concat());
}

#[test]
fn messages_of_a_session_are_told_of_once_each() {
    for (first, second) in [(500..900, 0..20), (0..100, 0..20)] {
        let receiver = received(first.clone().chain(second.clone()));
        let messages = receiver.events.iter();
        let messages = messages.filter(|event| matches!(event, Event::Message { .. }));
        assert_eq!(messages.count(), first.len() + second.len());
    }
}

#[test]
fn split_messages_are_put_aside_too() {
    let (mut receiver, mut sender) = (
        Receiver::new(),
        Sender::with("02,20", |options| options.split = Some(400)),
    );
    receiver.feed_samples(&mut sender, 0..60);
    receiver.feed_samples(&mut sender, 0..5);
    assert!((1..=256 << 10).contains(&receiver.assembler.buffered()));
    receiver.feed_samples(&mut sender, 5..60);
    receiver.finish();
    assert_eq!(receiver.frame_numbers(), (0..60).chain(0..60).collect::<Vec<_>>());
    assert!(
        receiver
            .frames()
            .iter()
            .all(|frame| frame.position == sender.frame.position)
    );
    assert_eq!(receiver.counters(POSE).incomplete, 0);
    assert_eq!((receiver.samples().partial, receiver.assembler.buffered()), (0, 0));
}

#[test]
fn what_is_put_aside_is_bounded() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02").skeleton(Skeleton::standard(4, true)));
    receiver.feed_samples(&mut sender, 1000..1100);
    for _ in 0..10 {
        receiver.feed_samples(&mut sender, 1..8);
        assert!(receiver.assembler.buffered() <= 8 * 4096);
    }
    receiver.feed_samples(&mut sender, 1100..1106);
    assert_eq!(receiver.assembler.buffered(), 0);
    assert_sum(&receiver);
}

#[test]
fn after_a_pause_a_source_that_begins_again_is_not_waited_for() {
    let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02"));
    receiver.feed_samples(&mut sender, 0..60);
    receiver.wait(Duration::from_secs(1));
    receiver.feed_samples(&mut sender, 0..1);
    assert_eq!(receiver.frame_numbers(), (0..60).chain(0..1).collect::<Vec<_>>());
}

/// Two sessions of which the second does not begin right before the end of the first, where it looks like the same
/// samples again.
fn two_sessions() -> impl Strategy<Value = (u32, u32, u32, u32)> {
    let start = prop_oneof![Just(0), 0..600_u32, Just(u32::MAX - 20)];
    let lengths = (3..400_u32, 8..60_u32);
    (start.clone(), start, any::<bool>(), lengths).prop_filter_map(
        "cannot be told apart",
        |(first, second, same, (length, other_length))| {
            let second = if same { first } else { second };
            let before_the_end = (first.wrapping_add(length - 1)).wrapping_sub(second);
            let distinct =
                second == first && length >= 8 || (7..1 << 31).contains(&before_the_end) || before_the_end > 1 << 31;
            distinct.then_some((first, length, second, other_length))
        },
    )
}

fn run(first: u32, length: u32) -> impl Iterator<Item = u32> {
    (0..length).map(move |place| first.wrapping_add(place))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn one_stray_loses_no_sample(
        first in prop_oneof![Just(0_u32), 0..5000_u32],
        length in 2..400_u32,
        place in any::<prop::sample::Index>(),
        stray in prop_oneof![0..6000_u32, any::<u32>()],
        types in prop::sample::select(vec!["02", "02,20"]),
    ) {
        let place = place.index(length as usize) as u32;
        // What comes first is the beginning, and what follows has to show that it was none.
        prop_assume!(place > 0 || length >= 8);
        // One right ahead is the sample itself, come early.
        prop_assume!(!(1..64).contains(&stray.wrapping_sub(first.wrapping_add(place))));
        let (mut receiver, mut sender) = (Receiver::new(), Sender::new(types));
        receiver.feed_samples(&mut sender, run(first, place).chain([stray]).chain(first + place..first + length));
        receiver.finish();
        let numbers = receiver.frame_numbers();
        for sample in run(first, length) {
            prop_assert!(numbers.contains(&sample), "{} is not in {:?}", sample, numbers);
        }
        assert_sum(&receiver);
    }

    #[test]
    fn two_sessions_back_to_back_lose_no_sample((first, length, second, other_length) in two_sessions()) {
        let expected: Vec<_> = run(first, length).chain(run(second, other_length)).collect();
        let receiver = received(expected.clone());
        prop_assert_eq!(receiver.frame_numbers(), expected);
        assert_sum(&receiver);
    }

    #[test]
    fn every_datagram_is_counted_once(
        pieces in prop::collection::vec((prop_oneof![0..40_u32, 0..2000_u32, any::<u32>()], 1..12_u32, 0..600_u64), 0..60),
        lacking in prop::collection::vec(any::<bool>(), 60),
    ) {
        let (mut receiver, mut sender) = (Receiver::new(), Sender::new("02,20"));
        for ((first, length, wait), lacks) in pieces.into_iter().zip(lacking) {
            for sample in run(first, length) {
                receiver.feed(sender.sample(sample).iter().skip(lacks.into()));
                assert_sum(&receiver);
                receiver.wait(PERIOD);
            }
            receiver.wait(Duration::from_millis(wait / 500 * wait));
        }
        receiver.finish();
        assert_sum(&receiver);
    }
}
