//! Datagrams out, to one target each.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};

use socket2::{Domain, Protocol, Socket, Type};

use super::interface::LocalInterface;
use super::resolve::resolve_first;
use super::udp_receive::scoped;
use crate::endpoint::UdpAddress;
use crate::error::{Error, Result};

/// Sends datagrams to one host, one broadcast address or one multicast group. Never waits.
#[derive(Debug)]
pub struct UdpSender {
    socket: UdpSocket,
    local: SocketAddr,
    target: SocketAddr,
    counts: SendCounts,
}

/// What became of the datagrams given to a [`UdpSender`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SendCounts {
    /// Datagrams that the kernel took.
    pub sent: u64,
    /// Datagrams that it had no room for: the network is slower than the stream.
    pub congested: u64,
    /// Datagrams that it refused for another reason.
    pub failed: u64,
}

impl UdpSender {
    /// Opens a socket towards the address. Multicast passes no router unless the address says
    /// `ttl`, and programs on this machine hear it too.
    ///
    /// # Errors
    /// [`Error::Resolve`], [`Error::Interface`], and [`Error::Socket`] when the system refuses or
    /// the port is 0.
    pub fn open(address: &UdpAddress) -> Result<Self> {
        let target = resolve_first(&address.host, address.port)?;
        let refused = |error: io::Error| Error::socket("send to", format!("udp {target}"), &error);
        if target.port() == 0 {
            let reason = "port 0 stands for any port and cannot be sent to";
            return Err(refused(io::Error::new(io::ErrorKind::InvalidInput, reason)));
        }
        let interface = match &address.interface {
            Some(wanted) => Some(LocalInterface::find(wanted)?),
            None => None,
        };
        let interface = interface.as_ref();
        let socket = open(target, address.ttl).map_err(refused)?;
        if let Some(interface) = interface {
            leave_by(&socket, target, interface)?;
        }
        let socket = UdpSocket::from(socket);
        Ok(Self {
            local: socket.local_addr().map_err(refused)?,
            target: scoped(target, interface),
            counts: SendCounts::default(),
            socket,
        })
    }

    /// Sends one datagram. A datagram that the kernel has no room for is dropped and counted as
    /// congested, which is no error; neither is a target where nobody listens.
    ///
    /// # Errors
    /// [`Error::Socket`] when the kernel refuses it, as without a route or above 65,507 bytes; it
    /// is counted as failed, and the sender remains usable.
    pub fn send(&mut self, datagram: &[u8]) -> Result<()> {
        match self.socket.send_to(datagram, self.target) {
            Ok(_) => self.counts.sent += 1,
            Err(error) if is_no_room(&error) => self.counts.congested += 1,
            Err(error) if is_nobody(&error) => self.counts.sent += 1,
            Err(error) => {
                self.counts.failed += 1;
                let target = format!("udp {}", self.target);
                return Err(Error::socket("send to", target, &error));
            }
        }
        Ok(())
    }

    /// What became of the datagrams so far.
    pub fn counts(&self) -> SendCounts {
        self.counts
    }

    /// Where the datagrams go.
    pub fn target(&self) -> SocketAddr {
        self.target
    }

    /// Where the datagrams come from, as far as it is known before they leave.
    pub fn local_address(&self) -> SocketAddr {
        self.local
    }
}

fn open(target: SocketAddr, ttl: Option<u8>) -> io::Result<Socket> {
    let socket = Socket::new(Domain::for_address(target), Type::DGRAM, Some(Protocol::UDP))?;
    socket.set_nonblocking(true)?;
    // A smaller buffer than asked for is only a smaller buffer.
    let _ = socket.set_send_buffer_size(BUFFER);
    let ttl = ttl.map(u32::from);
    match target.ip() {
        IpAddr::V4(address) if address.is_multicast() => socket.set_multicast_ttl_v4(ttl.unwrap_or(1))?,
        IpAddr::V6(address) if address.is_multicast() => socket.set_multicast_hops_v6(ttl.unwrap_or(1))?,
        IpAddr::V4(_) => ttl.map_or(Ok(()), |ttl| socket.set_ttl_v4(ttl))?,
        IpAddr::V6(_) => ttl.map_or(Ok(()), |ttl| socket.set_unicast_hops_v6(ttl))?,
    }
    let any: IpAddr = match target {
        SocketAddr::V4(_) => Ipv4Addr::UNSPECIFIED.into(),
        SocketAddr::V6(_) => Ipv6Addr::UNSPECIFIED.into(),
    };
    if target.is_ipv4() {
        // Which addresses are broadcast addresses depends on network masks: allow it for all.
        socket.set_broadcast(true)?;
    }
    socket.bind(&SocketAddr::new(any, 0).into())?;
    Ok(socket)
}

