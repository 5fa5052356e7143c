//! The sample counter of one stream: what is missing, late, duplicate, and when it starts anew.

mod pace;
mod runs;

use pace::Pace;
use posewire_motion::Stamp;
use runs::{EqualSteps, OldRun};
use std::collections::VecDeque;
use std::time::Duration;

/// Follows the sample counter of one message type of one character (MV0305 2.4.1.2).
///
/// The counter runs at the sampling rate, and a sender may stream less often: then it goes up by a constant *stride*,
/// which is learnt from the first eight steps (or more, when they disagree) and again when eight shorter or sixteen
/// longer equal steps come in a row. Losses are counted in strides. A counter that wraps around goes on; one that goes
/// back, or forward further than the time that passed explains, is a reset and no loss.
///
/// What is missing depends on the set of samples that came and not on their order: a sample that comes late is no
/// longer missing.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    /// The samples seen, oldest first, each once.
    window: VecDeque<u32>,
    tally: Tally,
    stride: Option<u32>,
    /// Whether the stride still follows every step of a session that has just begun.
    settled: bool,
    /// Samples that were missing when the session began.
    missing_before: u64,
    other_steps: EqualSteps,
    old: OldRun,
    pace: Pace,
}

/// How often what happened to the samples of a stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Samples that never came, in strides.
    pub missing: u64,
    /// Samples that came again.
    pub duplicate: u64,
    /// Samples that came after a newer one.
    pub late: u64,
    /// How often the counter started anew: see [`ResetKind`].
    pub reset: u64,
}

/// What a sample number means after those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observation {
    /// The newest sample so far.
    New {
        /// Samples missing between the newest before it and this one, in strides.
        missing_before: u32,
    },
    /// Older than the newest, and seen for the first time.
    Late,
    /// Seen before.
    Duplicate,
    /// The counter started anew: this is the newest sample of a new session.
    Reset(ResetKind),
}

/// Why a counter is taken to have started anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetKind {
    /// It went back further than samples can be late, or after half a second of silence: a new session, or a recording
    /// that was wound back.
    Restart,
    /// It went back a little and has gone on from there: eight known or older samples in a row, and no new one.
    Rewind,
    /// It went forward further than the time that passed explains.
    Jump,
}

impl Sequence {
    /// A sequence that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes note of a sample that was received at `now`.
    pub fn observe(&mut self, sample: u32, now: Stamp) -> Observation {
        let Some(newest) = self.newest() else {
            self.begin(&[sample], now);
            return Observation::New { missing_before: 0 };
        };
        match sample.wrapping_sub(newest) {
            step @ 1..HALF => self.forward(sample, step, now),
            _ => self.backward(sample, newest.wrapping_sub(sample), now),
        }
    }

    /// What happened so far.
    pub const fn tally(&self) -> Tally {
        self.tally
    }

    /// By how much the counter goes up from one sample to the next; `None` before the second sample.
    pub const fn stride(&self) -> Option<u32> {
        self.stride
    }

    /// The newest sample of the session.
    pub fn newest(&self) -> Option<u32> {
        self.window.back().copied()
    }

    fn forward(&mut self, sample: u32, step: u32, now: Stamp) -> Observation {
        if self.is_jump(step, now) {
            return self.reset(ResetKind::Jump, sample, now);
        }
        self.old.clear();
        self.pace.advance(step, now);
        self.push(sample);
        if self.settled {
            self.count_step(step);
        } else {
            self.learn();
        }
        Observation::New {
            missing_before: self.missing_in(step),
        }
    }

    fn push(&mut self, sample: u32) {
        let leaves = |oldest: &u32| sample.wrapping_sub(*oldest) >= HALF;
        while self.window.len() >= WINDOW || self.window.front().is_some_and(leaves) {
            self.window.pop_front();
        }
        self.window.push_back(sample);
    }

    fn backward(&mut self, sample: u32, behind: u32, now: Stamp) -> Observation {
        if self.is_too_old(behind) || behind > 0 && now.since(self.pace.newest) > SILENCE {
            return self.reset(ResetKind::Restart, sample, now);
        }
        if self.old.extend(sample, self.tally) {
            return self.rewind(now);
        }
        if let Err(place) = self.place(sample) {
            self.tally.late += 1;
            self.insert(place, sample);
            Observation::Late
        } else {
            self.tally.duplicate += 1;
            Observation::Duplicate
        }
    }

    /// Whether a step is too long to be loss: more than the time since the newest sample allows, with a wide margin.
    fn is_jump(&self, step: u32, now: Stamp) -> bool {
        let Some(stride) = self.stride else { return false };
        let strides = f64::from(step / stride);
        strides > SHORT_GAP && strides > 4.0 * self.pace.counts_until(now) / f64::from(stride) + SHORT_GAP
    }

    /// Whether a sample that far behind the newest cannot be told from a new session's.
    fn is_too_old(&self, behind: u32) -> bool {
        let (Some(oldest), Some(newest)) = (self.window.front(), self.newest()) else {
            return false;
        };
        let span = newest.wrapping_sub(*oldest);
        let slack = self.stride.unwrap_or(1).saturating_mul(32).max(WINDOW as u32);
        behind > span && (self.window.len() == WINDOW || behind > slack)
    }

    fn reset(&mut self, kind: ResetKind, sample: u32, now: Stamp) -> Observation {
        self.tally.reset += 1;
        self.begin(&[sample], now);
        Observation::Reset(kind)
    }

