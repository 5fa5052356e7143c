//! The two sockets of a server.

use crate::Result;
use crate::endpoint::{Host, NatNetAddress};
use crate::error::Error;
use crate::net::{Sent, ServedPort};
use posewire_natnet::client::Mode;
use posewire_natnet::{Socket, Transmit};

/// The two sockets of a server: one that answers commands, one that frames leave from.
#[derive(Debug)]
pub(super) struct Ports {
    pub(super) command: ServedPort,
    data: ServedPort,
    /// The port that clients are told.
    pub(super) data_port: u16,
}

impl Ports {
    pub(super) fn open(address: &NatNetAddress) -> Result<Self> {
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
        data.only_send()?;
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
            command,
            data,
            data_port,
        })
    }

    /// Sends a packet. Never waits for a frame, and next to nothing for an answer.
    pub(super) fn send(&self, transmit: &Transmit) -> Sent {
        match transmit.socket {
            Socket::Command => self.command.send(&transmit.bytes, transmit.to),
            Socket::Data => self.data.send(&transmit.bytes, transmit.to),
        }
    }
}

/// Whether the data port belongs to a client on this machine, to which copies go. Sharing it is not enough at an address
/// of its own: the system would give the copies to the socket that has that address, not to one that has any.
fn leaves_port_to_clients(address: &NatNetAddress) -> bool {
    let here = matches!(&address.host, Host::Address(host) if host.is_loopback());
    address.copy && here && address.data_port != 0
}

/// How many networks multicast crosses, as Motive has it.
const HOPS: u32 = 2;
