//! The sockets of a server.

use crate::Result;
use crate::endpoint::{Host, NatNetAddress};
use crate::error::Error;
use crate::net::{self, Sent, ServedPort};
use posewire_natnet::client::Mode;
use posewire_natnet::{Socket, Transmit};
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::time::Duration;

/// The sockets of a server: one that answers commands, one that frames leave from, and ears for broadcasts.
#[derive(Debug)]
pub(crate) struct Ports {
    command: ServedPort,
    /// Bound to one address, the command port hears no broadcast: these do.
    broadcasts: Vec<ServedPort>,
    data: ServedPort,
    /// The port that clients are told.
    pub(crate) data_port: u16,
}

impl Ports {
    pub(crate) fn open(address: &NatNetAddress) -> Result<Self> {
        let multicast = address.mode == Mode::Multicast;
        let command = ServedPort::bind(&address.host, address.port, false, Error::SERVE_COMMANDS)?;
        let leaves_from = if leaves_port_to_clients(address) {
            0
        } else {
            address.data_port
        };
        // Clients on this machine bind the data port as well, for what goes to the group or is copied there.
        let shared = multicast || address.copy;
        let data = ServedPort::bind(&address.host, leaves_from, shared, Error::SERVE_FRAMES)?;
        data.never_wait()?;
        match &address.interface {
            interface if multicast => data.multicast_by(interface.as_ref(), HOPS)?,
            Some(interface) => {
                command.keep_to(interface)?;
                data.keep_to(interface)?;
            }
            None => {}
        }
        let data_port = match address.data_port {
            0 => data.local_address().port(),
            port => port,
        };
        Ok(Self {
            broadcasts: hear_broadcasts(&command),
            command,
            data,
            data_port,
        })
    }

    /// Where commands are answered.
    pub(crate) fn local_address(&self) -> SocketAddr {
        self.command.local_address()
    }

    /// Waits at most `timeout` for a command, and gives it and those that were broadcast to `take`.
    ///
    /// # Errors
    /// What keeps the system from receiving.
    pub(crate) fn receive(
        &self,
        timeout: Duration,
        buffer: &mut [u8],
        mut take: impl FnMut(SocketAddr, &[u8]),
    ) -> io::Result<()> {
        let waits = [(&self.command, timeout)];
        let broadcasts = self.broadcasts.iter().map(|port| (port, Duration::ZERO));
        for (port, timeout) in waits.into_iter().chain(broadcasts) {
            if let Some((length, from)) = port.receive(timeout, buffer)? {
                take(from, buffer.get(..length).unwrap_or_default());
            }
        }
        Ok(())
    }

    /// Sends a packet. Never waits for a frame, and next to nothing for an answer.
    pub(crate) fn send(&self, transmit: &Transmit) -> Sent {
        match transmit.socket {
            Socket::Command => self.command.send(&transmit.bytes, transmit.to),
            Socket::Data => self.data.send(&transmit.bytes, transmit.to),
        }
    }
}

/// Ports for the broadcasts of the command port's networks. Where another program has one of them to itself, that one hears
/// who looks for servers, and this server has to be named.
fn hear_broadcasts(command: &ServedPort) -> Vec<ServedPort> {
    let local = command.local_address();
    let open = |address: Ipv4Addr| {
        let port = ServedPort::bind(
            &Host::Address(address.into()),
            local.port(),
            true,
            Error::SERVE_COMMANDS,
        )?;
        port.never_wait().map(|()| port)
    };
    let opened = net::broadcasts_beside(local.ip()).into_iter().map(open);
    opened
        .filter_map(|port| {
            port.inspect_err(|error| tracing::info!(%error, "hears no broadcasts"))
                .ok()
        })
        .collect()
}

/// Whether the data port belongs to a client on this machine, to which copies go. Sharing it is not enough at an address
/// of its own: the system would give the copies to the socket that has that address, not to one that has any.
fn leaves_port_to_clients(address: &NatNetAddress) -> bool {
    let here = matches!(&address.host, Host::Address(host) if host.is_loopback());
    address.copy && here && address.data_port != 0
}

/// How many networks multicast crosses, as Motive has it.
const HOPS: u32 = 2;
