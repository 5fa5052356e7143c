//! From datagrams to items, for UDP and TCP alike.

use crate::clock::Clock;
use crate::session::Outlet;
use crate::source::report::Reports;
use crate::stats::{Edge, Tally};
use crate::{Item, Notice};
use posewire_motion::Stamp;
use posewire_mxtp::{Assembler, Event};
use std::sync::Arc;

/// Assembles what arrives, counts it, and hands it on.
pub(super) struct Intake<'a> {
    assembler: Assembler,
    tally: Tally,
    clock: Clock,
    reports: Reports,
    outlet: &'a mut Outlet,
}

impl<'a> Intake<'a> {
    pub(super) fn new(outlet: &'a mut Outlet) -> Self {
        let clock = Clock::new();
        Self {
            assembler: Assembler::new(),
            tally: Tally::new(clock.now()),
            reports: Reports::new(),
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

    /// To be called after each batch and at least every [`TICK`](crate::source::report::TICK): closes what waited too long, reports once a second
    /// and hands everything to the sinks. `false` when no sink is left.
    pub(super) fn tick(&mut self, kernel_dropped: u64, skipped_bytes: u64) -> bool {
        let now = self.clock.now();
        if self.assembler.timeout().is_some_and(|due| due <= now) {
            self.assembler.handle_timeout(now);
            self.forward(now);
        }
        if self.reports.is_due() {
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
