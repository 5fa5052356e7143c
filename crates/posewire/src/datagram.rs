//! Datagrams as they arrived, before anything was read from them.

use posewire_motion::Stamp;
use std::fmt;
use std::net::SocketAddr;

/// A datagram as it arrived: what a recording keeps, and what a replay sends again.
///
/// ```
/// use posewire::{Datagram, Wire};
///
/// let datagram = Datagram {
///     wire: Wire::MxtpUdp,
///     from: "192.168.1.20:50123".parse()?,
///     to: "0.0.0.0:9763".parse()?,
///     received: posewire::clock::Clock::new().now(),
///     bytes: (*b"MXTP02").into(),
/// };
/// assert_eq!(datagram.wire.to_string(), "mxtp/udp");
/// # Ok::<(), std::net::AddrParseError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Datagram {
    /// Which protocol it is of, and what carried it.
    pub wire: Wire,
    /// Who sent it.
    pub from: SocketAddr,
    /// What the socket was bound to that it arrived at: a group for a group's, `0.0.0.0` for any address of this machine.
    pub to: SocketAddr,
    /// When the kernel received it, UTC; over TCP, when the bytes that complete it were read.
    pub received: Stamp,
    /// The whole payload.
    pub bytes: Box<[u8]>,
}

/// The protocol of a datagram, and what carried it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Wire {
    /// MXTP over UDP: one datagram each.
    MxtpUdp,
    /// MXTP over TCP: one datagram each, cut from the stream.
    MxtpTcp,
    /// NatNet, at the client's own socket, where answers come, and frames that are sent to each client by itself.
    NatNetCommand,
    /// NatNet, at the socket for frames alone: that of the group or of the data port.
    NatNetData,
}

impl Wire {
    /// Every wire there is.
    pub const ALL: [Self; 4] = [Self::MxtpUdp, Self::MxtpTcp, Self::NatNetCommand, Self::NatNetData];

    /// Its name: `mxtp/udp`, `mxtp/tcp`, `natnet/command` or `natnet/data`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::MxtpUdp => "mxtp/udp",
            Self::MxtpTcp => "mxtp/tcp",
            Self::NatNetCommand => "natnet/command",
            Self::NatNetData => "natnet/data",
        }
    }

    /// The wire of this [`name`](Self::name).
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|wire| wire.name() == name)
    }
}

impl fmt::Display for Wire {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_wire_is_found_by_its_name() {
        for wire in Wire::ALL {
            assert_eq!(Wire::named(wire.name()), Some(wire));
        }
        assert_eq!(Wire::named("carrier/pigeon"), None);
    }
}