fn leave_by(socket: &Socket, target: SocketAddr, interface: &LocalInterface) -> Result<()> {
    let outcome = match target.ip() {
        IpAddr::V4(address) if address.is_multicast() => socket.set_multicast_if_v4(&interface.ipv4()?),
        IpAddr::V6(address) if address.is_multicast() => socket.set_multicast_if_v6(interface.index),
        _ => return choose_device(socket, interface),
    };
    outcome.map_err(|error| Error::socket("use interface", interface.name.clone(), &error))
}

/// Ties a socket to one interface.
#[cfg(target_os = "linux")]
pub(super) fn choose_device(socket: &Socket, interface: &LocalInterface) -> Result<()> {
    socket
        .bind_device(Some(interface.name.as_bytes()))
        .map_err(|error| Error::socket("use interface", interface.name.clone(), &error))
}

/// Only Linux ties a socket to an interface; elsewhere the system's routes decide.
#[cfg(not(target_os = "linux"))]
pub(super) fn choose_device(_socket: &Socket, interface: &LocalInterface) -> Result<()> {
    Err(Error::Interface {
        name: interface.name.clone(),
        problem: "can be chosen only for multicast on this system",
        available: Vec::new(),
    })
}

#[cfg(unix)]
pub(super) fn is_no_room(error: &io::Error) -> bool {
    let no_buffers = error.raw_os_error() == Some(nix::errno::Errno::ENOBUFS as i32);
    no_buffers || error.kind() == io::ErrorKind::WouldBlock
}

#[cfg(not(unix))]
pub(super) fn is_no_room(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::WouldBlock
}

/// The answer of the target's system to an earlier datagram.
pub(super) fn is_nobody(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionRefused, ConnectionReset};
    matches!(error.kind(), ConnectionRefused | ConnectionReset)
}

/// Holds what 64 people with fingers send at once.
const BUFFER: usize = 4 << 20;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::endpoint::Host;

    fn address(octets: [u8; 4], port: u16) -> UdpAddress {
        UdpAddress::new(Host::Address(octets.into()), port)
    }

    #[test]
    fn a_target_where_nobody_listens_is_no_error() {
        let unused = UdpSocket::bind("127.0.0.1:0").unwrap();
        let port = unused.local_addr().unwrap().port();
        drop(unused);
        let mut sender = UdpSender::open(&address([127, 0, 0, 1], port)).unwrap();
        for _ in 0..10 {
            assert_eq!(sender.send(b"MXTP"), Ok(()));
        }
        assert_eq!(sender.counts().sent, 10);
    }

    #[test]
    fn a_datagram_that_is_too_long_is_refused_and_counted() {
        let mut sender = UdpSender::open(&address([127, 0, 0, 1], 9)).unwrap();
        assert!(matches!(sender.send(&vec![0; 65_508]), Err(Error::Socket { .. })));
        let expected = SendCounts {
            failed: 1,
            ..SendCounts::default()
        };
        assert_eq!(sender.counts(), expected);
    }

    #[test]
    fn port_0_is_no_target() {
        let error = UdpSender::open(&address([127, 0, 0, 1], 0)).unwrap_err();
        assert!(error.to_string().contains("port 0"));
    }

    #[test]
    fn a_broadcast_address_is_allowed() {
        // The loopback network's own, so that nothing leaves this machine.
        let mut sender = UdpSender::open(&address([127, 255, 255, 255], 9)).unwrap();
        assert_eq!(sender.send(b"MXTP"), Ok(()));
    }
}
