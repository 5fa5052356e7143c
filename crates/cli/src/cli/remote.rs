//! Where remote control is taken.

use std::net::{Ipv4Addr, SocketAddr};

/// A port on this machine's loopback, or an address with a port.
pub(super) fn remote(text: &str) -> Result<SocketAddr, String> {
    if let Ok(port) = text.parse::<u16>() {
        return Ok((Ipv4Addr::LOCALHOST, port).into());
    }
    let expected = "expected a port, as in 6004, or ADDRESS:PORT, as in 0.0.0.0:6004";
    text.parse().map_err(|_| expected.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_alone_is_one_of_the_loopback() {
        assert_eq!(remote("6004"), Ok(([127, 0, 0, 1], 6004).into()));
        assert_eq!(remote("0.0.0.0:6004"), Ok(([0, 0, 0, 0], 6004).into()));
        assert_eq!(remote("[::1]:0"), Ok("[::1]:0".parse().unwrap()));
        for wrong in ["", "stage", "127.0.0.1", "65536"] {
            assert!(remote(wrong).is_err(), "{wrong}");
        }
    }
}
