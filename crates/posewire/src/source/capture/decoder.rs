//! What reads the datagrams of a capture: the same as reads live ones.

use crate::capture::{Opening, is_asked};
use crate::net::Received;
use crate::session::Outlet;
use crate::source::timeline::Timeline;
use crate::source::{mxtp, natnet};
use crate::{Datagram, Notice};
use posewire_motion::Stamp;
use posewire_natnet::MessageId;
use std::time::{Duration, Instant};

/// The reader of a protocol, and the time of the capture.
pub(super) struct Decoder<'a> {
    now: Stamp,
    reader: Reader<'a>,
}

enum Reader<'a> {
    Mxtp(Box<mxtp::Intake<'a>>),
    NatNet(Box<natnet::Intake<'a>>),
}

impl<'a> Decoder<'a> {
    /// A reader of MXTP, or of NatNet if it is known how that opened.
    pub(super) fn new(now: Stamp, opening: Option<&Opening>, outlet: &'a mut Outlet) -> Self {
        let time = Timeline::played(now);
        let reader = match opening {
            None => Reader::Mxtp(Box::new(mxtp::Intake::at(time, outlet))),
            Some(opening) => Reader::NatNet(Box::new(open_natnet(time, opening, outlet))),
        };
        Self { now, reader }
    }

    /// Takes a datagram that was to be played when it is `due`; `false` when no sink is left.
    pub(super) fn take(&mut self, datagram: &Datagram, due: Option<Instant>) -> bool {
        self.now = datagram.received;
        match &mut self.reader {
            Reader::Mxtp(intake) => {
                intake.go_on(self.now, due);
                let way = mxtp::Way {
                    wire: datagram.wire,
                    from: datagram.from,
                    to: datagram.to,
                };
                intake.datagram(way, datagram.received, &datagram.bytes);
            }
            Reader::NatNet(intake) => {
                intake.go_on(self.now, due);
                if !is_asked(&datagram.bytes) && !is_answer(&datagram.bytes) {
                    take_natnet(intake, datagram);
                }
            }
        }
        self.look()
    }

    /// Lets so much time pass, until what happens now is `due`; `false` when no sink is left.
    pub(super) fn tick(&mut self, time: Duration, due: Option<Instant>) -> bool {
        self.now = self.now.after(time);
        match &mut self.reader {
            Reader::Mxtp(intake) => intake.go_on(self.now, due),
            Reader::NatNet(intake) => intake.go_on(self.now, due),
        }
        self.look()
    }

    /// How long nothing happens unless a datagram comes; `None` for ever.
    pub(super) fn next_due(&self) -> Option<Duration> {
        match &self.reader {
            Reader::Mxtp(intake) => intake.due().map(|due| due.since(self.now)),
            // What its client has to do is to ask, and nobody is there to be asked.
            Reader::NatNet(_) => None,
        }
        .filter(|due| !due.is_zero())
    }

    pub(super) fn notice(&mut self, notice: Notice) {
        match &mut self.reader {
            Reader::Mxtp(intake) => intake.notice(notice),
            Reader::NatNet(intake) => intake.notice(notice),
        }
    }

    pub(super) fn finish(self) {
        match self.reader {
            Reader::Mxtp(intake) => intake.finish(0, 0),
            Reader::NatNet(intake) => intake.finish(None),
        }
    }

    fn look(&mut self) -> bool {
        match &mut self.reader {
            Reader::Mxtp(intake) => intake.tick(0, 0),
            Reader::NatNet(intake) => {
                // Nobody is there to be asked.
                intake.outbox.clear();
                intake.tick(None)
            }
        }
    }
}

/// A reader that has heard already what the server says of itself, so that it knows what the first frame is.
fn open_natnet<'a>(time: Timeline, opening: &Opening, outlet: &'a mut Outlet) -> natnet::Intake<'a> {
    let mut intake = natnet::Intake::at(time, outlet, opening.address.clone(), opening.server);
    for bytes in &opening.packets {
        let stamp = time.now();
        let datagram = Datagram {
            wire: crate::Wire::NatNetCommand,
            from: opening.server,
            to: opening.server,
            received: stamp,
            bytes: bytes.clone(),
        };
        take_natnet(&mut intake, &datagram);
    }
    intake.know_all();
    intake
}

fn take_natnet(intake: &mut natnet::Intake<'_>, datagram: &Datagram) {
    let port = natnet::Port {
        wire: datagram.wire,
        local: datagram.to,
    };
    intake.datagram(
        port,
        Received {
            stamp: datagram.received,
            from: datagram.from,
            bytes: &datagram.bytes,
            truncated: false,
        },
    );
}

/// An answer to a question that somebody else asked would be taken for one to ours.
fn is_answer(packet: &[u8]) -> bool {
    const ANSWERS: [MessageId; 3] = [
        MessageId::RESPONSE,
        MessageId::UNRECOGNIZED_REQUEST,
        MessageId::ECHO_RESPONSE,
    ];
    posewire_natnet::Packet::decode(packet).is_ok_and(|packet| ANSWERS.contains(&packet.id))
}
