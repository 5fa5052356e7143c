//! The counts are exact.

use crate::oracle::{Counts, Everything};
use crate::stream::{Disturbed, TYPES};
use posewire::faults::{FaultKind, FaultPlan, FaultedStream};
use posewire_mxtp::MessageType;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::time::Duration;

/// 60 s at 240 Hz.
const A_MINUTE: u16 = 14_400;

/// What a receiver must count of a stream by what the faults say they did to it, of which `unknowable` samples were lost
/// between the last that arrived of a session and the first of the next.
fn by_faults(disturbed: &Disturbed, message_type: MessageType, unknowable: u64) -> Counts {
    let stream = FaultedStream {
        character: Some(0),
        kind: Some(message_type.into()),
    };
    let made = |kind| disturbed.made.in_stream(stream, kind);
    let lost = made(FaultKind::Loss) + made(FaultKind::Burst) + made(FaultKind::Truncate);
    Counts {
        received: u64::from(A_MINUTE) - lost,
        missing: lost - unknowable,
        duplicate: made(FaultKind::Duplicate),
        late: made(FaultKind::Reorder),
        reset: made(FaultKind::Reset),
        // Which type it was cannot be told of what is cut within its header.
        malformed: 0,
    }
}

fn check_a_minute(plan: &str, seeds: RangeInclusive<u64>) {
    for seed in seeds {
        let plan: FaultPlan = format!("{plan},seed={seed}").parse().unwrap();
        let disturbed = Disturbed::new(&plan, A_MINUTE);
        let counted = Everything::counted(&disturbed.received());
        let expected = Everything::expected(&disturbed, &plan);
        for message_type in TYPES {
            let counts = Counts {
                malformed: 0,
                ..counted.streams[&message_type]
            };
            assert_eq!(
                counts,
                by_faults(&disturbed, message_type, expected.unknowable[&message_type]),
                "{message_type}, {plan}"
            );
        }
        assert_eq!(counted.malformed, disturbed.made.of(FaultKind::Truncate), "{plan}");
        assert_eq!(
            counted,
            Everything {
                unknowable: BTreeMap::new(),
                ..expected
            },
            "{plan}"
        );
    }
}

#[test]
fn a_minute_of_loss_is_counted_exactly() {
    check_a_minute("loss=1%", 1..=2);
}

#[test]
fn a_minute_of_bursts_is_counted_exactly() {
    check_a_minute("burst=0.1%x20", 1..=2);
}

#[test]
fn a_minute_of_duplicates_is_counted_exactly() {
    check_a_minute("dup=0.5%", 1..=2);
}

#[test]
fn a_minute_of_reordering_is_counted_exactly() {
    check_a_minute("reorder=1%", 1..=2);
}

#[test]
fn a_minute_with_resets_is_counted_exactly() {
    check_a_minute("reset@10s,reset@25s,reset@40s", 1..=1);
}

#[test]
fn a_minute_of_cut_datagrams_is_counted_exactly() {
    check_a_minute("truncate=0.5%", 1..=2);
}

#[test]
fn a_minute_of_everything_is_counted_exactly() {
    check_a_minute(
        "loss=1%,burst=0.02%x20,dup=0.5%,reorder=1%,truncate=0.1%,reset@10s,reset@35s",
        1..=6,
    );
}

fn plans() -> impl Strategy<Value = FaultPlan> {
    let share = || prop_oneof![Just(0.0), 0.0..2.0_f64];
    let resets = prop::sample::select(vec![vec![], vec![4_000], vec![3_500, 6_100]]);
    (share(), share(), share(), share(), resets, any::<u64>()).prop_map(
        |(loss, duplicate, reorder, truncate, resets, seed)| FaultPlan {
            loss,
            duplicate,
            reorder,
            truncate,
            resets: resets.into_iter().map(Duration::from_millis).collect(),
            seed,
            ..FaultPlan::default()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_happens_to_a_stream_is_counted_as_an_oracle_counts_it(plan in plans()) {
        let disturbed = Disturbed::new(&plan, 2400);
        let counted = Everything::counted(&disturbed.received());
        let expected = Everything { unknowable: BTreeMap::new(), ..Everything::expected(&disturbed, &plan) };
        prop_assert_eq!(counted, expected);
    }
}
