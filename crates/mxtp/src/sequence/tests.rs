//! What a sequence makes of numbers and times, up to the very number and time.

use super::*;

fn observe(sequence: &mut Sequence, samples: impl IntoIterator<Item = u32>) -> Vec<Observation> {
    let mut now = sequence.pace.newest;
    let step = |sample| {
        now = now.after(Duration::from_millis(4));
        sequence.observe(sample, now)
    };
    samples.into_iter().map(step).collect()
}

fn tally(missing: u64, duplicate: u64, late: u64, reset: u64) -> Tally {
    Tally {
        missing,
        duplicate,
        late,
        reset,
        ..Tally::default()
    }
}

#[test]
fn what_goes_back_after_a_silence_is_a_new_session() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, 0..30);
    let later = sequence.pace.newest.after(Duration::from_secs(1));
    assert_eq!(sequence.observe(29, later), Observation::Duplicate);
    assert_eq!(sequence.observe(0, later), Observation::Reset(ResetKind::Restart));
    assert_eq!(sequence.tally(), tally(0, 1, 0, 1));
}

#[test]
fn a_constant_stride_is_not_loss() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, (0..100).map(|n| 4 * n));
    assert_eq!((sequence.stride(), sequence.tally()), (Some(4), Tally::default()));
    observe(&mut sequence, [408]);
    assert_eq!(sequence.tally().missing, 2);
}

#[test]
fn losses_among_the_first_steps_are_counted_when_the_stride_is_learnt() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, [0, 6, 9, 12, 15]);
    assert_eq!((sequence.stride(), sequence.tally().missing), (Some(3), 1));
}

#[test]
fn a_decimation_that_is_no_whole_number_is_not_loss() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, (0..100).map(|n| n * 5 / 2));
    assert_eq!(sequence.tally(), Tally::default());
}

#[test]
fn the_counter_wraps_around() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, (0..100).map(|n: u32| (n * 3).wrapping_sub(150)));
    assert_eq!((sequence.stride(), sequence.tally()), (Some(3), Tally::default()));
}

#[test]
fn a_late_sample_is_no_longer_missing() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (0..20).chain([22, 20, 21, 21]));
    let expected = [
        Observation::New { missing_before: 2 },
        Observation::Late,
        Observation::Late,
        Observation::Duplicate,
    ];
    assert_eq!(seen[20..], expected);
    assert_eq!(sequence.tally(), tally(0, 1, 2, 0));
}

#[test]
fn a_stream_that_begins_out_of_order_misses_nothing() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, [3, 1, 0, 2, 4, 5]);
    assert_eq!(sequence.tally(), tally(0, 0, 3, 0));
}

#[test]
fn a_new_session_is_a_reset() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (1000..1400).chain(0..10));
    assert_eq!(seen[400], Observation::Reset(ResetKind::Restart));
    assert_eq!(sequence.tally(), tally(0, 0, 0, 1));
}

#[test]
fn the_first_sample_again_is_a_duplicate() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, [0; 20]);
    assert_eq!(sequence.tally(), tally(0, 19, 0, 0));
}

#[test]
fn a_short_session_that_starts_anew_is_a_reset() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (0..50).chain(0..20));
    assert_eq!(seen[57], Observation::Reset(ResetKind::Restart));
    assert_eq!(sequence.tally(), tally(0, 0, 0, 1));
}

#[test]
fn a_rewind_into_a_gap_gives_back_what_was_missing() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, (0..20).chain(30..100).chain(20..60));
    let rewound = Tally {
        rewound: 1,
        ..tally(10, 0, 0, 0)
    };
    assert_eq!(sequence.tally(), rewound);
    assert_eq!(sequence.newest(), Some(59));
}

#[test]
fn a_jump_forward_is_no_loss_but_an_outage_is() {
    let mut jump = Sequence::new();
    let seen = observe(&mut jump, (0..100).chain(5000..5010));
    assert_eq!(seen[100], Observation::Reset(ResetKind::Jump));
    let jumped = Tally {
        jumped: 1,
        ..Tally::default()
    };
    assert_eq!(jump.tally(), jumped);

    let mut outage = Sequence::new();
    observe(&mut outage, 0..100);
    let later = outage.pace.newest.after(Duration::from_millis(4 * 4900));
    assert_eq!(outage.observe(5000, later), Observation::New { missing_before: 4900 });
}

