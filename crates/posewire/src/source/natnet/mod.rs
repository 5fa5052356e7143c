//! NatNet from the network.

mod advice;
mod find;
mod intake;
mod naming;
mod senders;
mod silence;
mod sockets;

use std::net::{IpAddr, SocketAddr};
use std::time::{Duration, Instant};

use self::find::find;
pub(super) use self::intake::Intake;
pub(super) use self::sockets::Port;
use self::sockets::Sockets;
use super::report::{DRAIN_LIMIT, TICK};
use crate::endpoint::{Endpoint, NatNetAddress};
use crate::net;
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Error, Notice, Result};

/// A NatNet server that is to be connected to.
#[derive(Debug)]
pub(super) struct NatNet {
    address: NatNetAddress,
    place: Place,
}

/// Where the server is.
#[derive(Debug)]
enum Place {
    Known(SocketAddr, Box<Sockets>),
    /// On one of the networks, where a broadcast finds it.
    Unknown,
}

impl NatNet {
    pub(super) fn open(address: &NatNetAddress) -> Result<Self> {
        if address.copy {
            return Err(Error::Url {
                url: Endpoint::NatNet(address.clone()).to_string(),
                part: "copy of a source",
                expected: "false",
                found: "true".to_owned(),
            });
        }
        let server = net::resolve_first(&address.host, address.port)?;
        let place = if is_anybody(server.ip()) {
            Place::Unknown
        } else {
            Place::Known(server, Box::new(Sockets::open(address, server)?))
        };
        let address = address.clone();
        Ok(Self { address, place })
    }

    /// Where it is, with the group's port that the system chose if it was 0.
    pub(super) fn endpoint(&self) -> Endpoint {
        let joined = match &self.place {
            Place::Known(_, sockets) => sockets.joined(),
            Place::Unknown => None,
        };
        Endpoint::NatNet(NatNetAddress {
            data_port: joined.map_or(self.address.data_port, |(group, _)| group.port()),
            ..self.address.clone()
        })
    }

    /// Runs until the stop, or until no sink is left. A server that is gone is called until it is back.
    pub(super) fn run(self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        let (server, sockets) = match self.place {
            Place::Known(server, sockets) => (server, sockets),
            Place::Unknown => {
                let Some(server) = find(&self.address, outlet, stop)? else {
                    return Ok(());
                };
                (server, Box::new(Sockets::open(&self.address, server)?))
            }
        };
        let mut running = Running {
            is_cut_off: false,
            intake: Intake::new(outlet, self.address, server),
            sockets: *sockets,
        };
        let received = running.receive_all(stop);
        running.finish();
        received
    }
}

/// A client at work.
struct Running<'a> {
    /// Whether the last command could not be sent.
    is_cut_off: bool,
    intake: Intake<'a>,
    sockets: Sockets,
}

impl Running<'_> {
    /// Receives until the stop, and then what the system had taken by then.
    fn receive_all(&mut self, stop: &Stop) -> Result<()> {
        if let Some((group, on)) = self.sockets.joined() {
            self.intake.notice(Notice::Joined {
                group: group.to_string(),
                interface: on.to_string(),
            });
        }
        while !stop.is_stopped() {
            if !self.tick(TICK)? {
                return Ok(());
            }
        }
        let until = Instant::now() + DRAIN_LIMIT;
        while Instant::now() < until && self.receive(Duration::ZERO)? > 0 {}
        Ok(())
    }

    /// Takes what comes within `timeout` and does what is due. `false` when no sink is left.
    fn tick(&mut self, timeout: Duration) -> Result<bool> {
        self.receive(timeout)?;
        if self.intake.is_due() {
            self.catch_up()?;
        }
        let goes_on = self.intake.tick(Some(&self.sockets));
        self.send();
        self.listen_elsewhere();
        Ok(goes_on)
    }

    /// Reads what has arrived before anything is concluded from silence: after a stall of this program, or of the whole
    /// machine, a server is not gone whose datagrams wait.
    fn catch_up(&mut self) -> Result<()> {
        for _ in 0..MOST_BATCHES {
            if self.receive(Duration::ZERO)? == 0 {
                break;
            }
        }
        self.intake.note_all_read();
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<usize> {
        let intake = &mut self.intake;
        let count = self
            .sockets
            .receive(timeout, |port, received| intake.datagram(port, received))?;
        self.send();
        Ok(count)
    }

    fn send(&mut self) {
        for transmit in std::mem::take(&mut self.intake.outbox) {
            let outcome = self.sockets.send(&transmit.bytes, transmit.to);
            let was_cut_off = std::mem::replace(&mut self.is_cut_off, outcome.is_err());
            // A network that is down now may be up for the next try.
            if let (Err(error), false) = (outcome, was_cut_off) {
                self.intake.notice(Notice::NotConnected { error });
            }
        }
    }

    /// Some servers send to the data port of the client's host, whatever the client's own port.
    fn listen_elsewhere(&mut self) {
        if let Some(port) = self.intake.misses_frames() {
            match self.sockets.listen_at_data_port(port) {
                Ok(()) => {}
                Err(error) => self.intake.note_taken_port(error),
            }
        }
    }

    /// Also after an error: the numbers up to there are true.
    fn finish(mut self) {
        self.intake.disconnect();
        self.send();
        self.intake.finish(Some(&self.sockets));
    }
}

/// The most that is read at once, so that a flood does not keep us from everything else: more than the system keeps.
const MOST_BATCHES: usize = 1024;

/// Whether an address stands for whichever server there is.
fn is_anybody(address: IpAddr) -> bool {
    address.is_unspecified() || matches!(address, IpAddr::V4(v4) if v4.is_broadcast())
}
