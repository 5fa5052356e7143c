//! Which of this machine's addresses and networks lead somewhere.

use std::fmt;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};

use super::interface::{LocalInterface, list};
use crate::endpoint::Interface;
use crate::error::{Error, Result};

/// An address of this machine, and the interface that has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LocalAddress {
    pub(crate) ip: IpAddr,
    /// The system's name for the interface, where it tells.
    pub(crate) interface: Option<String>,
}

impl LocalAddress {
    /// The address that `interface` has, of the kind that `to` is; without an interface the one that datagrams to `to`
    /// leave by. Nothing is sent.
    ///
    /// # Errors
    /// [`Error::Interface`] for one that is not there, [`Error::Socket`] when no route leads there.
    pub(crate) fn towards(to: SocketAddr, interface: Option<&Interface>) -> Result<Self> {
        match interface {
            Some(wanted) => Self::of(wanted, to),
            None => Self::by_route(to),
        }
    }

    fn of(wanted: &Interface, to: SocketAddr) -> Result<Self> {
        let found = LocalInterface::find(wanted)?;
        let same_kind = |address: &&IpAddr| address.is_ipv4() == to.is_ipv4();
        let ip = match wanted {
            Interface::Address(address) if same_kind(&address) => *address,
            _ => match found.addresses.iter().find(same_kind) {
                Some(address) => *address,
                None => found.ipv4()?.into(),
            },
        };
        let interface = Some(found.name);
        Ok(Self { ip, interface })
    }

    fn by_route(to: SocketAddr) -> Result<Self> {
        let refused = |error: io::Error| Error::socket("connect to", format!("udp {to}"), &error);
        let any: IpAddr = match to {
            SocketAddr::V4(_) => Ipv4Addr::UNSPECIFIED.into(),
            SocketAddr::V6(_) => Ipv6Addr::UNSPECIFIED.into(),
        };
        let socket = UdpSocket::bind((any, 0)).map_err(refused)?;
        socket.connect(to).map_err(refused)?;
        let ip = socket.local_addr().map_err(refused)?.ip();
        let interfaces = list();
        let found = interfaces.into_iter().find(|found| found.addresses.contains(&ip));
        let interface = found.map(|found| found.name);
        Ok(Self { ip, interface })
    }
}

impl fmt::Display for LocalAddress {
    /// `192.168.1.5 (eth0)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.interface {
            Some(name) => write!(f, "{} ({name})", self.ip),
            None => self.ip.fmt(f),
        }
    }
}

/// The broadcast addresses of every network that this machine is in, or of those of one interface; at least one.
///
/// # Errors
/// [`Error::Interface`] for one that is not there.
pub(crate) fn broadcast_addresses(interface: Option<&Interface>) -> Result<Vec<Ipv4Addr>> {
    let interfaces = match interface {
        Some(wanted) => vec![LocalInterface::find(wanted)?],
        None => list(),
    };
    let mut all: Vec<_> = interfaces.into_iter().flat_map(|found| found.broadcasts).collect();
    // The system's own choice of a network, which counts where none is listed.
    if interface.is_none() || all.is_empty() {
        all.push(Ipv4Addr::BROADCAST);
    }
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

/// The broadcast addresses that a socket bound to this address of the machine's does not hear, though they are meant for it
/// as well. Only Linux lets others be bound for them.
pub(crate) fn broadcasts_beside(address: IpAddr) -> Vec<Ipv4Addr> {
    let IpAddr::V4(own) = address else {
        return Vec::new();
    };
    if cfg!(not(target_os = "linux")) || own.is_unspecified() || own.is_multicast() || own.is_broadcast() {
        return Vec::new();
    }
    let is_on = |found: &LocalInterface| {
        let is_loopback = own.is_loopback() && found.addresses.iter().any(IpAddr::is_loopback);
        is_loopback || found.addresses.contains(&address)
    };
    let mut all: Vec<_> = list()
        .into_iter()
        .filter(is_on)
        .flat_map(|found| found.broadcasts)
        .collect();
    // Nobody sends to all networks by the loopback.
    all.extend((!own.is_loopback()).then_some(Ipv4Addr::BROADCAST));
    all.sort_unstable();
    all.dedup();
    all
}

/// Whether an address is one of this machine's.
pub(crate) fn is_own(address: IpAddr) -> bool {
    address.is_loopback() || list().iter().any(|found| found.addresses.contains(&address))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_loopback_leads_to_itself() {
        let to = ([127, 0, 0, 1], 1510).into();
        let by_route = LocalAddress::towards(to, None).unwrap();
        assert_eq!(by_route.ip, IpAddr::V4(Ipv4Addr::LOCALHOST));
        let name = by_route.interface.clone().unwrap();
        assert_eq!(by_route.to_string(), format!("127.0.0.1 ({name})"));
        let named = LocalAddress::towards(to, Some(&Interface::Name(name)));
        assert_eq!(named, Ok(by_route));
    }

    #[test]
    fn the_loopback_network_has_a_broadcast_address() {
        let loopback = Interface::Address([127, 0, 0, 1].into());
        let addresses = broadcast_addresses(Some(&loopback)).unwrap();
        assert_eq!(addresses, [Ipv4Addr::new(127, 255, 255, 255)]);
        assert!(broadcast_addresses(None).unwrap().contains(&Ipv4Addr::BROADCAST));
        assert!(is_own([127, 0, 0, 1].into()) && !is_own([192, 0, 2, 1].into()));
    }
}
