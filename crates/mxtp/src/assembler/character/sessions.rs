//! How a session of a character begins: with what was put aside until it showed.

use super::{Arrival, Character, Standing};
use crate::assembler::aside::Held;
use crate::assembler::events::Events;
use crate::sequence::Home;
use crate::{Datagram, ResetKind};

impl Character {
    /// Counts a datagram whose frame is done, or never will be, and puts it aside where its sample may begin a session.
    pub(super) fn add_too_late(&mut self, home: Home, arrival: &mut Arrival<'_>) {
        let header = &arrival.datagram.header;
        if self.aside.has(header) {
            self.streams[arrival.stream].note_again();
            return;
        }
        let before = self.streams[arrival.stream].fate();
        self.count_too_late(home, arrival);
        if self.samples.suspects(header.sample) {
            let stream = &self.streams[arrival.stream];
            let counted = (stream.fate_since(before), stream.in_order());
            self.aside.put(Held::new(arrival.now, header, arrival.bytes, counted));
        }
    }

    /// Forgets the numbers of the session before, but not what its samples had, and assembles what was put aside of the
    /// new one.
    pub(super) fn begin_session(&mut self, kind: ResetKind, latest: u32, events: &mut Events) {
        self.close_all(events);
        self.closed_before = std::mem::take(&mut self.closed);
        self.session = self.session.next(kind);
        self.aside
            .retain(|sample| sample != latest && self.samples.remembers(sample));
        let held = self.aside.take();
        self.take_back(&held);
        for datagram in held {
            self.assemble_held(&datagram, events);
        }
    }

    /// Counts what was put aside as if it had been so from the beginning: it will be counted again, and what came after it
    /// of the session before is late.
    fn take_back(&mut self, held: &[Held]) {
        for datagram in held {
            let stream = self.stream(datagram.message_type);
            self.streams[stream].take_back(datagram.fate);
        }
        for datagram in held {
            let stream = self.stream(datagram.message_type);
            self.streams[stream].note_overtaken_since(datagram.in_order);
        }
    }

    fn assemble_held(&mut self, held: &Held, events: &mut Events) {
        let Ok(datagram) = Datagram::decode(&held.bytes) else {
            return;
        };
        let mut arrival = Arrival {
            now: held.now,
            bytes: &held.bytes,
            datagram: &datagram,
            stream: self.stream(held.message_type),
            standing: Standing::Held {
                told: held.fate.is_received(),
            },
            events,
        };
        let open = self.open.iter().position(|sample| sample.number == held.sample);
        let place = open.unwrap_or_else(|| self.open_sample(&datagram.header, held.now));
        self.add(place, &mut arrival);
        if held.overtaken {
            self.streams[arrival.stream].note_too_late();
        }
        self.close_complete(arrival.events);
    }
}
