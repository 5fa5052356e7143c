//! The same seed does the same, and every fault does what it says.

use crate::stream::Disturbed;
use posewire::faults::{FaultKind, FaultPlan, Faults};
use posewire_mxtp::{Datagram, Header, MessageType, Value, explain};
use proptest::prelude::*;
use std::time::Duration;

const ALL: &str = "loss=1%,burst=0.1%x20,dup=0.5%,reorder=1%,jitter=5ms,drift=200ppm,reset@3s,rewind@5s-1s,truncate=0.1%,\
                   flip=0.1%,nan=0.1%,silence@6s+1s,seed=7";

fn disturbed(plan: &str) -> Disturbed {
    Disturbed::new(&plan.parse().unwrap(), 2400)
}

/// What leaves of headers with these numbers, a period of 4 ms apart.
fn numbers(plan: &str, samples: impl IntoIterator<Item = u32>) -> Vec<(u32, u32)> {
    let mut faults = Faults::new(plan.parse().unwrap());
    for (place, sample) in (0..).zip(samples) {
        let header = Header::rev_j(MessageType::QUATERNION, sample, 4 * sample);
        faults.handle(Duration::from_millis(4) * place, &header.encode());
    }
    faults.finish();
    let left = std::iter::from_fn(|| faults.poll()).map(|bytes| Header::decode(&bytes).unwrap());
    left.map(|header| (header.sample, header.time_ms)).collect()
}

#[test]
fn the_same_seed_makes_the_same_faults_to_the_byte() {
    let (first, again) = (disturbed(ALL), disturbed(ALL));
    assert_eq!(first.arrivals, again.arrivals);
    assert_eq!(first.made, again.made);
    assert_ne!(first.arrivals, disturbed(&ALL.replace("seed=7", "seed=8")).arrivals);
    let made: Vec<_> = first.made.iter().map(|(kind, _)| kind).collect();
    assert_eq!(made, FaultKind::ALL, "each of them was made");
}

#[test]
fn another_kind_of_fault_changes_nothing_of_which_datagrams_are_lost() {
    let lost = |plan: &str| disturbed(plan).made.of(FaultKind::Loss);
    assert_eq!(
        lost("loss=1%,seed=7"),
        lost("loss=1%,dup=5%,reorder=5%,nan=1%,jitter=3ms,seed=7")
    );
}

#[test]
fn what_leaves_is_what_came_less_what_was_lost_and_twice_what_was_doubled() {
    let made = disturbed(ALL).made;
    let gone = made.of(FaultKind::Loss) + made.of(FaultKind::Burst) + made.of(FaultKind::Silence);
    assert_eq!(made.sent, made.taken - gone + made.of(FaultKind::Duplicate));
}

#[test]
fn a_plan_without_faults_changes_nothing() {
    assert_eq!(disturbed("seed=7").arrivals, disturbed("seed=8").arrivals);
    assert_eq!(disturbed("seed=7").made.iter().count(), 0);
}

#[test]
fn a_reset_begins_at_0_again() {
    let left = numbers("reset@400ms", 1000..1200);
    assert_eq!(left[98..102], [(1098, 4392), (1099, 4396), (0, 0), (1, 4)]);
}

#[test]
fn a_rewind_goes_back_by_its_time_and_never_below_0() {
    let left = numbers("rewind@400ms-200ms", 1000..1200);
    assert_eq!(left[98..102], [(1098, 4392), (1099, 4396), (1050, 4200), (1051, 4204)]);
    let left = numbers("rewind@400ms-30s", 10..200);
    assert_eq!(left[99..102], [(109, 436), (0, 0), (1, 4)]);
}

#[test]
fn a_clock_that_is_too_fast_shows_other_times_and_the_same_numbers() {
    let left = numbers("drift=1000ppm", [0, 1000, 100_000]);
    assert_eq!(left, [(0, 0), (1000, 4004), (100_000, 400_400)]);
}

#[test]
fn what_is_cut_is_nowhere_whole() {
    let disturbed = disturbed("truncate=20%");
    let broken = disturbed
        .arrivals
        .iter()
        .filter(|(_, bytes)| Datagram::decode(bytes).is_err());
    assert_eq!(broken.count() as u64, disturbed.made.of(FaultKind::Truncate));
}

#[test]
fn a_float_that_is_not_a_number_is_in_a_datagram_that_can_be_read() {
    let disturbed = disturbed("nan=20%");
    let is_nan = |value: &Value| matches!(value, Value::Float(number) if number.is_nan());
    let broken = disturbed.arrivals.iter().filter(|(_, bytes)| {
        let explanation = explain(bytes);
        assert_eq!(explanation.error, None);
        explanation.fields.iter().filter(|field| is_nan(&field.value)).count() == 1
    });
    assert_eq!(broken.count() as u64, disturbed.made.of(FaultKind::Nan));
}

#[test]
fn nothing_leaves_in_a_silence() {
    let silent = Duration::from_secs(4)..Duration::from_secs(5);
    let disturbed = disturbed("silence@4s+1s");
    assert!(disturbed.arrivals.iter().all(|(at, _)| !silent.contains(at)));
    assert_eq!(disturbed.made.of(FaultKind::Silence), 5 * 240);
}

#[test]
fn frames_of_natnet_have_the_numbers_of_a_server_that_began_anew() {
    let mut faults = Faults::new("reset@1s".parse().unwrap());
    let frame = |number: u32| [&[7, 0, 6, 0][..], &number.to_le_bytes(), &[9, 9]].concat();
    for (second, number) in (0..).zip([500, 501, 502]) {
        faults.handle(Duration::from_secs(second), &frame(number));
    }
    let left: Vec<_> = std::iter::from_fn(|| faults.poll()).collect();
    assert_eq!(left, [frame(500), frame(0), frame(1)]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_at_any_time_upset_it(
        datagrams in prop::collection::vec((0..2000_u64, prop::collection::vec(any::<u8>(), 0..80)), 0..60),
        as_mxtp in any::<bool>(),
    ) {
        let plan: FaultPlan = "loss=10%,burst=5%x3,dup=10%,reorder=10%,jitter=5s,drift=200ppm,reset@1s,rewind@2s,\
                               truncate=10%,flip=10%,nan=10%,silence@20s+3s".parse().unwrap();
        let mut faults = Faults::new(plan);
        let (mut now, mut left) = (Duration::ZERO, 0);
        for (wait, mut bytes) in datagrams {
            now += Duration::from_millis(wait);
            if as_mxtp && bytes.len() > 6 {
                bytes[..6].copy_from_slice(b"MXTP02");
            }
            faults.handle(now, &bytes);
            left += std::iter::from_fn(|| faults.poll()).count() as u64;
        }
        faults.finish();
        left += std::iter::from_fn(|| faults.poll()).count() as u64;
        prop_assert_eq!(left, faults.counts().sent);
    }
}
