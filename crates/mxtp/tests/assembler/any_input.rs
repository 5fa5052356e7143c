//! No datagrams, in whatever order and state, upset an assembler.

use crate::stream::{Receiver, Sender, character, rev_j};
use posewire_motion::Skeleton;
use posewire_mxtp::{AssemblerOptions, Event};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::time::Duration;

/// Datagrams of several characters, whole and split, of both revisions.
fn datagrams() -> Vec<Vec<u8>> {
    let split = |options: &mut _| split_to(options, 300);
    let mut senders = [
        Sender::new("01,02,05,20,12,13"),
        Sender::with("02,20,12,13", character(1)).skeleton(Skeleton::standard(2, true)),
        Sender::with("02,01", rev_j).skeleton(Skeleton::standard(1, false)),
        Sender::with("02,20,13", split),
    ];
    let mut all = Vec::new();
    for sender in &mut senders {
        all.extend(sender.description().iter().map(<[u8]>::to_vec));
        for number in [0, 1, 2, 3, 4, 300, u32::MAX] {
            all.extend(sender.sample(number).iter().map(<[u8]>::to_vec));
        }
    }
    all
}

fn split_to(options: &mut posewire_mxtp::motion::EncoderOptions, limit: usize) {
    options.split = Some(limit);
}

/// One datagram as it may arrive: changed in a few bytes, or cut, or neither, after a wait.
#[derive(Clone, Debug)]
struct Disturbed {
    datagram: prop::sample::Index,
    changes: Vec<(prop::sample::Index, u8)>,
    length: Option<prop::sample::Index>,
    wait_ms: u64,
}

fn disturbed() -> impl Strategy<Value = Disturbed> {
    let change = (any::<prop::sample::Index>(), any::<u8>());
    (
        any::<prop::sample::Index>(),
        prop_oneof![3 => Just(Vec::new()), 1 => prop::collection::vec(change, 1..4)],
        prop::option::weighted(0.1, any::<prop::sample::Index>()),
        0..40_u64,
    )
        .prop_map(|(datagram, changes, length, wait_ms)| Disturbed {
            datagram,
            changes,
            length,
            wait_ms,
        })
}

impl Disturbed {
    fn bytes(&self, from: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = self.datagram.get(from).clone();
        for (place, value) in &self.changes {
            // Most of what can go wrong is in the header.
            let reach = if value % 2 == 0 {
                bytes.len().min(24)
            } else {
                bytes.len()
            };
            let place = place.index(reach);
            bytes[place] = *value;
        }
        if let Some(length) = &self.length {
            bytes.truncate(length.index(bytes.len() + 1));
        }
        bytes
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn samples_that_are_given_ahead_change_nothing_of_the_rest(arrivals in prop::collection::vec(disturbed(), 0..200)) {
        let options = AssemblerOptions { ahead: true, ..AssemblerOptions::default() };
        let (from, mut plain, mut ahead) = (datagrams(), Receiver::new(), Receiver::with(options));
        for arrival in arrivals {
            for receiver in [&mut plain, &mut ahead] {
                receiver.feed([&arrival.bytes(&from)[..]]);
                receiver.wait(Duration::from_millis(arrival.wait_ms));
            }
        }
        plain.finish();
        ahead.finish();
        ahead.events.retain(|event| !matches!(event, Event::Ahead(_)));
        // By their text: a number that is none equals no other.
        prop_assert_eq!(format!("{:?}", plain.events), format!("{:?}", ahead.events));
    }

    #[test]
    fn every_frame_fits_its_subject_and_memory_is_bounded(arrivals in prop::collection::vec(disturbed(), 0..200)) {
        let (from, mut receiver) = (datagrams(), Receiver::new());
        for arrival in arrivals {
            // The receiver checks every frame that comes out.
            receiver.feed([&arrival.bytes(&from)[..]]);
            receiver.wait(Duration::from_millis(arrival.wait_ms));
            prop_assert!(receiver.assembler.buffered() <= 64 * 4 * (256 << 10));
        }
        receiver.finish();
        prop_assert_eq!(receiver.assembler.buffered(), 0);
        prop_assert_eq!(receiver.assembler.timeout(), None);
    }

    #[test]
    fn every_sample_of_which_something_came_makes_one_frame(
        disturbances in prop::collection::vec((0..100_u32, 0..12_usize), 300..301),
        split in prop::option::of(Just(300)),
    ) {
        let mut sender = Sender::with("02,20", |options| options.split = split);
        let (mut arrivals, mut arrived) = (Vec::new(), BTreeSet::new());
        let datagrams = (0..50).flat_map(|sample| {
            let datagrams = sender.sample(sample);
            datagrams.iter().map(|bytes| (sample, bytes.to_vec())).collect::<Vec<_>>()
        });
        for (place, ((sample, bytes), (chance, delay))) in datagrams.zip(disturbances.iter().cycle()).enumerate() {
            let (lost, delayed, doubled) = (*chance < 10, *chance < 30, *chance >= 90);
            if !lost {
                arrivals.push((place + if delayed { *delay } else { 0 }, bytes.clone()));
                arrived.insert(sample);
            }
            if doubled {
                arrivals.push((place + delay, bytes));
            }
        }
        arrivals.sort_by_key(|(place, _)| *place);
        let mut receiver = Receiver::new();
        for (_, bytes) in &arrivals {
            receiver.feed([&bytes[..]]);
            receiver.wait(Duration::from_millis(1));
        }
        receiver.finish();
        let mut frames = receiver.frame_numbers();
        frames.sort_unstable();
        prop_assert_eq!(frames, arrived.into_iter().collect::<Vec<_>>());
    }

    #[test]
    fn any_bytes_are_taken(arrivals in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..100), 0..50)) {
        let mut receiver = Receiver::new();
        for bytes in &arrivals {
            let mut prefixed = b"MXTP02".to_vec();
            prefixed.extend(bytes);
            receiver.feed([&bytes[..], &prefixed[..]]);
        }
        receiver.finish();
    }
}
