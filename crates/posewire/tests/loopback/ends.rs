//! How live sources begin and end: nobody there, peers that hang up, and what has arrived at the stop.

use crate::harness::{PATIENCE, Receiver, open};
use posewire::endpoint::{Endpoint, Host};
use posewire::stop::Stop;
use posewire::{Error, Notice, Session};
use posewire_mxtp::body::Body;
use posewire_mxtp::{Datagram, Header, MessageType};
use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

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

/// A place on the loopback where nobody listens.
fn deserted() -> SocketAddr {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap()
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

/// As many datagrams as one write brings to the other side, whether it reads or not.
fn stream() -> Vec<u8> {
    (0..IN_A_WINDOW).flat_map(datagram).collect()
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

#[test]
fn a_stream_that_arrived_before_the_stop_counts_to_its_last_datagram() {
    let source = open("mxtp+tcp://127.0.0.1:0").unwrap();
    let mut peer = TcpStream::connect(place_of(source.endpoint())).unwrap();
    peer.write_all(&stream()).unwrap();
    drop(peer);
    let statistics = Receiver::run(source, stopped()).stop().statistics.unwrap();
    assert_eq!(
        (statistics.datagrams, statistics.skipped_bytes),
        (u64::from(IN_A_WINDOW), 0)
    );
}

#[test]
fn what_an_open_connection_brought_before_the_stop_counts() {
    let receiver = Receiver::start("mxtp+tcp://127.0.0.1:0");
    let mut peer = TcpStream::connect(place_of(&receiver.endpoint)).unwrap();
    peer.write_all(&stream()).unwrap();
    let gathered = receiver.stop();
    // The last one ends where the next begins, which never came.
    assert_eq!(gathered.statistics.unwrap().datagrams, u64::from(IN_A_WINDOW) - 1);
    assert!(matches!(*gathered.notices, [Notice::Connected { .. }]));
}

#[test]
fn connections_are_closed_when_the_session_has_ended() {
    let receiver = Receiver::start("mxtp+tcp://127.0.0.1:0");
    let place = place_of(&receiver.endpoint);
    let mut peers = [place; 3].map(|place| TcpStream::connect(place).unwrap());
    receiver.gatherer.wait_until(|gathered| gathered.notices.len() == 3);
    receiver.stop();
    for peer in &mut peers {
        peer.set_nonblocking(true).unwrap();
        assert_eq!(peer.read(&mut [0]).unwrap(), 0);
    }
    assert_eq!(
        TcpStream::connect(place).unwrap_err().kind(),
        ErrorKind::ConnectionRefused
    );
}

#[test]
fn a_live_source_without_sinks_ends() {
    let calling = format!("mxtp+tcp://{}?mode=connect", deserted());
    for endpoint in ["mxtp://127.0.0.1:0", "mxtp+tcp://127.0.0.1:0", &calling] {
        let session = Session::start([open(endpoint).unwrap()], Vec::new(), Stop::new());
        let (done, ended) = mpsc::channel();
        thread::spawn(move || done.send(session.wait()));
        let outcome = ended.recv_timeout(PATIENCE);
        assert!(outcome.expect(endpoint).is_ok());
    }
}

#[test]
fn a_streamer_with_an_unknown_name_is_an_error_at_once() {
    // A label may not be longer than 63 bytes, so no resolver asks the network for this one.
    let host = "x".repeat(64);
    let error = open(&format!("mxtp+tcp://{host}:9763?mode=connect")).unwrap_err();
    assert!(matches!(error, Error::Resolve { host: found, .. } if found == host));
}

#[test]
fn a_streamer_that_is_not_there_is_told_of_once() {
    let place = deserted();
    let receiver = Receiver::start(&format!("mxtp+tcp://{place}?mode=connect"));
    // The first statistics come after a second, in which several attempts fail.
    receiver.gatherer.wait_until(|gathered| gathered.statistics.is_some());
    let notices = receiver.stop().notices;
    let [notice @ Notice::NotConnected { error }] = notices.as_slice() else {
        panic!("{notices:?}");
    };
    assert!(matches!(
        error,
        Error::Socket {
            kind: ErrorKind::ConnectionRefused,
            ..
        }
    ));
    let told = notice.to_string();
    assert!(told.starts_with(&format!("cannot connect to tcp {place}: ")));
    assert!(told.ends_with("; trying again"));
}

#[test]
fn a_streamer_that_hangs_up_is_called_less_and_less_often() {
    let streamer = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = streamer.local_addr().unwrap();
    let receiver = Receiver::start(&format!("mxtp+tcp://{place}?mode=connect"));
    let begun = Instant::now();
    for _ in 0..4 {
        drop(streamer.accept().unwrap());
    }
    assert!(begun.elapsed() >= Duration::from_millis(100 + 200 + 400 - 50));
    receiver.stop();
}

/// 36 kB: TCP sends 64 KiB unasked.
const IN_A_WINDOW: u32 = 50;
