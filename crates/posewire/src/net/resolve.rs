//! From host names to addresses.

use std::net::{SocketAddr, ToSocketAddrs};

use crate::endpoint::Host;
use crate::error::{self, Error, Result};

/// The addresses of a host, at least one, IPv4 before IPv6: most capture systems speak IPv4 only,
/// and a receiver on 0.0.0.0 does not hear `::1`.
///
/// Asks the system's resolver for a name, which may take seconds.
///
/// # Errors
/// [`Error::Resolve`] when the name leads nowhere.
pub fn resolve(host: &Host, port: u16) -> Result<Vec<SocketAddr>> {
    let name = match host {
        Host::Address(address) => return Ok(vec![SocketAddr::new(*address, port)]),
        Host::Name(name) => name,
    };
    let failure = |reason: String| Error::Resolve {
        host: name.clone(),
        reason,
    };
    let found = (name.as_str(), port)
        .to_socket_addrs()
        .map_err(|error| failure(error::reason(&error)))?;
    let mut addresses: Vec<_> = found.collect();
    addresses.sort_by_key(SocketAddr::is_ipv6);
    if addresses.is_empty() {
        return Err(failure("it has none".into()));
    }
    Ok(addresses)
}

/// The first address of a host: the one that datagrams go to.
pub(crate) fn resolve_first(host: &Host, port: u16) -> Result<SocketAddr> {
    let addresses = resolve(host, port)?;
    addresses.first().copied().ok_or_else(|| Error::Resolve {
        host: host.to_string(),
        reason: "it has none".into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_numeric_host_is_its_own_address() {
        let host = Host::Address("::1".parse().unwrap());
        assert_eq!(resolve(&host, 5), Ok(vec!["[::1]:5".parse().unwrap()]));
    }

    #[test]
    fn localhost_comes_as_ipv4_first() {
        let addresses = resolve(&Host::Name("localhost".into()), 5).unwrap();
        assert_eq!(addresses.first(), Some(&"127.0.0.1:5".parse().unwrap()));
    }

    #[test]
    fn a_name_that_is_none_is_an_error() {
        // A label may not be longer than 63 bytes, so no resolver asks the network for this one.
        let host = Host::Name("x".repeat(64));
        assert!(matches!(resolve(&host, 5), Err(Error::Resolve { .. })));
    }
}
