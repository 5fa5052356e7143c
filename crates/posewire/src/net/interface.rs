//! Network interfaces by name or address.

use std::net::{IpAddr, Ipv4Addr};

use crate::endpoint::Interface;
use crate::error::{Error, Result};

/// One interface of this machine, with everything that sockets need to name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LocalInterface {
    /// The system's name for it.
    pub(crate) name: String,
    /// The system's number for it; what IPv6 wants.
    pub(crate) index: u32,
    /// Its addresses.
    pub(crate) addresses: Vec<IpAddr>,
    /// The broadcast addresses of its IPv4 networks.
    pub(crate) broadcasts: Vec<Ipv4Addr>,
}

impl LocalInterface {
    /// The interface that `wanted` names.
    ///
    /// # Errors
    /// [`Error::Interface`], which lists the interfaces that are there.
    pub(super) fn find(wanted: &Interface) -> Result<Self> {
        let all = list();
        match all.iter().find(|interface| interface.is(wanted)) {
            Some(found) => Ok(found.clone()),
            None => match wanted {
                // Where nothing lists the interfaces, the system judges the address.
                Interface::Address(address) if cfg!(not(unix)) => Ok(Self {
                    name: address.to_string(),
                    index: 0,
                    addresses: vec![*address],
                    broadcasts: Vec::new(),
                }),
                _ => Err(refusal(wanted, "does not exist here", &all)),
            },
        }
    }

    /// Its IPv4 address, which IPv4 multicast goes by.
    ///
    /// # Errors
    /// [`Error::Interface`] when it has none.
    pub(super) fn ipv4(&self) -> Result<Ipv4Addr> {
        let found = self.addresses.iter().find_map(|address| match address {
            IpAddr::V4(address) => Some(*address),
            IpAddr::V6(_) => None,
        });
        let name = Interface::Name(self.name.clone());
        found.ok_or_else(|| refusal(&name, "has no IPv4 address", &list()))
    }

    fn is(&self, wanted: &Interface) -> bool {
        match wanted {
            Interface::Name(name) => self.name == *name,
            Interface::Address(address) => self.addresses.contains(address),
        }
    }
}

fn refusal(wanted: &Interface, problem: &'static str, all: &[LocalInterface]) -> Error {
    let describe = |interface: &LocalInterface| {
        let addresses: Vec<_> = interface.addresses.iter().map(ToString::to_string).collect();
        format!("{} ({})", interface.name, addresses.join(" "))
    };
    Error::Interface {
        name: wanted.to_string(),
        problem,
        available: all.iter().map(describe).collect(),
    }
}

/// The interfaces that have an address.
#[cfg(unix)]
pub(crate) fn list() -> Vec<LocalInterface> {
    let mut all: Vec<LocalInterface> = Vec::new();
    for entry in nix::ifaddrs::getifaddrs().into_iter().flatten() {
        let Some(address) = entry.address.as_ref().and_then(ip_of) else {
            continue;
        };
        let broadcast = entry
            .netmask
            .as_ref()
            .and_then(ip_of)
            .and_then(|mask| broadcast_of(address, mask));
        let name = entry.interface_name;
        match all.iter_mut().find(|interface| interface.name == name) {
            Some(interface) => {
                interface.addresses.push(address);
                interface.broadcasts.extend(broadcast);
            }
            None => all.push(LocalInterface {
                index: nix::net::if_::if_nametoindex(name.as_str()).unwrap_or(0),
                name,
                addresses: vec![address],
                broadcasts: broadcast.into_iter().collect(),
            }),
        }
    }
    all
}

/// The last address of a network; `None` for a network of one.
#[cfg(unix)]
fn broadcast_of(address: IpAddr, mask: IpAddr) -> Option<Ipv4Addr> {
    let (IpAddr::V4(address), IpAddr::V4(mask)) = (address, mask) else {
        return None;
    };
    (mask != Ipv4Addr::BROADCAST).then(|| address | !mask)
}

#[cfg(unix)]
fn ip_of(address: &nix::sys::socket::SockaddrStorage) -> Option<IpAddr> {
    let v4 = address.as_sockaddr_in().map(|v4| IpAddr::V4(v4.ip()));
    v4.or_else(|| address.as_sockaddr_in6().map(|v6| IpAddr::V6(v6.ip())))
}

/// Nothing lists them here, so an interface is chosen by its address only.
#[cfg(not(unix))]
pub(crate) fn list() -> Vec<LocalInterface> {
    Vec::new()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_loopback_interface_is_found_by_address_and_by_name() {
        let address = Interface::Address([127, 0, 0, 1].into());
        let by_address = LocalInterface::find(&address).unwrap();
        let name = Interface::Name(by_address.name.clone());
        assert_eq!(LocalInterface::find(&name), Ok(by_address.clone()));
        assert_eq!(by_address.ipv4(), Ok(Ipv4Addr::LOCALHOST));
        assert!(by_address.index > 0);
    }

    #[test]
    fn a_missing_interface_is_answered_with_those_that_are_there() {
        let error = LocalInterface::find(&Interface::Name("no such".into())).unwrap_err();
        assert_eq!(error.to_string(), "network interface \"no such\" does not exist here");
        assert!(error.help().unwrap().contains("127.0.0.1"));
    }
}
