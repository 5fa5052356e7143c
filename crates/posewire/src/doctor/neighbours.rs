//! What comes beside the endpoint: by the other transport, and to other ports that are usual.

use super::protocol::Guess;
use super::silence::Elsewhere;
use crate::endpoint::{Endpoint, Host, TcpAddress, TcpMode, UdpAddress};
use crate::net;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, UdpSocket};

/// The same port by the other transport. It is held only while an endpoint is listened to.
#[derive(Debug)]
pub(super) enum OtherTransport {
    Tcp(TcpListener),
    Udp(UdpSocket),
}

impl OtherTransport {
    /// `None` where there is none, or where another program has it.
    pub(super) fn open(endpoint: &Endpoint) -> Option<Self> {
        match endpoint {
            Endpoint::MxtpUdp(address) => {
                let listener = TcpListener::bind(own(&address.host, address.port)?).ok()?;
                listener.set_nonblocking(true).ok()?;
                Some(Self::Tcp(listener))
            }
            Endpoint::MxtpTcp(address) if address.mode != Some(TcpMode::Connect) => {
                Some(Self::Udp(open(own(&address.host, address.port)?)?))
            }
            _ => None,
        }
    }

    /// The same port of UDP where an endpoint is of TCP, and the other way round.
    pub(super) fn endpoint(of: &Endpoint) -> Option<Endpoint> {
        match of {
            Endpoint::MxtpUdp(address) => {
                let tcp = TcpAddress::new(address.host.clone(), address.port);
                Some(Endpoint::MxtpTcp(tcp))
            }
            Endpoint::MxtpTcp(address) if address.mode != Some(TcpMode::Connect) => {
                let udp = UdpAddress::new(address.host.clone(), address.port);
                Some(Endpoint::MxtpUdp(udp))
            }
            _ => None,
        }
    }

    /// Who has come by it.
    pub(super) fn heard(&self) -> Option<SocketAddr> {
        match self {
            Self::Tcp(listener) => listener.accept().ok().map(|(_, from)| from),
            Self::Udp(socket) => socket.recv_from(&mut [0; 64]).ok().map(|(_, from)| from),
        }
    }
}

/// Other ports that are usual for motion capture.
#[derive(Debug)]
pub(super) struct OtherPorts(Vec<UdpSocket>);

impl OtherPorts {
    /// Those that no other program has; `None` for a protocol that has no other ports.
    pub(super) fn open(endpoint: &Endpoint) -> Option<Self> {
        let (host, port) = match endpoint {
            Endpoint::MxtpUdp(address) => (&address.host, address.port),
            Endpoint::MxtpTcp(address) => (&address.host, address.port),
            _ => return None,
        };
        let others = USUAL.iter().filter(|other| **other != port);
        Some(Self::bind(others.filter_map(|other| own(host, *other))))
    }

    fn bind(places: impl Iterator<Item = SocketAddr>) -> Self {
        Self(places.filter_map(open).collect())
    }

    /// The first datagram that came to each.
    pub(super) fn heard(&self) -> Vec<Elsewhere> {
        let first = |socket: &UdpSocket| {
            let mut bytes = vec![0; 65_535];
            let (length, from) = socket.recv_from(&mut bytes).ok()?;
            Some(Elsewhere {
                port: socket.local_addr().ok()?.port(),
                from,
                guess: Guess::of(bytes.get(..length)?),
            })
        };
        self.0.iter().filter_map(first).collect()
    }
}

fn open(at: SocketAddr) -> Option<UdpSocket> {
    let socket = UdpSocket::bind(at).ok()?;
    socket.set_nonblocking(true).ok()?;
    Some(socket)
}

/// An address that is this machine's: a group's members are sent to by theirs.
fn own(host: &Host, port: u16) -> Option<SocketAddr> {
    let at = net::resolve_first(host, port).ok()?;
    let is_everybody = at.ip().is_multicast() || at.ip() == IpAddr::V4(Ipv4Addr::BROADCAST);
    let is_free = port != 0;
    is_free.then(|| {
        if is_everybody {
            (Ipv4Addr::UNSPECIFIED, port).into()
        } else {
            at
        }
    })
}

/// MVN's two streams.
const USUAL: [u16; 2] = [crate::endpoint::DEFAULT_PORT, 9764];

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpStream;

    fn loopback() -> Host {
        Host::Address([127, 0, 0, 1].into())
    }

    #[test]
    fn what_comes_to_another_port_is_told_with_what_it_is() {
        let any_port = SocketAddr::from(([127, 0, 0, 1], 0));
        let ports = OtherPorts::bind([any_port, any_port].into_iter());
        assert_eq!(ports.heard(), []);
        let sender = UdpSocket::bind(any_port).unwrap();
        let port = ports.0[1].local_addr().unwrap().port();
        sender.send_to(b"XTLP\x01\0", ("127.0.0.1", port)).unwrap();
        let expected = Elsewhere {
            port,
            from: sender.local_addr().unwrap(),
            guess: Guess::Xtlp,
        };
        assert_eq!(ports.heard(), [expected]);
    }

    #[test]
    fn who_connects_to_a_port_of_udp_or_sends_to_one_of_tcp_is_heard() {
        let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
        let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let of_udp = Endpoint::MxtpUdp(UdpAddress::new(loopback(), port));
        let of_tcp = Endpoint::MxtpTcp(TcpAddress::new(loopback(), port));
        // Another test may have got one of them meanwhile.
        if let Some(by_tcp) = OtherTransport::open(&of_udp) {
            assert_eq!(by_tcp.heard(), None);
            let peer = TcpStream::connect(("127.0.0.1", port)).unwrap();
            assert_eq!(by_tcp.heard(), Some(peer.local_addr().unwrap()));
        }
        if let Some(by_udp) = OtherTransport::open(&of_tcp) {
            sender.send_to(b"MXTP02", ("127.0.0.1", port)).unwrap();
            assert_eq!(by_udp.heard(), Some(sender.local_addr().unwrap()));
        }
    }
}
