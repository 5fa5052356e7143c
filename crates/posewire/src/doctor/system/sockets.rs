//! Sockets as Linux lists them.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

/// A socket, a line of `/proc/net/udp` or `/proc/net/tcp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SocketLine {
    pub(super) transport: Transport,
    pub(super) local: SocketAddr,
    /// Whose it is.
    pub(super) user: u32,
    /// What a process that has it calls it.
    pub(super) inode: u64,
    /// Datagrams that found no room in its buffer.
    pub(super) drops: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Transport {
    Udp,
    Tcp,
}

impl Transport {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Udp => "udp",
            Self::Tcp => "tcp",
        }
    }
}

/// The sockets of a list that wait for somebody: bound ones of UDP, listening ones of TCP. What is not understood is passed
/// over.
pub(super) fn waiting(transport: Transport, list: &str) -> impl Iterator<Item = SocketLine> {
    list.lines().skip(1).filter_map(move |line| parse(transport, line))
}

fn parse(transport: Transport, line: &str) -> Option<SocketLine> {
    let mut words = line.split_whitespace().skip(1);
    let local = address(words.next()?)?;
    let state = words.nth(1)?;
    let is_waiting = match transport {
        Transport::Udp => state == UNCONNECTED,
        Transport::Tcp => state == LISTENING,
    };
    let user = words.nth(3)?.parse().ok()?;
    let inode = words.nth(1)?.parse().ok()?;
    let drops = words.nth(2).and_then(|drops| drops.parse().ok());
    let drops = drops.filter(|_| transport == Transport::Udp).unwrap_or(0);
    is_waiting.then_some(SocketLine {
        transport,
        local,
        user,
        inode,
        drops,
    })
}

/// `0100007F:2623`: words of 32 bits in the machine's own order, then the port.
fn address(text: &str) -> Option<SocketAddr> {
    let (ip, port) = text.split_once(':')?;
    let port = u16::from_str_radix(port, 16).ok()?;
    let ip: IpAddr = match ip.len() {
        8 => Ipv4Addr::from(word(ip)?).into(),
        32 => {
            let mut octets = [0; 16];
            for (place, part) in octets.chunks_exact_mut(4).enumerate() {
                part.copy_from_slice(&word(ip.get(place * 8..place * 8 + 8)?)?);
            }
            Ipv6Addr::from(octets).to_canonical()
        }
        _ => return None,
    };
    Some(SocketAddr::new(ip, port))
}

/// Four bytes that were printed as a number of the machine.
pub(super) fn word(digits: &str) -> Option<[u8; 4]> {
    u32::from_str_radix(digits, 16).ok().map(u32::to_ne_bytes)
}

const UNCONNECTED: &str = "07";
const LISTENING: &str = "0A";

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// As the kernel prints it on this machine.
    fn printed(octets: [u8; 4]) -> String {
        format!("{:08X}", u32::from_ne_bytes(octets))
    }

    #[test]
    fn a_line_of_udp_tells_its_port_its_inode_and_its_drops() {
        let list = format!(
            "  sl  local_address rem_address   st\n 12: {}:2623 00000000:0000 07 00000000:00000A00 00:00000000 00000000  1000        \
             0 40960 2 00000000ed114a52 17\n 13: {}:2624 0100007F:0001 01 00000000:00000000 00:00000000 00000000  1000 0 1 2 0 0\n",
            printed([127, 0, 0, 1]),
            printed([127, 0, 0, 1]),
        );
        let found: Vec<_> = waiting(Transport::Udp, &list).collect();
        let expected = SocketLine {
            transport: Transport::Udp,
            local: ([127, 0, 0, 1], 9763).into(),
            user: 1000,
            inode: 40960,
            drops: 17,
        };
        assert_eq!(found, [expected]);
    }

    #[test]
    fn a_listening_socket_of_tcp_over_ipv6_is_found() {
        let list = format!(
            "sl\n 0: {}:2623 {}:0000 0A 00000000:00000000 00:00000000 00000000 0 0 129 1 0 100 0 0 10 0\n",
            "0".repeat(32),
            "0".repeat(32)
        );
        let found: Vec<_> = waiting(Transport::Tcp, &list).collect();
        assert_eq!(found[0].local, "[::]:9763".parse().unwrap());
        assert_eq!((found[0].inode, found[0].drops), (129, 0));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_passed_over(text in "[ -~\\n]{0,200}", line in "(\\PC{0,8} ){0,14}") {
            let list = format!("{text}\n{line}");
            let _ = waiting(Transport::Udp, &list).count() + waiting(Transport::Tcp, &list).count();
        }
    }
}
