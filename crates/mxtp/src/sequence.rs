//! The sample counter of one stream: what is missing, late, duplicate, and when it starts anew.

mod before;
mod pace;
mod runs;
mod suspects;
mod window;

use before::{Before, Straggler};
use pace::Pace;
use posewire_motion::Stamp;
use runs::EqualSteps;
use std::cmp::Ordering;
use std::time::Duration;
use suspects::Suspects;
use window::{Window, found_by, missing_in};

/// Follows the sample counter of one message type of one character (MV0305 2.4.1.2).
///
/// The counter runs at the sampling rate, and a sender may stream less often: then it goes up by a constant *stride*,
/// which is learnt from the first eight steps (or more, when they disagree) and again when eight shorter or sixteen
/// longer equal steps come in a row. Losses are counted in strides. A counter that wraps around goes on; one that goes
/// back, or forward further than the time that passed explains, begins a new session, and what lies between is no loss.
///
/// One sample that does not fit changes nothing: a session begins with eight that fit each other, and then with the first
/// of them. Until they are eight, each is counted as what it is if the session goes on.
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
    suspects: Suspects,
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
    /// Of no session that is known: late, unless seven others show that it began one.
    Stray,
    /// A new session, of which this and those before it are that were taken for something else.
    Reset(ResetKind),
}

/// How a session began that is not the first.
///
/// A counter is taken to have gone back when it did after half a second of silence, or when eight samples came in a row
/// that are known, older or too far away, and no new one (where they are too far away to be late, five new ones at most).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetKind {
    /// The counter went back to where it can have come from 0 since the newest sample: a new session of the sender.
    Restart,
    /// The counter went back, but not to its beginning: a recording that was wound back.
    Rewind,
    /// The counter went forward further than the time that passed explains.
    Jump,
}

/// Where a sample belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Home {
    /// In the session that goes on, be it new, late or known.
    Session,
    /// In the session before.
    Before,
    /// In neither.
    Nowhere,
}

impl Sequence {
    /// A sequence that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes note of a sample that was received at `now`.
    pub fn observe(&mut self, sample: u32, now: Stamp) -> Observation {
        self.judge(sample, now).0
    }

    /// Takes note of a sample that was received at `now`, and says where it belongs.
    pub(crate) fn judge(&mut self, sample: u32, now: Stamp) -> (Observation, Home) {
        let Some(newest) = self.newest() else {
            return (self.forward(sample, 0, now), Home::Session);
        };
        let (step, behind) = (sample.wrapping_sub(newest), newest.wrapping_sub(sample));
        let silent = now.since(self.pace.newest) > SILENCE;
        match step {
            1..HALF if self.is_jump(step, now) || self.goes_on_ahead(sample) => self.suspect(sample, now),
            1..HALF => (self.forward(sample, step, now), Home::Session),
            _ if behind > 0 && silent => (self.begin_after_silence(sample, now), Home::Session),
            _ if self.is_too_old(behind) || self.goes_on_far_back(sample) => self.suspect(sample, now),
            _ => (self.known(sample, now), Home::Session),
        }
    }

    /// Takes note of a sample of which is known where it belongs.
    pub(crate) fn follow(&mut self, sample: u32, now: Stamp, home: Home) -> Observation {
        match (home, self.newest()) {
            (Home::Session, Some(newest)) => match sample.wrapping_sub(newest) {
                step @ 1..HALF => self.forward(sample, step, now),
                _ => self.backward(sample),
            },
            (Home::Session, None) => self.forward(sample, 0, now),
            (Home::Before, _) => self.straggler(sample, now).unwrap_or_else(|| self.stray()),
            (Home::Nowhere, _) => self.stray(),
        }
    }

    /// Begins a session with a sample that was received at `now`.
    pub(crate) fn restart(&mut self, kind: ResetKind, sample: u32, now: Stamp) {
        self.count_session(kind);
        self.begin(&[sample], now);
    }

    /// Whether a sample is one of those that may have begun another session.
    pub(crate) fn suspects(&self, sample: u32) -> bool {
        self.suspects.hold(sample)
    }

