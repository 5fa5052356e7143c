//! Events on their way out.

use super::Event;
use std::collections::VecDeque;

/// A queue that loses its oldest events when nobody takes them, and counts them.
#[derive(Debug, Default)]
pub(super) struct Events {
    queue: VecDeque<Event>,
    dropped: u64,
}

impl Events {
    pub(super) fn push(&mut self, event: Event) {
        if self.queue.len() == MAX_EVENTS {
            self.queue.pop_front();
            self.dropped += 1;
        }
        self.queue.push_back(event);
    }

    pub(super) fn pop(&mut self) -> Option<Event> {
        self.queue.pop_front()
    }

    pub(super) const fn dropped(&self) -> u64 {
        self.dropped
    }
}

/// More than one call can bring: every open sample of every character, and then some.
const MAX_EVENTS: usize = 1024;
