//! The sample counter of one stream: what is missing, late, duplicate, and when it starts anew.

mod before;
mod pace;
mod runs;
mod window;

use before::{Before, Straggler};
use pace::Pace;
use posewire_motion::Stamp;
use runs::{EqualSteps, OldRun};
use std::cmp::Ordering;
use std::time::Duration;
use window::{Window, found_by, missing_in};

/// Follows the sample counter of one message type of one character (MV0305 2.4.1.2).
///
/// The counter runs at the sampling rate, and a sender may stream less often: then it goes up by a constant *stride*,
/// which is learnt from the first eight steps (or more, when they disagree) and again when eight shorter or sixteen
/// longer equal steps come in a row. Losses are counted in strides. A counter that wraps around goes on; one that goes
/// back, or forward further than the time that passed explains, begins a new session, and what lies between is no loss.
///
/// What is missing depends on the set of samples that came and not on their order: a sample that comes late is no
/// longer missing. That holds for half a second across the beginning of a session too.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    window: Window,
    tally: Tally,
    stride: Option<u32>,
    /// Whether the stride still follows every step of a session that has just begun.
    settled: bool,
    /// Samples that were missing when the session began.
    missing_before: u64,
    other_steps: EqualSteps,
    old: OldRun,
    pace: Pace,
    before: Option<Box<Before>>,
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
    /// How often the counter started anew: [`ResetKind::Restart`].
    pub reset: u64,
    /// How often the counter was wound back: [`ResetKind::Rewind`].
    pub rewound: u64,
    /// How often the counter jumped ahead: [`ResetKind::Jump`].
    pub jumped: u64,
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
    /// Of the session before, and seen for the first time: late.
    Straggler,
    /// A new session: this is its newest sample.
    Reset(ResetKind),
}

