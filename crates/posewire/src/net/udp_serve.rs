//! A port that answers whoever sends to it.

use std::io;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::Duration;

use socket2::{Domain, Protocol, SockRef, Socket, Type};

use super::interface::LocalInterface;
use super::resolve::resolve_first;
use super::udp_receive::scoped;
use super::udp_send::{choose_device, is_no_room, is_nobody};
use crate::endpoint::{Host, Interface};
use crate::error::{Error, Result};

/// A UDP socket at an address of its own that sends to many.
#[derive(Debug)]
pub(crate) struct ServedPort {
    socket: UdpSocket,
    local: SocketAddr,
}

/// What became of a datagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sent {
    /// The system took it.
    Taken,
    /// Nobody is there any more. This comes as the answer to an earlier datagram, or as a missing route.
    Nobody,
    /// The system had no room for it.
    NoRoom,
    /// The system refused it.
    Refused,
}

impl ServedPort {
    /// Binds `host` and `port`. `action` says in errors what for. A `shared` port can be bound by other programs as well.
    pub(crate) fn bind(host: &Host, port: u16, shared: bool, action: &'static str) -> Result<Self> {
        let local = resolve_first(host, port)?;
        let refused = |error: io::Error| Error::socket(action, format!("udp {local}"), &error);
        let socket = open(local, shared).map_err(refused)?;
        Ok(Self {
            local: socket.local_addr().map_err(refused)?,
            socket,
        })
    }

    /// Takes and sends datagrams on this interface only.
    pub(crate) fn keep_to(&self, interface: &Interface) -> Result<()> {
        let interface = LocalInterface::find(interface)?;
        choose_device(&SockRef::from(&self.socket), &interface)
    }

    /// Sends to groups by the interface, else by that of its own address, else by the system's choice; at most `hops` far.
    pub(crate) fn multicast_by(&self, interface: Option<&Interface>, hops: u32) -> Result<()> {
        let address = match interface {
            Some(interface) => Some(LocalInterface::find(interface)?.ipv4()?),
            None => match self.local.ip() {
                IpAddr::V4(address) if !address.is_unspecified() => Some(address),
                _ => None,
            },
        };
        let socket = SockRef::from(&self.socket);
        let set = || {
            socket.set_multicast_ttl_v4(hops)?;
            address.map_or(Ok(()), |address| socket.set_multicast_if_v4(&address))
        };
        set().map_err(|error| Error::socket("multicast from", format!("udp {}", self.local), &error))
    }

    /// Makes sending never wait at all, nor receiving.
    pub(crate) fn never_wait(&self) -> Result<()> {
        let refused = |error: io::Error| Error::socket("send from", format!("udp {}", self.local), &error);
        self.socket.set_nonblocking(true).map_err(refused)
    }

    /// Waits at most `timeout` for a datagram, which goes to the beginning of `buffer`; `None` when none came. One that
    /// [never waits](Self::never_wait) takes a timeout of zero.
    pub(crate) fn receive(&self, timeout: Duration, buffer: &mut [u8]) -> io::Result<Option<(usize, SocketAddr)>> {
        if !timeout.is_zero() {
            self.socket.set_read_timeout(Some(timeout))?;
        }
        match self.socket.recv_from(buffer) {
            Ok((length, from)) => Ok(Some((length, from))),
            Err(error) if is_nothing(&error) || is_nobody(&error) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Sends a datagram, in next to no time whatever becomes of it.
    pub(crate) fn send(&self, datagram: &[u8], to: SocketAddr) -> Sent {
        match self.socket.send_to(datagram, to) {
            Ok(_) => Sent::Taken,
            Err(error) if is_no_room(&error) => Sent::NoRoom,
            Err(error) if is_nobody(&error) || error.kind() == io::ErrorKind::HostUnreachable => Sent::Nobody,
            Err(_) => Sent::Refused,
        }
    }

    /// The address that it is bound to, its port the real one.
    pub(crate) fn local_address(&self) -> SocketAddr {
        self.local
    }
}

fn open(local: SocketAddr, shared: bool) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::for_address(local), Type::DGRAM, Some(Protocol::UDP))?;
    if shared {
        socket.set_reuse_address(true)?;
    }
    if local.is_ipv4() {
        socket.set_broadcast(true)?;
    } else {
        socket.set_only_v6(false)?;
    }
    // A smaller buffer than asked for is only a smaller buffer.
    let _ = socket.set_send_buffer_size(BUFFER);
    // The socket waits for what comes, and no longer than this when there is no room for what goes.
    socket.set_write_timeout(Some(SEND_LIMIT))?;
    socket.bind(&scoped(local, None).into())?;
    Ok(socket.into())
}

fn is_nothing(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted)
}

/// Holds a large frame for each of 64 clients.
const BUFFER: usize = 4 << 20;
const SEND_LIMIT: Duration = Duration::from_millis(1);
