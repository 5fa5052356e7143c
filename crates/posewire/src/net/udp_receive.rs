//! Datagrams in, each with the time the kernel received it.

#[cfg(target_os = "linux")]
mod linux;
#[cfg(any(test, not(target_os = "linux")))]
mod portable;

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::time::Duration;

use posewire_motion::Stamp;
use socket2::{Domain, Protocol, Socket, Type};

use super::interface::LocalInterface;
use super::resolve::resolve_first;
use super::udp_send::{choose_device, is_nobody};
use crate::endpoint::UdpAddress;
use crate::error::{Error, Result};

#[cfg(target_os = "linux")]
use linux::Reader;
#[cfg(not(target_os = "linux"))]
use portable::Reader;

/// One datagram as it came in.
#[derive(Clone, Copy, Debug)]
pub struct Received<'a> {
    /// The whole payload.
    pub bytes: &'a [u8],
    /// Who sent it.
    pub from: SocketAddr,
    /// When the kernel received it, on Linux; elsewhere when the program did. UTC.
    pub stamp: Stamp,
    /// Whether the datagram was longer than the 65,535 bytes there is room for.
    pub truncated: bool,
}

/// A bound UDP socket that takes many datagrams per wakeup.
///
/// A receive buffer of 8 MiB is asked for; the system may grant less, see
/// [`receive_buffer`](Self::receive_buffer).
#[derive(Debug)]
pub struct UdpReceiver {
    socket: UdpSocket,
    local: SocketAddr,
    timeout: Duration,
    reader: Reader,
}

impl UdpReceiver {
    /// Binds the address, and joins it if it is a multicast group.
    ///
    /// Only a group, or the address of all that is 255.255.255.255, can be shared with other programs
    /// (`SO_REUSEADDR`). An `interface` is the one that a group is joined on; for any other address only datagrams that
    /// arrive on it are taken.
    ///
    /// # Errors
    /// [`Error::Resolve`], [`Error::Interface`], and [`Error::Socket`] when the system refuses,
    /// as when the port is in use.
    pub fn bind(address: &UdpAddress) -> Result<Self> {
        let local = resolve_first(&address.host, address.port)?;
        let interface = match &address.interface {
            Some(wanted) => Some(LocalInterface::find(wanted)?),
            None => None,
        };
        let interface = interface.as_ref();
        let refused = |error: io::Error| Error::socket("listen on", format!("udp {local}"), &error);

        let socket = open(local).map_err(refused)?;
        if local.ip().is_multicast() {
            let group_interface = match (local, interface) {
                (SocketAddr::V4(_), Some(interface)) => interface.ipv4()?,
                _ => Ipv4Addr::UNSPECIFIED,
            };
            join(&socket, local, group_interface, interface).map_err(refused)?;
        } else {
            if let Some(interface) = interface {
                choose_device(&socket, interface)?;
            }
            let bound = if is_broadcast(local) { everywhere(local) } else { local };
            socket.bind(&scoped(bound, interface).into()).map_err(refused)?;
        }
        Self::over(socket.into()).map_err(refused)
    }

