//! The sockets of a client.

use std::net::SocketAddr;
use std::time::Duration;

use posewire_natnet::client::Mode;

use crate::endpoint::{Host, Interface, NatNetAddress, UdpAddress};
use crate::net::{LocalAddress, Received, UdpReceiver};
use crate::{Error, Result};

/// The command socket, and the one that frames arrive on where that is another.
///
/// Only one of them can be waited for: the one that frames come to. The other is looked at each time, and loses nothing by
/// that, as the kernel stamps what arrives.
#[derive(Debug)]
pub(super) struct Sockets {
    command: UdpReceiver,
    data: Option<UdpReceiver>,
    waits_for_data: bool,
    mode: Mode,
    local: LocalAddress,
    /// The group that was joined.
    group: Option<SocketAddr>,
    /// Drops of a socket that was closed.
    dropped_before: u64,
}

impl Sockets {
    /// Opens the command socket, and joins the group if frames are multicast.
    ///
    /// # Errors
    /// [`Error::Interface`] and [`Error::Socket`].
    pub(super) fn open(address: &NatNetAddress, server: SocketAddr) -> Result<Self> {
        if server.port() == 0 {
            let reason = "port 0 stands for any port and cannot be connected to";
            let error = std::io::Error::new(std::io::ErrorKind::InvalidInput, reason);
            return Err(Error::socket("connect to", format!("udp {server}"), &error));
        }
        let local = LocalAddress::towards(server, address.interface.as_ref())?;
        let group = (address.mode == Mode::Multicast).then(|| SocketAddr::new(address.group.into(), address.data_port));
        let data = group.map(|group| join(group, &local)).transpose()?;
        // The port of a group is the system's choice only in tests.
        let group = group.zip(data.as_ref());
        let group = group.map(|(group, data)| SocketAddr::new(group.ip(), data.local_address().port()));
        Ok(Self {
            command: UdpReceiver::bind(&command_address(address, server, &local))?,
            waits_for_data: data.is_some(),
            data,
            mode: address.mode,
            local,
            group,
            dropped_before: 0,
        })
    }

    /// The group that was joined, and where.
    pub(super) fn joined(&self) -> Option<(SocketAddr, &LocalAddress)> {
        self.group.map(|group| (group, &self.local))
    }

    /// This machine's address towards the server.
    pub(super) fn local(&self) -> &LocalAddress {
        &self.local
    }

    pub(super) fn kernel_dropped(&self) -> u64 {
        let data = self.data.as_ref().map_or(0, UdpReceiver::kernel_dropped);
        self.dropped_before + self.command.kernel_dropped() + data
    }

    /// Waits at most `timeout` for a datagram that may be a frame, and takes all that is there. `each` says whether one was
    /// a frame. Gives how many there were.
    pub(super) fn receive(&mut self, timeout: Duration, mut each: impl FnMut(Received<'_>) -> bool) -> Result<usize> {
        let [command, data] = timeouts(timeout, self.waits_for_data);
        let mut frames = [false; 2];
        // What was sent first is likely to be needed first: the command socket tells which version frames are.
        let mut count = self.command.receive(command, |received| frames[0] |= each(received))?;
        if let Some(socket) = &mut self.data {
            count += socket.receive(data, |received| frames[1] |= each(received))?;
        }
        match (self.mode, frames) {
            // Frames come here after all; from both, each would come twice.
            (Mode::Unicast, [true, _]) if self.data.is_some() => self.close_data(),
            (_, [_, true]) => self.waits_for_data = true,
            _ => {}
        }
        Ok(count)
    }

    pub(super) fn send(&self, bytes: &[u8], to: SocketAddr) -> Result<()> {
        self.command.send(bytes, to)
    }

    /// Also listens at the data port.
    ///
    /// # Errors
    /// [`Error::Socket`] when another program has it.
    pub(super) fn listen_at_data_port(&mut self, port: u16) -> Result<()> {
        if self.data.is_none() {
            let host = Host::Address(self.command.local_address().ip());
            self.data = Some(UdpReceiver::bind(&UdpAddress::new(host, port))?);
        }
        Ok(())
    }

    fn close_data(&mut self) {
        let data = self.data.take();
        self.dropped_before += data.map_or(0, |socket| socket.kernel_dropped());
        self.waits_for_data = false;
    }
}

fn timeouts(timeout: Duration, waits_for_data: bool) -> [Duration; 2] {
    if waits_for_data {
        [Duration::ZERO, timeout]
    } else {
        [timeout, Duration::ZERO]
    }
}

fn join(group: SocketAddr, local: &LocalAddress) -> Result<UdpReceiver> {
    let mut address = UdpAddress::new(Host::Address(group.ip()), group.port());
    if group.ip().is_multicast() {
        address.interface = Some(Interface::Address(local.ip));
    }
    UdpReceiver::bind(&address)
}

/// On the interface that was named; else on all, as routes may change while the server is away.
fn command_address(address: &NatNetAddress, server: SocketAddr, local: &LocalAddress) -> UdpAddress {
    let any = match server {
        SocketAddr::V4(_) => [0, 0, 0, 0].into(),
        SocketAddr::V6(_) => [0u16; 8].into(),
    };
    let ip = if address.interface.is_some() { local.ip } else { any };
    UdpAddress::new(Host::Address(ip), 0)
}
