//! From datagrams to items, for UDP and TCP alike.

use crate::session::Outlet;
use crate::source::report::Reports;
use crate::source::timeline::Timeline;
use crate::stats::{Edge, Tally};
use crate::{Datagram, Item, Notice, Wire};
use posewire_motion::Stamp;
use posewire_mxtp::{Assembler, AssemblerOptions, Event};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Instant;

/// Which way a datagram has come.
#[derive(Clone, Copy, Debug)]
pub(in crate::source) struct Way {
    pub(in crate::source) wire: Wire,
    pub(in crate::source) from: SocketAddr,
    pub(in crate::source) to: SocketAddr,
}

impl Way {
    /// Whether both ends are certainly on one machine.
    fn is_within_a_machine(&self) -> bool {
        self.from.ip().to_canonical().is_loopback() || self.from.ip() == self.to.ip()
    }
}

/// Assembles what arrives, counts it, and hands it on.
pub(in crate::source) struct Intake<'a> {
    assembler: Assembler,
    tally: Tally,
    time: Timeline,
    /// When what is taken now was to leave, if it is played.
    due: Option<Instant>,
    reports: Reports,
    outlet: &'a mut Outlet,
}

impl<'a> Intake<'a> {
    pub(super) fn new(outlet: &'a mut Outlet) -> Self {
        Self::at(Timeline::live(), outlet)
    }

    /// Goes by this time.
    pub(in crate::source) fn at(time: Timeline, outlet: &'a mut Outlet) -> Self {
        let options = AssemblerOptions {
            ahead: outlet.wants_ahead(),
            ..AssemblerOptions::default()
        };
        Self {
            assembler: Assembler::with_options(options),
            tally: Tally::new(time.now()),
            reports: Reports::new(),
            time,
            due: None,
            outlet,
        }
    }

    /// Goes on to a time of a capture; what is taken then was to leave when it is `due`.
    pub(in crate::source) fn go_on(&mut self, to: Stamp, due: Option<Instant>) {
        self.time.go_on(to);
        self.due = due;
    }

    /// Takes one datagram as it arrived.
    pub(in crate::source) fn datagram(&mut self, way: Way, at: Stamp, bytes: &[u8]) {
        self.outlet.push_datagram(|| Datagram {
            wire: way.wire,
            from: way.from,
            to: way.to,
            received: at,
            bytes: bytes.into(),
        });
        self.tally.datagram(bytes.len(), way.is_within_a_machine());
        self.assembler.handle(at, bytes);
        self.forward(at);
    }

    /// When a sample has waited for long enough; `None` while none is open.
    pub(in crate::source) fn due(&self) -> Option<Stamp> {
        self.assembler.timeout()
    }

    /// Tells the sinks something about the connection.
    pub(in crate::source) fn notice(&mut self, notice: Notice) {
        self.outlet.push(Item::Notice(notice));
    }

    /// To be called after each batch and at least every [`TICK`](crate::source::report::TICK): closes what waited too long, reports once a second
    /// and hands everything to the sinks. `false` when no sink is left.
    pub(in crate::source) fn tick(&mut self, kernel_dropped: u64, skipped_bytes: u64) -> bool {
        let now = self.time.now();
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
    pub(in crate::source) fn finish(mut self, kernel_dropped: u64, skipped_bytes: u64) {
        let now = self.time.now();
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
                    self.tally.sample(&frame);
                    self.outlet.push(Item::Frame { frame, due: self.due });
                }
                Event::Ahead(frame) => self.outlet.push(Item::Ahead { frame, due: self.due }),
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