    /// Waits at most `timeout` for a datagram, then hands over all that are there, up to 32, in
    /// the order of arrival. Gives how many; 0 when none came or a signal cut the wait short.
    ///
    /// # Errors
    /// [`Error::Socket`] when the system refuses to receive.
    pub fn receive(&mut self, timeout: Duration, mut each: impl FnMut(Received<'_>)) -> Result<usize> {
        let outcome = self
            .adopt(timeout)
            .and_then(|()| self.reader.receive(&self.socket, !timeout.is_zero(), &mut each));
        match outcome {
            Err(error) if is_nothing(&error) => Ok(0),
            Err(error) => Err(Error::socket("receive on", format!("udp {}", self.local), &error)),
            Ok(count) => Ok(count),
        }
    }

    /// Sends a datagram from the same address, without waiting for anything but room in the system.
    ///
    /// # Errors
    /// [`Error::Socket`] when the system refuses it. A target where nobody listens is no error.
    pub fn send(&self, datagram: &[u8], to: SocketAddr) -> Result<()> {
        match self.socket.send_to(datagram, to) {
            Err(error) if !is_nobody(&error) => Err(Error::socket("send to", format!("udp {to}"), &error)),
            _ => Ok(()),
        }
    }

    /// Allows [`send`](Self::send) to broadcast addresses.
    ///
    /// # Errors
    /// [`Error::Socket`] when the system refuses.
    pub fn allow_broadcast(&self) -> Result<()> {
        let allowed = self.socket.set_broadcast(true);
        allowed.map_err(|error| Error::socket("broadcast from", format!("udp {}", self.local), &error))
    }

    /// The address that the socket is bound to, its port the real one.
    pub fn local_address(&self) -> SocketAddr {
        self.local
    }

    /// How many bytes of datagrams the kernel keeps while the program is busy.
    ///
    /// # Errors
    /// [`Error::Socket`] when the system does not say.
    pub fn receive_buffer(&self) -> Result<usize> {
        let size = socket2::SockRef::from(&self.socket).recv_buffer_size();
        // Linux reports twice what it grants: the other half is for its own bookkeeping.
        let share = if cfg!(target_os = "linux") { 2 } else { 1 };
        size.map(|bytes| bytes / share)
            .map_err(|error| Error::socket("ask about", format!("udp {}", self.local), &error))
    }

    /// How many datagrams the kernel dropped because its buffer was full, since the socket was
    /// bound; the count arrives with the next datagram. Always 0 where the system does not tell,
    /// which is everywhere but on Linux.
    pub fn kernel_dropped(&self) -> u64 {
        self.reader.kernel_dropped()
    }

    /// Whether stamps are the kernel's rather than the program's.
    pub fn stamps_by_kernel(&self) -> bool {
        cfg!(target_os = "linux")
    }

    fn over(socket: UdpSocket) -> io::Result<Self> {
        ask_for_buffer(&socket);
        Ok(Self {
            local: socket.local_addr()?,
            reader: Reader::new(&socket)?,
            timeout: Duration::ZERO,
            socket,
        })
    }

    /// Sets the socket's timeout if it is another than last time. Zero would mean "for ever" to
    /// the socket; such a receive does not wait in the first place.
    fn adopt(&mut self, timeout: Duration) -> io::Result<()> {
        if timeout != self.timeout && !timeout.is_zero() {
            self.socket.set_read_timeout(Some(timeout))?;
            self.timeout = timeout;
        }
        Ok(())
    }
}

/// The address with the interface's number, which link-local IPv6 addresses are nothing without.
pub(super) fn scoped(address: SocketAddr, interface: Option<&LocalInterface>) -> SocketAddr {
    match (address, interface) {
        (SocketAddr::V6(mut v6), Some(interface)) => {
            v6.set_scope_id(interface.index);
            v6.into()
        }
        _ => address,
    }
}

fn open(local: SocketAddr) -> io::Result<Socket> {
    let socket = Socket::new(Domain::for_address(local), Type::DGRAM, Some(Protocol::UDP))?;
    if local.is_ipv6() {
        socket.set_only_v6(false)?;
    }
    if local.ip().is_multicast() || is_broadcast(local) {
        socket.set_reuse_address(true)?;
    }
    Ok(socket)
}

/// What to bind for what comes to an address that is nobody's own. Bound to that itself, Linux keeps datagrams for other
/// addresses away. Other systems cannot.
fn everywhere(address: SocketAddr) -> SocketAddr {
    match address {
        _ if cfg!(target_os = "linux") => address,
        SocketAddr::V4(_) => SocketAddr::new(Ipv4Addr::UNSPECIFIED.into(), address.port()),
        SocketAddr::V6(_) => SocketAddr::new(Ipv6Addr::UNSPECIFIED.into(), address.port()),
    }
}

fn is_broadcast(address: SocketAddr) -> bool {
    matches!(address.ip(), IpAddr::V4(address) if address.is_broadcast())
}

fn join(socket: &Socket, group: SocketAddr, ipv4: Ipv4Addr, interface: Option<&LocalInterface>) -> io::Result<()> {
    socket.bind(&scoped(everywhere(group), interface).into())?;
    only_joined(socket, group)?;
    match group.ip() {
        IpAddr::V4(group) => socket.join_multicast_v4(&group, &ipv4),
        IpAddr::V6(group) => socket.join_multicast_v6(&group, interface.map_or(0, |found| found.index)),
    }
}

/// Without this, Linux delivers what any program on the machine joined, on any interface.
#[cfg(target_os = "linux")]
fn only_joined(socket: &Socket, group: SocketAddr) -> io::Result<()> {
    match group {
        SocketAddr::V4(_) => socket.set_multicast_all_v4(false),
        SocketAddr::V6(_) => socket.set_multicast_all_v6(false),
    }
}

#[cfg(not(target_os = "linux"))]
fn only_joined(_socket: &Socket, _group: SocketAddr) -> io::Result<()> {
    Ok(())
}

/// Some systems grant what they can, others refuse what is too much: then half is asked for.
fn ask_for_buffer(socket: &UdpSocket) {
    let socket = socket2::SockRef::from(socket);
    let mut size = BUFFER;
    while size >= SMALLEST_BUFFER && socket.set_recv_buffer_size(size).is_err() {
        size /= 2;
    }
    force_buffer(&socket);
}

/// A program with the right to may go over the limit that the system sets for all.
#[cfg(target_os = "linux")]
fn force_buffer(socket: &socket2::SockRef<'_>) {
    use nix::sys::socket::{setsockopt, sockopt};
    // Without the right the buffer stays as it is.
    let _ = setsockopt(&**socket, sockopt::RcvBufForce, &BUFFER);
}

#[cfg(not(target_os = "linux"))]
fn force_buffer(_socket: &socket2::SockRef<'_>) {}

fn is_nothing(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    // Some systems tell a receiver that nobody was where it sent to.
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted) || is_nobody(error)
}

/// The sender's address; an IPv4 one as such, also when it came through an IPv6 socket.
fn canonical(address: SocketAddr) -> SocketAddr {
    match address.ip().to_canonical() {
        IpAddr::V6(_) => address,
        v4 @ IpAddr::V4(_) => SocketAddr::new(v4, address.port()),
    }
}

const BUFFER: usize = 8 << 20;
const SMALLEST_BUFFER: usize = 64 << 10;
/// One more than any UDP payload, so that a longer one would show.
const LARGEST_DATAGRAM: usize = 65_535;

#[cfg(test)]
mod tests;