    /// Whether a sample is remembered as one of this session.
    pub(crate) fn remembers(&self, sample: u32) -> bool {
        self.window.contains(sample)
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
        if self.newest().is_none() {
            self.begin(&[sample], now);
            return Observation::New { missing_before: 0 };
        }
        self.suspects.note_new();
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

    fn backward(&mut self, sample: u32) -> Observation {
        if let Some(neighbours) = self.window.insert(sample) {
            self.tally.late += 1;
            self.count_inserted(sample, neighbours);
            Observation::Late
        } else {
            self.tally.duplicate += 1;
            Observation::Duplicate
        }
    }

    /// Takes a sample for one of the session before, if it can be.
    fn straggler(&mut self, sample: u32, now: Stamp) -> Option<Observation> {
        Some(match self.before.as_mut()?.take(sample, now)? {
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

    const fn stray(&mut self) -> Observation {
        self.tally.late += 1;
        Observation::Stray
    }

    /// Takes a sample that came already, or late, for what it seems to be, unless there are eight of them.
    fn known(&mut self, sample: u32, now: Stamp) -> Observation {
        let before = self.tally;
        let observation = self.backward(sample);
        self.note_suspect(sample, true, before);
        if self.suspects.are_enough() {
            return self.take_over(sample, now);
        }
        observation
    }

    /// Takes a sample that cannot be one of this session for one of the session before or a stray. Eight of them are a
    /// session, and three that go on from the one before: then it was this session that was none.
    fn suspect(&mut self, sample: u32, now: Stamp) -> (Observation, Home) {
        let before = self.tally;
        let (observation, home) = match self.straggler(sample, now) {
            Some(observation) => (observation, Home::Before),
            None => (self.stray(), Home::Nowhere),
        };
        self.note_suspect(sample, false, before);
        if self.suspects.are_enough() || self.has_resumed() {
            return (self.take_over(sample, now), Home::Session);
        }
        (observation, home)
    }

    fn note_suspect(&mut self, sample: u32, at_home: bool, before: Tally) {
        if self.suspects.add(sample, at_home, self.stride.unwrap_or(1)) {
            self.suspects.note_counted(before, self.tally);
        }
    }

    /// Whether the session before goes on, and this one does not.
    fn has_resumed(&self) -> bool {
        let continued = self.before.as_ref().map_or(0, |before| before.continued());
        continued.min(self.suspects.samples().len()) >= RESUMED && !self.suspects.are_contradicted()
    }

    /// Whether a sample goes on with suspects that are newer than the session.
    fn goes_on_ahead(&self, sample: u32) -> bool {
        let (Some(last), Some(newest)) = (self.suspects.samples().last(), self.newest()) else {
            return false;
        };
        matches!(last.wrapping_sub(newest), 1..HALF) && self.suspects.lead_to(sample, self.stride.unwrap_or(1))
    }

    /// Whether a sample that could be late goes on with suspects that cannot: it is to come after them.
    fn goes_on_far_back(&self, sample: u32) -> bool {
        self.suspects.are_far() && self.suspects.lead_to(sample, self.stride.unwrap_or(1)) && !self.remembers(sample)
    }

    /// After a silence what goes back needs no others. Those right before it are its own all the same.
    fn begin_after_silence(&mut self, sample: u32, now: Stamp) -> Observation {
        let follows = |last: &u32| sample.wrapping_sub(*last) == self.stride.unwrap_or(1);
        if !self.suspects.samples().last().is_some_and(follows) {
            self.suspects = Suspects::of(sample, false);
        }
        self.take_over(sample, now)
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

    /// Takes the suspects for the beginning of a session, `sample` the latest of them.
    fn take_over(&mut self, sample: u32, now: Stamp) -> Observation {
        let mut run = self.suspects;
        run.add(sample, false, self.stride.unwrap_or(1));
        let latest = run.samples().last().copied().unwrap_or(sample);
        let first = run.samples().first().copied().unwrap_or(sample);
        let kind = match first.wrapping_sub(self.newest().unwrap_or(first)) {
            1..HALF => ResetKind::Jump,
            _ => self.kind_of_return(latest, now),
        };
        self.tally = run.taken_out_of(self.tally);
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
        self.suspects.clear();
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

/// How many steps teach a stride, and how many samples make a session.
const LESSON: usize = 8;
/// How many steps teach a stride when fewer than three of four are equal.
const LONG_LESSON: usize = 64;
/// How many samples in a row show that the session before goes on, or that a short one begins again.
const RESUMED: usize = 3;
/// Strides that may be missing whatever the time says.
const SHORT_GAP: f64 = 16.0;
/// After so long nothing older is still on its way.
const SILENCE: Duration = Duration::from_millis(500);
/// Differences from here on are negative ones.
const HALF: u32 = 1 << 31;

#[cfg(test)]
mod tests;