#[test]
fn a_new_stride_is_learnt_and_what_it_seemed_to_miss_is_not_counted() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, (0..100).chain((102..200).step_by(3)));
    assert_eq!((sequence.stride(), sequence.tally()), (Some(3), Tally::default()));
    observe(&mut sequence, 199..220);
    assert_eq!((sequence.stride(), sequence.tally()), (Some(1), Tally::default()));
}

#[test]
fn pairs_that_always_swap_do_not_look_like_a_stride() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, (0..200).map(|n| n ^ 1));
    assert_eq!((sequence.stride(), sequence.tally()), (Some(1), tally(0, 0, 100, 0)));
}

#[test]
fn a_pause_of_the_sender_is_no_loss() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, 0..100);
    sequence.pace.newest = sequence.pace.newest.after(Duration::from_hours(1));
    observe(&mut sequence, 100..200);
    assert_eq!(sequence.tally(), Tally::default());
}

#[test]
fn a_counter_that_began_anew_during_a_silence_is_a_reset_and_no_rewind() {
    let mut sequence = Sequence::new();
    observe(&mut sequence, 0..2000);
    let later = sequence.pace.newest.after(Duration::from_secs(3));
    assert_eq!(sequence.observe(740, later), Observation::Reset(ResetKind::Restart));
    let soon = later.after(Duration::from_millis(4));
    let mut other = Sequence::new();
    observe(&mut other, 0..2000);
    other.pace.newest = later;
    assert_eq!(other.observe(740, soon), Observation::Reset(ResetKind::Rewind));
}

#[test]
fn what_is_left_of_the_session_before_is_late_and_no_session_of_its_own() {
    let mut sequence = Sequence::new();
    let before = (0..997).chain([998]);
    let seen = observe(&mut sequence, before.chain([0, 997, 1, 999, 999, 2, 3]));
    let expected = [
        Observation::Reset(ResetKind::Restart),
        Observation::Straggler,
        Observation::New { missing_before: 0 },
        Observation::Straggler,
        Observation::Duplicate,
        Observation::New { missing_before: 0 },
        Observation::New { missing_before: 0 },
    ];
    assert_eq!(seen[998..], expected);
    assert_eq!(sequence.tally(), tally(0, 1, 2, 1));
}

#[test]
fn a_sender_that_goes_back_to_the_session_before_is_believed_after_eight_samples() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (0..1000).chain(0..10).chain(900..950));
    assert_eq!(seen[1017], Observation::Reset(ResetKind::Jump));
    let expected = Tally {
        jumped: 1,
        ..tally(0, 0, 0, 1)
    };
    assert_eq!((sequence.tally(), sequence.newest()), (expected, Some(949)));
}

#[test]
fn a_sample_with_a_number_out_of_nowhere_takes_two_others_with_it_at_most() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (0..1000).chain([1 << 30]).chain(1000..1010));
    assert_eq!(seen[1000], Observation::Reset(ResetKind::Jump));
    assert_eq!(seen[1003], Observation::Reset(ResetKind::Rewind));
    let expected = Tally {
        rewound: 1,
        jumped: 1,
        ..Tally::default()
    };
    assert_eq!((sequence.tally(), sequence.newest()), (expected, Some(1009)));
}

/// A sequence that has seen `samples`, each 4 ms after the one before, and when it saw the last.
fn seen(samples: impl IntoIterator<Item = u32>) -> (Sequence, Stamp) {
    let mut sequence = Sequence::new();
    observe(&mut sequence, samples);
    let now = sequence.pace.newest;
    (sequence, now)
}

const PERIOD: Duration = Duration::from_millis(4);