/// How a session began that is not the first.
///
/// A counter is taken to have gone back when it did so further than samples can be late, when it did after half a second
/// of silence, or when eight known or older samples came in a row and no new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetKind {
    /// The counter went back to where it can have come from 0 since the newest sample: a new session of the sender.
    Restart,
    /// The counter went back, but not to its beginning: a recording that was wound back.
    Rewind,
    /// The counter went forward further than the time that passed explains.
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
        self.window.newest()
    }

    fn forward(&mut self, sample: u32, step: u32, now: Stamp) -> Observation {
        if self.is_jump(step, now) {
            let straggler = self.straggler(sample, now);
            return straggler.unwrap_or_else(|| self.reset(ResetKind::Jump, sample, now));
        }
        self.old.clear();
        self.pace.advance(step, now);
        self.window.push(sample);
        if self.settled {
            self.count_step(step);
        } else {
            self.learn();
        }
        Observation::New {
            missing_before: missing_in(step, self.stride),
        }
    }

    fn backward(&mut self, sample: u32, behind: u32, now: Stamp) -> Observation {
        if self.is_too_old(behind) || behind > 0 && now.since(self.pace.newest) > SILENCE {
            let straggler = self.straggler(sample, now);
            return straggler.unwrap_or_else(|| self.reset(self.kind_of_return(sample, now), sample, now));
        }
        if self.old.extend(sample, self.tally) {
            return self.take_over_run(now);
        }
        if let Some(neighbours) = self.window.insert(sample) {
            self.tally.late += 1;
            self.count_inserted(sample, neighbours);
            Observation::Late
        } else {
            self.tally.duplicate += 1;
            Observation::Duplicate
        }
    }

    /// Takes a sample for one of the session before, if it can be. Eight of them in a row are not, nor three that go on
    /// from it: then it was this session that was none.
    fn straggler(&mut self, sample: u32, now: Stamp) -> Option<Observation> {
        let before = self.before.as_mut()?;
        let tally = self.tally;
        let straggler = before.take(sample, now)?;
        let continued = before.continued();
        if self.old.extend(sample, tally) || continued.min(self.old.samples().len()) >= RESUMED {
            return Some(self.take_over_run(now));
        }
        Some(match straggler {
            Straggler::Again => {
                self.tally.duplicate += 1;
                Observation::Duplicate
            }
            Straggler::Found(found) => {
                self.tally.late += 1;
                self.tally.missing = self.tally.missing.saturating_add_signed(-found);
                self.missing_before = self.missing_before.saturating_add_signed(-found);
                Observation::Straggler
            }
        })
    }

    /// What a counter does that goes back to `sample`.
    fn kind_of_return(&self, sample: u32, now: Stamp) -> ResetKind {
        let reach = self.pace.counts_until(now) + SHORT_GAP * f64::from(self.stride.unwrap_or(1));
        if f64::from(sample) <= reach {
            ResetKind::Restart
        } else {
            ResetKind::Rewind
        }
    }

    /// Whether a step is too long to be loss: more than the time since the newest sample allows, with a wide margin.
    fn is_jump(&self, step: u32, now: Stamp) -> bool {
        let Some(stride) = self.stride else { return false };
        let strides = f64::from(step / stride);
        strides > 4.0 * self.pace.counts_until(now) / f64::from(stride) + SHORT_GAP
    }

    /// Whether a sample that far behind the newest cannot be told from a new session's.
    fn is_too_old(&self, behind: u32) -> bool {
        let (Some(oldest), Some(newest)) = (self.window.oldest(), self.newest()) else {
            return false;
        };
        let span = newest.wrapping_sub(oldest);
        let slack = self.stride.unwrap_or(1).saturating_mul(32).max(Window::SIZE as u32);
        behind > span && (self.window.is_full() || behind > slack)
    }

    fn reset(&mut self, kind: ResetKind, sample: u32, now: Stamp) -> Observation {
        self.count_session(kind);
        self.begin(&[sample], now);
        Observation::Reset(kind)
    }

    /// Takes the run of old samples for the beginning of a session.
    fn take_over_run(&mut self, now: Stamp) -> Observation {
        let run = self.old;
        let latest = run.samples().last().copied().unwrap_or_default();
        let kind = match latest.wrapping_sub(self.newest().unwrap_or(latest)) {
            1..HALF => ResetKind::Jump,
            _ => self.kind_of_return(latest, now),
        };
        self.tally = run.tally();
        self.count_session(kind);
        self.begin(run.samples(), now);
        Observation::Reset(kind)
    }

    fn count_session(&mut self, kind: ResetKind) {
        match kind {
            ResetKind::Restart => self.tally.reset += 1,
            ResetKind::Rewind => self.tally.rewound += 1,
            ResetKind::Jump => self.tally.jumped += 1,
        }
    }

    fn begin(&mut self, samples: &[u32], now: Stamp) {
        let ended = std::mem::take(&mut self.window);
        self.before = (ended.newest().is_some()).then(|| Box::new(Before::new(ended, self.stride, now)));
        self.window.restart(samples);
        self.missing_before = self.tally.missing;
        self.other_steps = EqualSteps::default();
        self.old.clear();
        self.pace.newest = now;
        self.settled = false;
        self.learn();
    }

    /// Sets the stride to the most common step of the session so far and counts its losses by it.
    fn learn(&mut self) {
        let (stride, share) = self.window.most_common_step();
        self.stride = stride.or(self.stride);
        let missing = self.window.steps().map(|step| u64::from(missing_in(step, self.stride)));
        self.tally.missing = self.missing_before + missing.sum::<u64>();
        let lessons = self.window.steps().count();
        self.settled = lessons >= LONG_LESSON || lessons >= LESSON && 4 * share >= 3 * lessons;
    }

    fn count_step(&mut self, step: u32) {
        let missing = u64::from(missing_in(step, self.stride));
        self.tally.missing += missing;
        // Heavy loss makes several double steps in a row, but nothing makes steps too short.
        let enough = match step.cmp(&self.stride.unwrap_or(step)) {
            Ordering::Less => LESSON,
            Ordering::Equal => {
                self.other_steps = EqualSteps::default();
                return;
            }
            Ordering::Greater => 2 * LESSON,
        };
        if self.other_steps.extend(step) == enough {
            self.tally.missing = self.tally.missing.saturating_sub(enough as u64 * missing);
            self.stride = Some(step);
            self.other_steps = EqualSteps::default();
        }
    }

    fn count_inserted(&mut self, sample: u32, neighbours: (Option<u32>, u32)) {
        self.other_steps = EqualSteps::default();
        if !self.settled {
            self.learn();
            return;
        }
        let found = found_by(sample, neighbours, self.stride);
        self.tally.missing = self.tally.missing.saturating_add_signed(-found);
    }
}

/// How many steps teach a stride, and how many old samples in a row make a rewind.
const LESSON: usize = 8;
/// How many steps teach a stride when fewer than three of four are equal.
const LONG_LESSON: usize = 64;
/// How many samples in a row show that the session before goes on.
const RESUMED: usize = 3;
/// Strides that may be missing whatever the time says.
const SHORT_GAP: f64 = 16.0;
/// After so long nothing older is still on its way.
const SILENCE: Duration = Duration::from_millis(500);
/// Differences from here on are negative ones.
const HALF: u32 = 1 << 31;

#[cfg(test)]
mod tests;
