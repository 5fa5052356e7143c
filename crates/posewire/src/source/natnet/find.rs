//! Which server is there?

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use posewire_natnet::Output;
use posewire_natnet::client::{ClientOptions, Discovery, Found};

use super::advice::named;
use crate::clock::Clock;
use crate::endpoint::{Host, NatNetAddress, UdpAddress};
use crate::net::{self, UdpReceiver};
use crate::session::Outlet;
use crate::source::report::TICK;
use crate::stats::{Link, NatNetTally};
use crate::stop::Stop;
use crate::{Error, Item, Notice, Result};

/// The one server that answers a broadcast. It is asked for until it does; `None` when the stop, or the end of all sinks,
/// comes first.
///
/// # Errors
/// [`Error::SeveralServers`] when more than one answers; [`Error::Interface`] and [`Error::Socket`].
pub(super) fn find(address: &NatNetAddress, outlet: &mut Outlet, stop: &Stop) -> Result<Option<SocketAddr>> {
    let clock = Clock::new();
    let mut tally = NatNetTally::new(clock.now());
    let targets = net::broadcast_addresses(address.interface.as_ref())?;
    let targets: Vec<_> = targets.into_iter().map(|ip| (ip, address.port).into()).collect();
    let mut socket = UdpReceiver::bind(&UdpAddress::new(Host::Address(Ipv4Addr::UNSPECIFIED.into()), 0))?;
    socket.allow_broadcast()?;
    let mut told = false;
    while !stop.is_stopped() && outlet.flush() {
        let servers = distinct(ask(&targets, &mut socket, clock, stop)?);
        match servers.as_slice() {
            [] if !stop.is_stopped() && !std::mem::replace(&mut told, true) => {
                let text = NOBODY.to_owned();
                outlet.push(Item::Notice(Notice::Remark { text }));
            }
            [] => {}
            [only] => return Ok(Some(only.server)),
            several => return Err(too_many(several)),
        }
    }
    let link = Link {
        server: targets[0],
        mode: address.mode,
        group: None,
        interface: None,
        kernel_dropped: socket.kernel_dropped(),
        now: clock.now(),
        steady: clock.steady(),
    };
    outlet.push(Item::Statistics(Arc::new(tally.report(None, 0, &link, true))));
    outlet.finish();
    Ok(None)
}

/// Everybody who answers within a second or so.
fn ask(targets: &[SocketAddr], socket: &mut UdpReceiver, clock: Clock, stop: &Stop) -> Result<Vec<Found>> {
    let sender = ClientOptions::new(socket.local_address(), posewire_natnet::client::Mode::Unicast).sender;
    let mut discovery = Discovery::new(clock.steady(), sender, targets.to_vec());
    let mut found = Vec::new();
    while let Some(due) = discovery.timeout().filter(|_| !stop.is_stopped()) {
        while let Some(output) = discovery.poll() {
            match output {
                Output::Event(server) => found.push(server),
                // A network that is down has no server either.
                Output::Transmit(question) => drop(socket.send(&question.bytes, question.to)),
            }
        }
        let wait = due.since(clock.steady()).clamp(Duration::from_millis(1), TICK);
        socket.receive(wait, |received| discovery.handle(received.from, received.bytes))?;
        discovery.handle_timeout(clock.steady());
    }
    Ok(found)
}

/// A server on this machine answers from each of the machine's addresses, which makes it no more than one.
fn distinct(mut found: Vec<Found>) -> Vec<Found> {
    found.sort_by_key(|server| (!server.server.ip().is_loopback(), server.server));
    let mut servers: Vec<Found> = Vec::new();
    for server in found {
        let is_known = |known: &Found| {
            known.info == server.info
                && known.server.port() == server.server.port()
                && net::is_own(known.server.ip())
                && net::is_own(server.server.ip())
        };
        if !servers.iter().any(is_known) {
            servers.push(server);
        }
    }
    servers
}

fn too_many(servers: &[Found]) -> Error {
    Error::SeveralServers {
        found: servers.iter().map(|found| named(found.server, &found.info)).collect(),
    }
}

const NOBODY: &str = "no NatNet server has answered yet, asking on; one behind a router has to be named: natnet://HOST";
