//! The session before this one, of which something may still be on its way.

use super::window::{Window, found_by, missing_in};
use super::{HALF, SHORT_GAP, SILENCE};
use posewire_motion::Stamp;

/// The session before this one.
#[derive(Clone, Debug)]
pub(super) struct Before {
    window: Window,
    stride: Option<u32>,
    ended: Stamp,
    /// How many samples in a row have gone on from it.
    continued: usize,
}

/// What a sample of the session before changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Straggler {
    /// It had come already.
    Again,
    /// It is new, and so many samples fewer are missing.
    Found(i64),
}

impl Before {
    pub(super) const fn new(window: Window, stride: Option<u32>, ended: Stamp) -> Self {
        Self {
            window,
            stride,
            ended,
            continued: 0,
        }
    }

    /// How many samples in a row have gone on from it: more than a few, and it has not ended.
    pub(super) const fn continued(&self) -> usize {
        self.continued
    }

    /// Takes note of a sample that can be one of this session's: one that it had, lacked, or was to have next.
    pub(super) fn take(&mut self, sample: u32, now: Stamp) -> Option<Straggler> {
        let (oldest, newest) = (self.window.oldest()?, self.window.newest()?);
        if now.since(self.ended) > SILENCE {
            return None;
        }
        let step = sample.wrapping_sub(newest);
        if matches!(step, 1..HALF) {
            return self.go_on(sample, step);
        }
        if step != 0 {
            self.continued = 0;
        }
        if newest.wrapping_sub(sample) > newest.wrapping_sub(oldest) {
            return None;
        }
        let neighbours = self.window.insert(sample);
        Some(neighbours.map_or(Straggler::Again, |neighbours| {
            Straggler::Found(found_by(sample, neighbours, self.stride))
        }))
    }

    fn go_on(&mut self, sample: u32, step: u32) -> Option<Straggler> {
        let strides = f64::from(step / self.stride.unwrap_or(1));
        if strides > SHORT_GAP {
            return None;
        }
        self.continued += 1;
        self.window.push(sample);
        Some(Straggler::Found(-i64::from(missing_in(step, self.stride))))
    }
}
