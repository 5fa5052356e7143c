//! From datagrams to items, for UDP and TCP alike.

use crate::clock::Clock;
use crate::session::Outlet;
use crate::stats::{Edge, Tally};
use crate::{Item, Notice};
use posewire_motion::Stamp;
use posewire_mxtp::{Assembler, Event};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Assembles what arrives, counts it, and hands it on.
pub(super) struct Intake<'a> {
    assembler: Assembler,
    tally: Tally,
    clock: Clock,
    next_report: Instant,
    outlet: &'a mut Outlet,
}

impl<'a> Intake<'a> {
    pub(super) fn new(outlet: &'a mut Outlet) -> Self {
        let clock = Clock::new();
        Self {
            assembler: Assembler::new(),
            tally: Tally::new(clock.now()),
            next_report: Instant::now() + REPORT_EVERY,
            clock,
            outlet,
        }
    }

    /// Takes one datagram as it arrived.
    pub(super) fn datagram(&mut self, at: Stamp, bytes: &[u8]) {
        self.tally.datagram(bytes.len());
        self.assembler.handle(at, bytes);
        self.forward(at);
    }

    /// Tells the sinks something about the connection.
    pub(super) fn notice(&mut self, notice: Notice) {
        self.outlet.push(Item::Notice(notice));
    }

    /// To be called after each batch and at least every [`TICK`]: closes what waited too long, reports once a second
    /// and hands everything to the sinks. `false` when no sink is left.
    pub(super) fn tick(&mut self, kernel_dropped: u64, skipped_bytes: u64) -> bool {
        let now = self.clock.now();
        if self.assembler.timeout().is_some_and(|due| due <= now) {
            self.assembler.handle_timeout(now);
            self.forward(now);
        }
        let instant = Instant::now();
        if instant >= self.next_report {
            self.next_report = report_after(self.next_report, instant);
            self.report(
                Edge {
                    now,
                    kernel_dropped,
                    skipped_bytes,
                },
                false,
            );
        }
        self.outlet.flush()
    }

    /// The end of the stream: closes what is open and gives the last numbers.
    pub(super) fn finish(mut self, kernel_dropped: u64, skipped_bytes: u64) {
        let now = self.clock.now();
        self.assembler.finish();
        self.forward(now);
        self.report(
            Edge {
                now,
                kernel_dropped,
                skipped_bytes,
            },
            true,
        );
        self.outlet.finish();
    }

    fn report(&mut self, edge: Edge, ended: bool) {
        let statistics = self.tally.report(&self.assembler, &edge, ended);
        self.outlet.push(Item::Statistics(Arc::new(statistics)));
    }

    fn forward(&mut self, at: Stamp) {
        while let Some(event) = self.assembler.poll() {
            match event {
                Event::Subject(subject) => {
                    self.tally.subject(&subject);
                    self.outlet.push(Item::Subject(subject));
                }
                Event::Frame(frame) => {
                    self.tally.timecode(&frame.subject, frame.timecode);
                    self.outlet.push(Item::Frame { frame, due: None });
                }
                Event::Message {
                    character,
                    message_type,
                    ..
                } => self.tally.message(character, message_type, at),
                Event::Malformed { error, .. } => self.tally.malformed(error.to_string()),
                _ => {}
            }
        }
    }
}

/// When the next report is due after one that was due and is given now. Those missed in a stall are left out.
fn report_after(due: Instant, now: Instant) -> Instant {
    let next = due + REPORT_EVERY;
    if next > now { next } else { now + REPORT_EVERY }
}

/// The longest that a source waits before it looks at the clock.
pub(super) const TICK: Duration = Duration::from_millis(20);
/// How long a source goes on at the stop with what has arrived by then.
pub(super) const DRAIN_LIMIT: Duration = Duration::from_millis(100);
const REPORT_EVERY: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_missed_in_a_stall_are_left_out() {
        let due = Instant::now();
        let late = |milliseconds| due + Duration::from_millis(milliseconds);
        assert_eq!(report_after(due, late(20)), late(1000));
        assert_eq!(report_after(due, late(1000)), late(2000));
        assert_eq!(report_after(due, late(60_500)), late(61_500));
    }
}
