//! Samples that are complete and wait for an older one.

use super::Character;
use crate::assembler::Event;
use crate::assembler::events::Events;

impl Character {
    /// Gives the newest sample that is complete and cannot be closed yet, unless that has been done.
    ///
    /// It stays open, and its frame is shared with the one that closing it gives: what still changes it makes a copy, and the
    /// changed one is given again.
    pub(in crate::assembler) fn give_ahead(&mut self, events: &mut Events) {
        if self.open.len() < 2 || self.expected.is_empty() {
            return;
        }
        let newest = self
            .open
            .iter()
            .rposition(|sample| sample.is_given() || self.is_complete(sample));
        let Some(place) = newest.filter(|place| self.is_complete(&self.open[*place])) else {
            return;
        };
        if let Some(frame) = self.open[place].give(self.description.subject()) {
            events.push(Event::Ahead(frame));
        }
    }
}