#[test]
fn what_is_older_is_late_for_half_a_second_of_silence_and_then_begins_anew() {
    let (mut sequence, now) = seen((0..20).chain(21..30));
    let at_last = now.after(SILENCE);
    assert_eq!(sequence.clone().observe(20, at_last), Observation::Late);
    let later = at_last.after(Duration::from_nanos(1));
    assert_eq!(sequence.observe(20, later), Observation::Reset(ResetKind::Restart));
}

#[test]
fn a_straggler_is_no_longer_missing_when_the_new_session_has_settled() {
    let (mut sequence, now) = seen((0..997).chain([998]).chain(0..20));
    assert_eq!(sequence.tally(), tally(1, 0, 0, 1));
    assert_eq!(sequence.observe(997, now), Observation::Straggler);
    assert_eq!(sequence.tally(), tally(0, 0, 1, 1));
    observe(&mut sequence, 20..40);
    assert_eq!(sequence.tally(), tally(0, 0, 1, 1));
}

#[test]
fn a_straggler_that_is_newer_than_its_session_shows_what_is_missing_before_it() {
    let (mut sequence, now) = seen((0..1000).chain(0..20));
    assert_eq!(sequence.observe(1002, now), Observation::Straggler);
    assert_eq!(sequence.tally(), tally(2, 0, 1, 1));
    assert_eq!(sequence.observe(1001, now), Observation::Straggler);
    assert_eq!(sequence.tally(), tally(1, 0, 2, 1));
}

#[test]
fn what_is_far_from_the_session_before_is_none_of_it() {
    let (sequence, now) = seen((0..1000).chain(0..3));
    assert_eq!(sequence.clone().observe(999 + 16, now), Observation::Straggler);
    assert_eq!(
        sequence.clone().observe(999 + 17, now),
        Observation::Reset(ResetKind::Jump)
    );
    assert_eq!(sequence.clone().observe(1000 - 256, now), Observation::Duplicate);
    assert_eq!(
        sequence.clone().observe(1000 - 257, now),
        Observation::Reset(ResetKind::Jump)
    );
}

#[test]
fn how_far_the_session_before_goes_on_is_counted_in_strides() {
    let (sequence, now) = seen((0..1000).chain(0..3).map(|n| 4 * n));
    let on_by = |counts: u32| sequence.clone().observe(4 * 999 + counts, now);
    assert_eq!(on_by(4 * 17 - 1), Observation::Straggler);
    assert_eq!(on_by(4 * 17), Observation::Reset(ResetKind::Jump));
}

#[test]
fn stragglers_come_for_half_a_second() {
    let (mut sequence, now) = seen((0..998).chain([999]).chain([0]));
    let at_last = now.after(SILENCE);
    assert_eq!(sequence.clone().observe(998, at_last), Observation::Straggler);
    let later = at_last.after(Duration::from_nanos(1));
    assert!(!matches!(sequence.observe(998, later), Observation::Straggler));
}

#[test]
fn stragglers_between_the_samples_of_a_session_never_end_it() {
    let (mut sequence, now) = seen((0..1000).chain([0]));
    for number in 1..6 {
        assert_eq!(sequence.observe(999 + number, now), Observation::Straggler);
        assert_eq!(sequence.observe(number, now), Observation::New { missing_before: 0 });
    }
    assert_eq!(sequence.tally(), tally(0, 0, 5, 1));
}

#[test]
fn how_far_back_a_counter_begins_anew_is_told_by_the_time() {
    // 4 counts every 4 ms: one period later it can have come to 4, and 16 strides of 4 are spared.
    let (sequence, now) = seen((0..400).map(|n| 4 * n));
    let back_to = |sample| sequence.clone().observe(sample, now.after(PERIOD));
    assert_eq!(back_to(4 + 64), Observation::Reset(ResetKind::Restart));
    assert_eq!(back_to(4 + 65), Observation::Reset(ResetKind::Rewind));
}

