use super::*;
use crate::endpoint::{Host, Interface};
use crate::net::UdpSender;

const SOON: Duration = Duration::from_secs(5);

fn loopback(port: u16) -> UdpAddress {
    UdpAddress::new(Host::Address(Ipv4Addr::LOCALHOST.into()), port)
}

fn pair() -> (UdpSender, UdpReceiver) {
    let receiver = UdpReceiver::bind(&loopback(0)).unwrap();
    let sender = UdpSender::open(&loopback(receiver.local_address().port())).unwrap();
    (sender, receiver)
}

/// Receives until `count` datagrams came or nothing came for long.
fn take(receiver: &mut UdpReceiver, count: usize) -> Vec<Vec<u8>> {
    let mut taken = Vec::new();
    while taken.len() < count {
        let got = receiver.receive(SOON, |received| taken.push(received.bytes.to_vec()));
        if got.unwrap() == 0 {
            break;
        }
    }
    taken
}

#[test]
fn datagrams_of_every_length_arrive_whole_and_in_order() {
    let (mut sender, mut receiver) = pair();
    let sent: Vec<_> = [0, 1, 760, 2040, 9000, 65_507]
        .into_iter()
        .map(|length| vec![length as u8; length])
        .collect();
    for datagram in &sent {
        sender.send(datagram).unwrap();
    }
    assert_eq!(take(&mut receiver, sent.len()), sent);
}

#[test]
fn a_datagram_comes_with_its_sender_and_a_utc_stamp() {
    let (mut sender, mut receiver) = pair();
    let before = crate::clock::now();
    sender.send(b"MXTP").unwrap();
    let mut seen = None;
    let count = receiver.receive(SOON, |received| seen = Some((received.from, received.stamp)));
    assert_eq!(count, Ok(1));
    let (from, stamp) = seen.unwrap();
    assert_eq!(from.port(), sender.local_address().port());
    // The clock may be corrected meanwhile, but not by a minute.
    assert!((stamp - before).abs() < 60_000_000_000, "{stamp:?} against {before:?}");
}

#[test]
fn a_quiet_socket_gives_nothing_in_time() {
    let (_sender, mut receiver) = pair();
    assert_eq!(receiver.receive(Duration::ZERO, |_| ()), Ok(0));
    assert_eq!(receiver.receive(Duration::from_millis(1), |_| ()), Ok(0));
}

#[test]
fn the_portable_reader_does_the_same() {
    let (mut sender, receiver) = pair();
    let mut reader = portable::Reader::new(&receiver.socket).unwrap();
    sender.send(b"MXTP").unwrap();
    receiver.socket.set_read_timeout(Some(SOON)).unwrap();
    let mut seen = Vec::new();
    let count = reader.receive(&receiver.socket, true, &mut |received| {
        seen = received.bytes.to_vec();
    });
    assert_eq!((count.unwrap(), seen.as_slice()), (1, b"MXTP".as_slice()));
    let nothing = reader.receive(&receiver.socket, false, &mut |_| ()).unwrap_err();
    assert!(is_nothing(&nothing));
    assert_eq!(reader.kernel_dropped(), 0);
}

#[test]
fn a_port_in_use_is_a_clear_error() {
    let (_sender, receiver) = pair();
    let local = receiver.local_address();
    let error = UdpReceiver::bind(&loopback(local.port())).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with(&format!("cannot listen on udp {local}: "))
    );
    let help = format!("another program listens on {local}: stop it or choose another port");
    assert_eq!(error.help(), Some(help));
}

#[test]
fn a_foreign_address_is_a_clear_error() {
    let host = Host::Address([192, 0, 2, 250].into());
    let error = UdpReceiver::bind(&UdpAddress::new(host, 0)).unwrap_err();
    assert!(error.help().unwrap().contains("not an address of this machine"));
}

#[test]
fn ipv4_senders_reach_a_receiver_on_every_address() {
    let host = Host::Address(Ipv6Addr::UNSPECIFIED.into());
    let Ok(mut receiver) = UdpReceiver::bind(&UdpAddress::new(host, 0)) else {
        println!("skipped: no IPv6 here");
        return;
    };
    let mut sender = UdpSender::open(&loopback(receiver.local_address().port())).unwrap();
    sender.send(b"MXTP").unwrap();
    let mut from = None;
    receiver.receive(SOON, |received| from = Some(received.from)).unwrap();
    assert_eq!(from, Some(on_loopback(sender.local_address())));
}

/// The sender is bound to every address, and was seen at the one it sent from.
fn on_loopback(local: SocketAddr) -> SocketAddr {
    SocketAddr::new(Ipv4Addr::LOCALHOST.into(), local.port())
}

#[cfg(target_os = "linux")]
#[test]
fn what_the_kernel_drops_is_counted() {
    let (mut sender, mut receiver) = pair();
    let size = receiver.receive_buffer().unwrap();
    // Room for no more than this many payloads, whatever the bookkeeping.
    let sent = 2 * size / 8192 + 64;
    for _ in 0..sent {
        sender.send(&[0; 8192]).unwrap();
    }
    let mut taken = 0;
    while receiver.receive(Duration::ZERO, |_| taken += 1).unwrap() > 0 {}
    assert!(taken < sent, "the buffer held all {sent}");
    // The count travels with a datagram that found room.
    sender.send(b"last").unwrap();
    assert_eq!(take(&mut receiver, 1).len(), 1);
    assert_eq!(taken as u64 + receiver.kernel_dropped(), sent as u64);
}

fn group_on_loopback(group: IpAddr, port: u16) -> UdpAddress {
    UdpAddress {
        interface: Some(Interface::Address(Ipv4Addr::LOCALHOST.into())),
        ..UdpAddress::new(Host::Address(group), port)
    }
}

fn multicast_arrives(group: IpAddr) {
    let mut receiver = match UdpReceiver::bind(&group_on_loopback(group, 0)) {
        Ok(receiver) => receiver,
        Err(error) => return println!("skipped: no multicast on loopback here: {error}"),
    };
    let port = receiver.local_address().port();
    let mut second = UdpReceiver::bind(&group_on_loopback(group, port)).unwrap();
    let mut sender = UdpSender::open(&group_on_loopback(group, port)).unwrap();
    if let Err(error) = sender.send(b"MXTP") {
        return println!("skipped: no route for multicast on loopback here: {error}");
    }
    assert_eq!(take(&mut receiver, 1), [b"MXTP"]);
    assert_eq!(take(&mut second, 1), [b"MXTP"]);
}

#[test]
fn ipv4_multicast_reaches_every_member_of_the_group() {
    multicast_arrives([239, 255, 42, 99].into());
}

#[test]
fn ipv6_multicast_reaches_every_member_of_the_group() {
    multicast_arrives("ff02::4d58".parse().unwrap());
}

#[cfg(target_os = "linux")]
#[test]
fn an_interface_by_name_is_the_only_one_listened_on() {
    let name = LocalInterface::find(&Interface::Address(Ipv4Addr::LOCALHOST.into()))
        .unwrap()
        .name;
    let everywhere = UdpAddress {
        interface: Some(Interface::Name(name)),
        ..UdpAddress::new(Host::Address(Ipv4Addr::UNSPECIFIED.into()), 0)
    };
    let mut receiver = match UdpReceiver::bind(&everywhere) {
        Ok(receiver) => receiver,
        Err(error) => return println!("skipped: interfaces cannot be chosen here: {error}"),
    };
    let mut sender = UdpSender::open(&loopback(receiver.local_address().port())).unwrap();
    sender.send(b"MXTP").unwrap();
    assert_eq!(take(&mut receiver, 1), [b"MXTP"]);
}
