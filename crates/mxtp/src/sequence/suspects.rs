//! Samples that may be the beginning of another session.

use super::{HALF, LESSON, Tally};

/// Samples that the session cannot go on with, near each other and in increasing order.
///
/// What the session can still expect late, or has had already, is *at home* in it: of such samples one new sample of the
/// session is enough to show that they are no other. A restart whose numbers are far away may mix with what is left on
/// its way of the session, so that it takes more.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Suspects {
    samples: [u32; LESSON],
    count: usize,
    at_home: bool,
    /// How many samples spoke against them.
    contradictions: usize,
    /// What they were counted as for the time being.
    counted: Tally,
    /// How many samples less were missing for the time being.
    found: i64,
    /// The only one before there was another far from it, which may be none of its session.
    lone: Option<Lone>,
}

/// A suspect that is alone.
#[derive(Clone, Copy, Debug)]
struct Lone {
    sample: u32,
    counted: Tally,
    found: i64,
}

impl Suspects {
    pub(super) fn of(sample: u32, at_home: bool) -> Self {
        let mut suspects = Self {
            at_home,
            ..Self::default()
        };
        suspects.insert(0, sample);
        suspects
    }

    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Their numbers in increasing order, each once.
    pub(super) fn samples(&self) -> &[u32] {
        &self.samples[..self.count]
    }

    /// Whether a sample may yet turn out to begin a session.
    pub(super) fn hold(&self, sample: u32) -> bool {
        self.samples().contains(&sample) || self.lone.is_some_and(|lone| lone.sample == sample)
    }

    pub(super) const fn are_enough(&self) -> bool {
        self.count == LESSON
    }

    /// Whether they are not at home in the session.
    pub(super) const fn are_far(&self) -> bool {
        self.count > 0 && !self.at_home
    }

    pub(super) const fn are_contradicted(&self) -> bool {
        self.contradictions > 0
    }

    /// Adds a sample, or begins with it anew where it tells more; says whether it is one more.
    pub(super) fn add(&mut self, sample: u32, at_home: bool, stride: u32) -> bool {
        if self.hold(sample) {
            return false;
        }
        if self.place(sample, stride).is_none() {
            self.turn_to_lone(sample, stride);
        }
        if let Some(place) = self.place(sample, stride) {
            self.insert(place, sample);
            return true;
        }
        let begins = match (self.at_home, at_home) {
            _ if self.count == 0 => true,
            (true, true) => true,
            (false, true) => false,
            (_, false) => self.count == 1 || self.contradict(),
        };
        if begins {
            let lone = self.lone().filter(|_| !at_home);
            *self = Self {
                lone,
                ..Self::of(sample, at_home)
            };
        }
        begins
    }

    /// Takes note that the session goes on.
    pub(super) fn note_new(&mut self) {
        if self.count > 0 && (self.at_home || self.contradict()) {
            self.clear();
        }
    }

    /// Whether a sample goes on with them that is newer than all of them.
    pub(super) fn lead_to(&self, sample: u32, stride: u32) -> bool {
        let step = self.samples().last().map(|last| sample.wrapping_sub(*last));
        step.is_some_and(|step| step > 0 && step <= stride.saturating_mul(AHEAD).min(HALF - 1))
    }

    /// Takes note of what the latest of them was counted as: the difference of two tallies.
    pub(super) fn note_counted(&mut self, before: Tally, after: Tally) {
        self.counted.duplicate += after.duplicate - before.duplicate;
        self.counted.late += after.late - before.late;
        self.found += before.missing.cast_signed() - after.missing.cast_signed();
    }

    /// The tally as it is when they are no part of the session.
    pub(super) fn taken_out_of(&self, tally: Tally) -> Tally {
        Tally {
            duplicate: tally.duplicate.saturating_sub(self.counted.duplicate),
            late: tally.late.saturating_sub(self.counted.late),
            missing: tally.missing.saturating_add_signed(self.found),
            ..tally
        }
    }

    /// Where a sample belongs that is near the newest of them.
    fn place(&self, sample: u32, stride: u32) -> Option<usize> {
        let last = *self.samples().last()?;
        let behind = last.wrapping_sub(sample);
        if self.lead_to(sample, stride) {
            Some(self.count)
        } else if behind <= stride.saturating_mul(BEHIND).min(HALF - 1) {
            let is_older = |other: &&u32| last.wrapping_sub(**other) > behind && last.wrapping_sub(**other) < HALF;
            Some(self.samples().iter().filter(is_older).count())
        } else {
            None
        }
    }

    /// Goes back to the lone one when a sample is near that.
    fn turn_to_lone(&mut self, sample: u32, stride: u32) {
        let Some(lone) = self.lone.filter(|_| self.count == 1) else {
            return;
        };
        let alone = Self {
            counted: lone.counted,
            found: lone.found,
            ..Self::of(lone.sample, false)
        };
        if alone.place(sample, stride).is_some() {
            *self = alone;
        }
    }

    fn lone(&self) -> Option<Lone> {
        let is_one = self.count == 1 && !self.at_home;
        is_one.then(|| Lone {
            sample: self.samples[0],
            counted: self.counted,
            found: self.found,
        })
    }

    fn insert(&mut self, place: usize, sample: u32) {
        self.samples.copy_within(place..self.count.min(LESSON - 1), place + 1);
        self.samples[place] = sample;
        self.count += 1;
    }

    /// True when it is too much.
    const fn contradict(&mut self) -> bool {
        self.contradictions += 1;
        self.contradictions == CONTRADICTIONS
    }
}

/// How many strides may lie between two of them.
const AHEAD: u32 = 16;
/// How many strides a sample may come after the newest of them.
const BEHIND: u32 = 2;
/// How many samples that speak against them are too many.
const CONTRADICTIONS: usize = 6;
