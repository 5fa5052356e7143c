//! Servers that a broadcast finds, or that answer from another address. Other systems have one loopback address only.

use super::motive::{Motive, Sockets, bodies, of_version};
use crate::harness::{Gatherer, PATIENCE, Receiver, open};
use posewire::endpoint::{Endpoint, NatNetAddress};
use posewire::sink::{NatNetSink, NatNetSinkOptions};
use posewire::stop::Stop;
use posewire::{Error, Notice, Session, Sink};
use posewire_natnet::command::{Sender, ServerInfo};
use posewire_natnet::{Message, MessageId, Packet, Version};
use std::net::UdpSocket;
use std::sync::mpsc;
use std::thread;

/// Answers the first question that comes to `asked` from other sockets, as the servers of these names and addresses.
fn answer_as(asked: &UdpSocket, servers: &[(&str, UdpSocket)]) {
    let mut buffer = [0; 2048];
    let (length, from) = asked.recv_from(&mut buffer).unwrap();
    let packet = Packet::decode(&buffer[..length]).unwrap();
    assert_eq!(packet.id, MessageId::DISCOVERY);
    for (name, socket) in servers {
        let server = Sender {
            name: (*name).into(),
            app_version: Version::new(3, 1),
            natnet_version: Version::new(4, 1),
        };
        let info = ServerInfo {
            server,
            connection: None,
        };
        let mut bytes = Vec::new();
        Message::ServerInfo(info).encode(Version::LATEST, &mut bytes).unwrap();
        socket.send_to(&bytes, from).unwrap();
    }
}

/// A socket that hears broadcasts on the loopback, and what to call it from there.
fn asked() -> (UdpSocket, String) {
    let asked = UdpSocket::bind("0.0.0.0:0").unwrap();
    asked.set_read_timeout(Some(PATIENCE)).unwrap();
    let port = asked.local_addr().unwrap().port();
    (asked, format!("natnet://0.0.0.0:{port}?interface=127.0.0.1"))
}

#[test]
fn the_only_server_is_connected_to() {
    let motive = Motive::unicast(Version::new(4, 1), bodies(&["Wand"]));
    let (asked, url) = asked();
    let receiver = Receiver::start(&url);
    // The server itself does not hear broadcasts, as it is bound to one address; its answer comes from there all the same.
    let mut buffer = [0; 2048];
    let (length, from) = asked.recv_from(&mut buffer).unwrap();
    motive.take(from, &buffer[..length]);
    motive.send_until(&receiver, 1, |gathered| !gathered.frames.is_empty());
    let gathered = receiver.stop();
    assert_eq!(gathered.frames[0].subject.name, "Wand");
    assert_eq!(gathered.server().address, motive.command());
}

/// Bound to one address, a socket hears no broadcast.
#[test]
fn a_sink_at_one_address_is_found_by_a_broadcast() {
    let Ok(Endpoint::NatNet(address)) = "natnet://127.0.0.1:0?data-port=0".parse() else {
        panic!()
    };
    let mut sink = NatNetSink::open(&address, NatNetSinkOptions::default()).unwrap();
    let opened = sink.progress().lock().unwrap().targets[0].endpoint.clone();
    let Ok(Endpoint::NatNet(NatNetAddress { port, .. })) = opened.parse() else {
        panic!("{opened}")
    };
    let receiver = Receiver::start(&format!("natnet://0.0.0.0:{port}?interface=127.0.0.1"));
    let is_there = |notice: &Notice| matches!(notice, Notice::Connected { .. });
    receiver
        .gatherer
        .wait_until(|gathered| gathered.notices.iter().any(is_there));
    assert_eq!(receiver.stop().server().address, ([127, 0, 0, 1], port).into());
    sink.finish().unwrap();
}

#[test]
fn two_servers_are_named_so_that_one_can_be_chosen() {
    let (asked, url) = asked();
    let servers = [("Left", "127.0.0.1:0"), ("Right", "127.0.0.2:0")];
    let servers = servers.map(|(name, at)| (name, UdpSocket::bind(at).unwrap()));
    let [first, second] = [&servers[0], &servers[1]].map(|(_, socket)| socket.local_addr().unwrap());
    let sink = Box::new(Gatherer::default());
    let session = Session::start([open(&url).unwrap()], vec![sink], Stop::new());
    answer_as(&asked, &servers);
    let (done, ended) = mpsc::channel();
    thread::spawn(move || done.send(session.wait()));
    let error = ended.recv_timeout(PATIENCE).unwrap().unwrap_err();
    let found = vec![
        format!("Left 3.1, NatNet 4.1, at {first}"),
        format!("Right 3.1, NatNet 4.1, at {second}"),
    ];
    assert_eq!(error, Error::SeveralServers { found });
    assert!(error.help().is_some());
}

#[test]
fn a_server_that_answers_from_another_of_its_addresses_is_the_same() {
    let everywhere = Sockets::bind_at(([0, 0, 0, 0], 0).into());
    let port = everywhere.command().port();
    let motive = everywhere.serve(of_version(Version::new(4, 1)), bodies(&["Wand"]));
    let receiver = Receiver::start(&format!("natnet://127.0.0.2:{port}"));
    motive.send_until(&receiver, 1, |gathered| gathered.frames.len() > 3);
    assert_eq!(receiver.stop().server().address, ([127, 0, 0, 2], port).into());
}

#[test]
fn a_search_ends_at_the_stop() {
    let (_asked, url) = asked();
    let receiver = Receiver::start(&url);
    let gathered = receiver.stop();
    assert!(gathered.statistics.unwrap().server.is_none());
}
