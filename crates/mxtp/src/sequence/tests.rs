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

/// What the last of eight samples is, a period apart and a stride of `stride` from the first, that is received at `now`.
fn eighth(mut sequence: Sequence, first: u32, stride: u32, now: Stamp) -> Observation {
    let samples = (0..8).zip(std::iter::successors(Some(now), |now| Some(now.after(PERIOD))));
    let seen = samples.map(|(place, now)| sequence.observe(first + place * stride, now));
    seen.last().unwrap()
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
    assert_eq!(seen[400..407], [Observation::Stray; 7]);
    assert_eq!(seen[407], Observation::Reset(ResetKind::Restart));
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
    assert_eq!(seen[107], Observation::Reset(ResetKind::Jump));
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
    let soon = later.after(PERIOD);
    let mut other = Sequence::new();
    observe(&mut other, 0..2000);
    other.pace.newest = later;
    assert_eq!(eighth(other, 740, 1, soon), Observation::Reset(ResetKind::Rewind));
}

#[test]
fn what_is_left_of_the_session_before_is_late_and_no_session_of_its_own() {
    let mut sequence = Sequence::new();
    let before = (0..997).chain([998]);
    let seen = observe(&mut sequence, before.chain([0, 997, 1, 999, 999, 2, 3]));
    let expected = [
        Observation::Stray,
        Observation::Late,
        Observation::Stray,
        Observation::New { missing_before: 0 },
        Observation::Duplicate,
        Observation::Stray,
        Observation::Stray,
    ];
    assert_eq!(seen[998..], expected);
    let seen = observe(&mut sequence, [4, 5, 6, 7, 1000, 8, 1000, 9]);
    let expected = [
        Observation::Reset(ResetKind::Restart),
        Observation::Straggler,
        Observation::New { missing_before: 0 },
        Observation::Duplicate,
        Observation::New { missing_before: 0 },
    ];
    assert_eq!(seen[3..], expected);
    assert_eq!(sequence.tally(), tally(0, 2, 2, 1));
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
fn a_sample_with_a_number_out_of_nowhere_is_late_and_changes_nothing() {
    for stray in [1 << 30, 3, 700, 1500] {
        let mut sequence = Sequence::new();
        let seen = observe(&mut sequence, (0..1000).chain([stray]).chain(1000..1010));
        assert_eq!(seen[1000], Observation::Stray);
        assert_eq!(seen[1001..], [Observation::New { missing_before: 0 }; 10]);
        assert_eq!((sequence.tally(), sequence.newest()), (tally(0, 0, 1, 0), Some(1009)));
    }
}

#[test]
fn a_sample_out_of_nowhere_after_a_silence_begins_a_session_and_the_one_before_goes_on() {
    let (mut sequence, now) = seen(0..1000);
    let later = now.after(Duration::from_secs(1));
    assert_eq!(sequence.observe(200, later), Observation::Reset(ResetKind::Restart));
    let seen = observe(&mut sequence, 1000..1010);
    assert_eq!(seen[..2], [Observation::Straggler; 2]);
    assert_eq!(seen[2], Observation::Reset(ResetKind::Jump));
    assert_eq!((sequence.tally().late, sequence.tally().missing), (0, 0));
}

#[test]
fn five_new_samples_between_those_of_a_session_do_not_hide_it_and_six_do() {
    let between = |new: u32| {
        let mixed = (0..new).flat_map(|n| [n, 1000 + n]).chain(new..8);
        observe(&mut Sequence::new(), (0..1000).chain(mixed)).pop()
    };
    assert_eq!(between(5), Some(Observation::Reset(ResetKind::Restart)));
    assert_eq!(between(6), Some(Observation::Stray));
}

#[test]
fn a_stray_among_the_first_samples_of_a_session_does_not_hide_it() {
    for place in 0..8 {
        let run = (0..place).chain([50_000]).chain(place..8);
        let (mut sequence, _) = seen((0..1000).chain(run));
        assert_eq!(sequence.newest(), Some(7), "{place}");
        assert_eq!(sequence.tally(), tally(0, 0, 1, 1), "{place}");
        assert!((0..8).all(|sample| sequence.remembers(sample)), "{place}");
        observe(&mut sequence, 8..40);
        assert_eq!(sequence.tally(), tally(0, 0, 1, 1), "{place}");
    }
}

#[test]
fn a_session_that_grows_into_where_samples_are_late_keeps_its_order() {
    let mut sequence = Sequence::new();
    let seen = observe(&mut sequence, (540..724).chain(466..474));
    assert_eq!(seen[184..191], [Observation::Stray; 7]);
    assert_eq!(seen[191], Observation::Reset(ResetKind::Rewind));
    assert_eq!(sequence.tally().late, 0);
}

#[test]
fn the_first_samples_of_a_session_may_swap() {
    for place in 0..7 {
        let mut run: Vec<u32> = (0..8).collect();
        run.swap(place, place + 1);
        let (sequence, _) = seen((0..1000).chain(run));
        assert_eq!((sequence.newest(), sequence.tally()), (Some(7), tally(0, 0, 0, 1)));
    }
}

#[test]
fn a_session_of_seven_samples_that_all_come_again_goes_on_with_the_next() {
    let (mut sequence, _) = seen((0..7).chain(0..7));
    assert_eq!(sequence.tally(), tally(0, 7, 0, 0));
    assert_eq!(observe(&mut sequence, [7]), [Observation::New { missing_before: 0 }]);
    assert_eq!(sequence.tally(), tally(0, 7, 0, 0));
}

#[test]
fn eight_samples_of_a_jump_are_one_though_the_time_comes_to_explain_it() {
    let (mut sequence, now) = seen(0..100);
    let seen = [120, 121, 122].map(|sample| sequence.observe(sample, now));
    assert_eq!(seen, [Observation::Stray; 3]);
    let later = now.after(PERIOD * 20);
    let seen = [123, 124, 125, 126, 127].map(|sample| sequence.observe(sample, later));
    assert_eq!(seen[4], Observation::Reset(ResetKind::Jump));
}

#[test]
fn what_was_put_aside_before_a_silence_is_of_the_session_after_it() {
    let (mut sequence, now) = seen((0..100).chain(0..3));
    let later = now.after(Duration::from_secs(1));
    assert_eq!(sequence.observe(3, later), Observation::Reset(ResetKind::Restart));
    assert!((0..4).all(|sample| sequence.remembers(sample)));
    assert_eq!(sequence.tally(), tally(0, 0, 0, 1));
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
    let (sequence, now) = seen((0..1000).chain(0..8));
    assert_eq!(sequence.clone().observe(999 + 16, now), Observation::Straggler);
    assert_eq!(sequence.clone().observe(999 + 17, now), Observation::Stray);
    assert_eq!(
        eighth(sequence.clone(), 999 + 17, 1, now),
        Observation::Reset(ResetKind::Jump)
    );
    assert_eq!(sequence.clone().observe(1000 - 256, now), Observation::Duplicate);
    assert_eq!(sequence.clone().observe(1000 - 257, now), Observation::Stray);
    assert_eq!(
        eighth(sequence.clone(), 1000 - 265, 1, now),
        Observation::Reset(ResetKind::Jump)
    );
}

#[test]
fn how_far_the_session_before_goes_on_is_counted_in_strides() {
    let (sequence, now) = seen((0..1000).chain(0..8).map(|n| 4 * n));
    let on_by = |counts: u32| sequence.clone().observe(4 * 999 + counts, now);
    assert_eq!(on_by(4 * 17 - 1), Observation::Straggler);
    assert_eq!(on_by(4 * 17), Observation::Stray);
}

#[test]
fn stragglers_come_for_half_a_second() {
    let (mut sequence, now) = seen((0..998).chain([999]).chain(0..8));
    let at_last = now.after(SILENCE);
    assert_eq!(sequence.clone().observe(998, at_last), Observation::Straggler);
    let later = at_last.after(Duration::from_nanos(1));
    assert!(!matches!(sequence.observe(998, later), Observation::Straggler));
}

#[test]
fn stragglers_between_the_samples_of_a_session_never_end_it() {
    let (mut sequence, now) = seen((0..1000).chain(0..8));
    for number in 1..6 {
        assert_eq!(sequence.observe(999 + number, now), Observation::Straggler);
        assert_eq!(
            sequence.observe(7 + number, now),
            Observation::New { missing_before: 0 }
        );
    }
    assert_eq!(sequence.tally(), tally(0, 0, 5, 1));
}

#[test]
fn how_far_back_a_counter_begins_anew_is_told_by_the_time() {
    // 4 counts every 4 ms: one period later it can have come to 4, and 16 strides of 4 are spared.
    let (sequence, now) = seen((0..400).map(|n| 4 * n));
    let back_to = |sample| eighth(sequence.clone(), sample, 4, now.after(PERIOD));
    assert_eq!(back_to(4 + 64), Observation::Reset(ResetKind::Restart));
    assert_eq!(back_to(4 + 65), Observation::Reset(ResetKind::Rewind));
}

#[test]
fn how_far_a_gap_is_loss_is_told_by_the_time() {
    // One stride passed in the time: four times that and 16 are believed.
    let (sequence, now) = seen((0..400).map(|n| 4 * n));
    let on_by = |strides: u32| sequence.clone().observe(4 * (399 + strides), now.after(PERIOD));
    assert_eq!(on_by(20), Observation::New { missing_before: 19 });
    assert_eq!(on_by(21), Observation::Stray);
    let before_the_stride_is_known = seen([0]).0.observe(1_000_000, now);
    assert_eq!(before_the_stride_is_known, Observation::New { missing_before: 0 });
}

#[test]
fn samples_are_late_as_far_back_as_they_are_remembered() {
    let (sequence, now) = seen(0..1000);
    assert_eq!(sequence.clone().observe(1000 - 256, now), Observation::Duplicate);
    assert_eq!(sequence.clone().observe(1000 - 257, now), Observation::Stray);
    assert_eq!(
        eighth(sequence, 1000 - 265, 1, now),
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
    assert_eq!(late_by(1, 257), Observation::Stray);
    assert_eq!(late_by(10, 320), Observation::Late);
    assert_eq!(late_by(10, 321), Observation::Stray);
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
