//! Datagrams that have to wait: for a time, or to be overtaken.

use super::outgoing::Outgoing;
use std::collections::BTreeMap;
use std::time::Duration;

/// Datagrams that leave at a time, and at the same time in their order.
#[derive(Debug, Default)]
pub(super) struct Delayed {
    queue: BTreeMap<(Duration, u64), Outgoing>,
    count: u64,
}

impl Delayed {
    /// Adds one. When there is no room, the one that would have left first is given back to leave now.
    pub(super) fn push(&mut self, due: Duration, outgoing: Outgoing) -> Option<Outgoing> {
        self.queue.insert((due, self.count), outgoing);
        self.count += 1;
        if self.queue.len() > MAX_WAITING {
            return self.queue.pop_first().map(|(_, outgoing)| outgoing);
        }
        None
    }

    /// The next one that is due by `now`.
    pub(super) fn pop_due(&mut self, now: Duration) -> Option<Outgoing> {
        let first = self.queue.first_entry()?;
        (first.key().0 <= now).then(|| first.remove())
    }

    pub(super) fn first_due(&self) -> Option<Duration> {
        self.queue.first_key_value().map(|((due, _), _)| *due)
    }
}

/// Datagrams that leave after later ones of their streams, the oldest first.
#[derive(Debug, Default)]
pub(super) struct Held(Vec<Waiting>);

#[derive(Debug)]
struct Waiting {
    outgoing: Outgoing,
    /// How many have yet to overtake it.
    overtakers: u32,
    overtaken: bool,
}

impl Held {
    /// Adds one. When there is no room it is given back.
    pub(super) fn push(&mut self, outgoing: Outgoing, overtakers: u32) -> Option<Outgoing> {
        if self.0.len() >= MAX_WAITING {
            return Some(outgoing);
        }
        self.0.push(Waiting {
            outgoing,
            overtakers,
            overtaken: false,
        });
        None
    }

    /// Those that `leaving` is the last to overtake. Parts of one sample do not overtake each other, and what is damaged
    /// overtakes nothing, as nobody may see that it did.
    pub(super) fn overtaken_by(&mut self, leaving: &Outgoing) -> Vec<Outgoing> {
        if leaving.damaged {
            return Vec::new();
        }
        let overtakes = |waiting: &Waiting| {
            let held = &waiting.outgoing;
            held.stream == leaving.stream && (held.sample().is_none() || held.sample() != leaving.sample())
        };
        for waiting in self.0.iter_mut().filter(|waiting| overtakes(waiting)) {
            waiting.overtakers -= 1;
            waiting.overtaken = true;
        }
        let done = self.0.extract_if(.., |waiting| waiting.overtakers == 0);
        done.map(|waiting| waiting.outgoing).collect()
    }

    /// All that still wait, and whether anything has overtaken them.
    pub(super) fn drain(&mut self) -> Vec<(Outgoing, bool)> {
        let all = self.0.drain(..);
        all.map(|waiting| (waiting.outgoing, waiting.overtaken)).collect()
    }
}

const MAX_WAITING: usize = 4096;