#[test]
fn how_far_a_gap_is_loss_is_told_by_the_time() {
    // One stride passed in the time: four times that and 16 are believed.
    let (sequence, now) = seen((0..400).map(|n| 4 * n));
    let on_by = |strides: u32| sequence.clone().observe(4 * (399 + strides), now.after(PERIOD));
    assert_eq!(on_by(20), Observation::New { missing_before: 19 });
    assert_eq!(on_by(21), Observation::Reset(ResetKind::Jump));
    let before_the_stride_is_known = seen([0]).0.observe(1_000_000, now);
    assert_eq!(before_the_stride_is_known, Observation::New { missing_before: 0 });
}

#[test]
fn samples_are_late_as_far_back_as_they_are_remembered() {
    let (sequence, now) = seen(0..1000);
    assert_eq!(sequence.clone().observe(1000 - 256, now), Observation::Duplicate);
    assert_eq!(
        sequence.clone().observe(1000 - 257, now),
        Observation::Reset(ResetKind::Rewind)
    );
}

#[test]
fn samples_of_a_short_session_are_late_as_far_back_as_there_is_room_for() {
    let late_by = |stride: u32, behind: u32| {
        let (mut sequence, now) = seen((1000..1010).map(|n| n * stride));
        sequence.observe(1009 * stride - behind, now)
    };
    assert_eq!(late_by(1, 256), Observation::Late);
    assert_eq!(late_by(1, 257), Observation::Reset(ResetKind::Rewind));
    assert_eq!(late_by(10, 320), Observation::Late);
    assert_eq!(late_by(10, 321), Observation::Reset(ResetKind::Rewind));
}

/// How many steps, given one after the other and again from the first, it takes until the stride is settled.
fn settles_after(steps: &[u32]) -> usize {
    let (mut sequence, mut sample) = (Sequence::new(), 100);
    observe(&mut sequence, [sample]);
    for (count, step) in (1..=100).zip(steps.iter().cycle()) {
        sample += step;
        observe(&mut sequence, [sample]);
        if sequence.settled {
            return count;
        }
    }
    usize::MAX
}

#[test]
fn a_stride_is_settled_by_eight_steps_of_which_six_agree_or_by_sixty_four() {
    assert_eq!(settles_after(&[3]), 8);
    assert_eq!(settles_after(&[1, 1, 1, 2, 1, 1, 1, 2]), 8);
    assert_eq!(settles_after(&[1, 1, 1, 2, 1, 2, 1, 2]), 64);
    assert_eq!(settles_after(&[1, 2]), 64);
}

#[test]
fn a_late_sample_changes_a_stride_that_is_not_settled() {
    let (mut sequence, _) = seen([0, 4, 8]);
    observe(&mut sequence, [6]);
    assert_eq!((sequence.stride(), sequence.tally()), (Some(2), tally(1, 0, 1, 0)));
}

#[test]
fn a_late_sample_leaves_what_was_missing_long_before() {
    let (mut sequence, _) = seen((0..50).chain(51..400));
    observe(&mut sequence, [401, 400]);
    assert_eq!(sequence.tally(), tally(1, 0, 1, 0));
}

#[test]
fn a_shorter_stride_is_learnt_from_eight_steps_and_a_longer_one_from_sixteen() {
    let (mut sequence, _) = seen((0..20).map(|n| 3 * n));
    observe(&mut sequence, 58..58 + 7);
    assert_eq!(sequence.stride(), Some(3));
    observe(&mut sequence, [65]);
    assert_eq!((sequence.stride(), sequence.tally()), (Some(1), Tally::default()));
    observe(&mut sequence, (1..16).map(|n| 65 + 3 * n));
    assert_eq!((sequence.stride(), sequence.tally().missing), (Some(1), 30));
    observe(&mut sequence, [65 + 48]);
    assert_eq!((sequence.stride(), sequence.tally()), (Some(3), Tally::default()));
}

#[test]
fn what_comes_twice_while_a_rewind_is_found_out_is_a_duplicate_and_delays_nothing() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (0..100).chain([50, 51, 52, 52, 53, 54, 55, 56, 57, 58]));
    assert_eq!(seen[108], Observation::Reset(ResetKind::Rewind));
    let expected = Tally {
        rewound: 1,
        ..tally(0, 1, 0, 0)
    };
    assert_eq!((sequence.tally(), sequence.newest()), (expected, Some(58)));
}
