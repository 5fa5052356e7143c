//! The numbers of a sender that begins anew, winds back or has a clock that drifts.

use super::outgoing::Outgoing;
use super::{FaultKind, FaultPlan, FaultedStream};
use std::collections::BTreeMap;
use std::time::Duration;

/// How the numbers of one character differ from those that it was given.
#[derive(Debug, Default)]
pub(super) struct Numbering {
    /// The time and number of its first sample.
    first: Option<(Duration, u32)>,
    latest: Option<u32>,
    /// What is taken off the sample counter and the time, modulo 2^32.
    samples_off: u32,
    milliseconds_off: u32,
    /// Since when, in the order of the plan, events have been acted on.
    resets_done: usize,
    rewinds_done: usize,
    events: Vec<FaultKind>,
    /// How many of the events each stream has shown.
    shown: BTreeMap<FaultedStream, usize>,
}

impl Numbering {
    /// Acts on the events of the plan that are due. They happen between two samples.
    pub(super) fn follow(&mut self, plan: &FaultPlan, now: Duration, sample: u32, time_ms: Option<u32>) {
        let first = *self.first.get_or_insert((now, sample));
        if self.latest.replace(sample) == Some(sample) {
            return;
        }
        while plan
            .rewinds
            .get(self.rewinds_done)
            .is_some_and(|rewind| rewind.at <= now)
        {
            let back = plan.rewinds[self.rewinds_done].back;
            self.rewinds_done += 1;
            self.rewind(back, samples_in(back, first, (now, sample)), sample, time_ms);
        }
        while plan.resets.get(self.resets_done).is_some_and(|at| *at <= now) {
            self.resets_done += 1;
            self.samples_off = sample;
            self.milliseconds_off = time_ms.unwrap_or(0);
            self.events.push(FaultKind::Reset);
        }
    }

    /// The events that this stream has not shown yet.
    pub(super) fn unseen(&mut self, stream: FaultedStream) -> Vec<FaultKind> {
        let known = self.events.len();
        // A stream that begins later shows nothing of what was before.
        let shown = self.shown.insert(stream, known).unwrap_or(known);
        self.events[shown..].to_vec()
    }

    /// Gives a datagram its new numbers; true when its time is another by the drift of the clock.
    pub(super) fn renumber(&self, plan: &FaultPlan, outgoing: &mut Outgoing) -> bool {
        let Some(sample) = outgoing.sample() else { return false };
        let time_ms = outgoing.time_ms().map(|time| time.wrapping_sub(self.milliseconds_off));
        let drifted = time_ms.map(|time| drifted(time, plan.drift_ppm));
        if self.events.is_empty() && drifted == time_ms {
            return false;
        }
        outgoing.set(sample.wrapping_sub(self.samples_off), drifted);
        drifted != time_ms
    }

    /// Goes back by so much, at most to 0.
    fn rewind(&mut self, back: Duration, samples: u32, sample: u32, time_ms: Option<u32>) {
        let counter = sample.wrapping_sub(self.samples_off);
        let clock = time_ms.map_or(0, |time| time.wrapping_sub(self.milliseconds_off));
        self.samples_off = self.samples_off.wrapping_add(samples.min(counter));
        self.milliseconds_off = self.milliseconds_off.wrapping_add(milliseconds(back).min(clock));
        self.events.push(FaultKind::Rewind);
    }
}

/// How far the counter goes in a time, by how far it has gone since the first sample.
fn samples_in(time: Duration, first: (Duration, u32), latest: (Duration, u32)) -> u32 {
    let elapsed = latest.0.saturating_sub(first.0).as_secs_f64();
    if elapsed <= 0.0 {
        return 0;
    }
    let per_second = f64::from(latest.1.wrapping_sub(first.1)) / elapsed;
    (per_second * time.as_secs_f64()).round() as u32
}

fn drifted(time_ms: u32, ppm: f64) -> u32 {
    (f64::from(time_ms) * (1.0 + ppm / 1e6)).round() as u32
}

fn milliseconds(duration: Duration) -> u32 {
    u32::try_from(duration.as_millis()).unwrap_or(u32::MAX)
}