    /// Takes the run of old samples for the beginning of a session: none of them was late or duplicate.
    fn rewind(&mut self, now: Stamp) -> Observation {
        let OldRun { samples, before, .. } = self.old;
        self.tally = before;
        self.tally.reset += 1;
        self.begin(&samples, now);
        Observation::Reset(ResetKind::Rewind)
    }

    fn begin(&mut self, samples: &[u32], now: Stamp) {
        self.window.clear();
        self.window.extend(samples);
        self.missing_before = self.tally.missing;
        self.other_steps = EqualSteps::default();
        self.old.clear();
        self.pace.newest = now;
        self.settled = false;
        self.learn();
    }

    /// Sets the stride to the most common step of the session so far and counts its losses by it.
    fn learn(&mut self) {
        let (stride, share) = most_common_step(&self.window);
        self.stride = stride.or(self.stride);
        let missing: u64 = steps(&self.window).map(|step| u64::from(self.missing_in(step))).sum();
        self.tally.missing = self.missing_before + missing;
        let lessons = self.window.len() - 1;
        self.settled = lessons >= LONG_LESSON || lessons >= LESSON && 4 * share >= 3 * lessons;
    }

    fn count_step(&mut self, step: u32) {
        let missing = u64::from(self.missing_in(step));
        self.tally.missing += missing;
        let stride = self.stride.unwrap_or(step);
        if step == stride {
            self.other_steps = EqualSteps::default();
            return;
        }
        // Heavy loss makes several double steps in a row, but nothing makes steps too short.
        let enough = if step < stride { LESSON } else { 2 * LESSON };
        if self.other_steps.extend(step) == enough {
            self.tally.missing = self.tally.missing.saturating_sub(enough as u64 * missing);
            self.stride = Some(step);
            self.other_steps = EqualSteps::default();
        }
    }

    fn insert(&mut self, place: usize, sample: u32) {
        self.other_steps = EqualSteps::default();
        let newer = self.window[place];
        let older = place.checked_sub(1).map(|place| self.window[place]);
        self.window.insert(place, sample);
        if self.window.len() > WINDOW {
            self.window.pop_front();
        }
        if !self.settled {
            self.learn();
            return;
        }
        let count = |from: u32, to: u32| u64::from(self.missing_in(to.wrapping_sub(from)));
        let gap = older.map_or(0, |older| count(older, newer));
        let halves = older.map_or(0, |older| count(older, sample)) + count(sample, newer);
        self.tally.missing = (self.tally.missing + halves).saturating_sub(gap);
    }

    /// Where a sample that is not newer than the newest stands in the window, or would stand.
    fn place(&self, sample: u32) -> Result<usize, usize> {
        let newest = self.newest().unwrap_or(sample);
        let behind = newest.wrapping_sub(sample);
        self.window
            .binary_search_by(|seen| behind.cmp(&newest.wrapping_sub(*seen)))
    }

    /// How many samples are missing between two that are `step` apart.
    fn missing_in(&self, step: u32) -> u32 {
        self.stride.map_or(0, |stride| (step / stride).saturating_sub(1))
    }
}

fn steps(window: &VecDeque<u32>) -> impl Iterator<Item = u32> {
    window
        .iter()
        .zip(window.iter().skip(1))
        .map(|(older, newer)| newer.wrapping_sub(*older))
}

/// The most common step between the few samples of a session that has just begun, and how many steps are like it; of
/// equally common ones the smallest.
fn most_common_step(window: &VecDeque<u32>) -> (Option<u32>, usize) {
    let count = |step: u32| steps(window).filter(|other| *other == step).count();
    let most = steps(window).max_by_key(|step| (count(*step), u32::MAX - step));
    (most, most.map_or(0, count))
}

/// How many samples are remembered.
const WINDOW: usize = 256;
/// How many steps teach a stride, and how many old samples in a row make a rewind.
const LESSON: usize = 8;
/// How many steps teach a stride when fewer than three of four are equal.
const LONG_LESSON: usize = 64;
/// Strides that may be missing whatever the time says.
const SHORT_GAP: f64 = 16.0;
/// After so long nothing older is still on its way.
const SILENCE: Duration = Duration::from_millis(500);
/// Differences from here on are negative ones.
const HALF: u32 = 1 << 31;

#[cfg(test)]
mod tests {
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
    fn a_short_session_that_starts_anew_is_a_rewind() {
        let mut sequence = Sequence::new();
        let seen = observe(&mut sequence, (0..50).chain(0..20));
        assert_eq!(seen[57], Observation::Reset(ResetKind::Rewind));
        assert_eq!(sequence.tally(), tally(0, 0, 0, 1));
    }

    #[test]
    fn a_rewind_into_a_gap_gives_back_what_was_missing() {
        let mut sequence = Sequence::new();
        observe(&mut sequence, (0..20).chain(30..100).chain(20..60));
        assert_eq!(sequence.tally(), tally(10, 0, 0, 1));
        assert_eq!(sequence.newest(), Some(59));
    }

    #[test]
    fn a_jump_forward_is_a_reset_but_an_outage_is_loss() {
        let mut jump = Sequence::new();
        let seen = observe(&mut jump, (0..100).chain(5000..5010));
        assert_eq!(seen[100], Observation::Reset(ResetKind::Jump));
        assert_eq!(jump.tally(), tally(0, 0, 0, 1));

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
}
