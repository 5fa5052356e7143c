//! The built-in walker as a source.

use super::playback::Frames;
use super::synthetic::Walk;
use crate::Result;
use crate::endpoint;
use posewire_motion::Frame;

/// People who walk for ever, sample after sample.
#[derive(Debug)]
pub(super) struct Walkers {
    walk: Walk,
    next: u32,
}

impl Walkers {
    pub(super) fn new(walk: &endpoint::Walk) -> Self {
        Self {
            walk: Walk::new(&walk.into()),
            next: 0,
        }
    }
}

impl Frames for Walkers {
    fn name(&self) -> String {
        "synthetic:walk".to_owned()
    }

    fn rate_hz(&self) -> f64 {
        self.walk.rate()
    }

    fn next_sample(&mut self, frames: &mut Vec<Frame>) -> Result<bool> {
        let people = 0..self.walk.subjects().len();
        frames.extend(people.map(|person| self.walk.frame(person, self.next)));
        self.next = self.next.wrapping_add(1);
        Ok(true)
    }

    fn rewind(&mut self) -> Result<()> {
        self.next = 0;
        Ok(())
    }

    fn skip_to(&mut self, sample: u32) {
        self.next = sample;
    }
}
