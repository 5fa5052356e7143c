//! How live sources end: what has arrived at the stop.

use crate::harness::{Receiver, open};
use posewire::endpoint::{Endpoint, Host};
use posewire::stop::Stop;
use posewire_mxtp::body::Body;
use posewire_mxtp::{Datagram, Header, MessageType};
use std::net::{SocketAddr, UdpSocket};

/// Where a source on a numeric address can be reached.
fn place_of(endpoint: &Endpoint) -> SocketAddr {
    let (host, port) = match endpoint {
        Endpoint::MxtpUdp(address) => (&address.host, address.port),
        Endpoint::MxtpTcp(address) => (&address.host, address.port),
        other => panic!("{other} is not on the network"),
    };
    let Host::Address(address) = host else {
        panic!("{host} is a name");
    };
    SocketAddr::new(*address, port)
}

/// A datagram of a type that nobody knows, which does not say how long it is.
fn datagram(sample: u32) -> Vec<u8> {
    let header = Header::rev_j(MessageType::new(99).unwrap(), sample, 0);
    let mut bytes = Vec::new();
    Datagram::new(header, Body::Opaque(&[7; 700]))
        .unwrap()
        .encode(&mut bytes);
    bytes
}

fn stopped() -> Stop {
    let stop = Stop::new();
    stop.stop();
    stop
}

#[test]
fn datagrams_that_arrived_before_the_stop_count() {
    let source = open("mxtp://127.0.0.1:0").unwrap();
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    for sample in 0..100 {
        let sent = sender.send_to(&datagram(sample), place_of(source.endpoint()));
        assert_eq!(sent.unwrap(), 724);
    }
    let statistics = Receiver::run(source, stopped()).stop().statistics.unwrap();
    assert_eq!((statistics.datagrams, statistics.kernel_dropped), (100, 0));
}
