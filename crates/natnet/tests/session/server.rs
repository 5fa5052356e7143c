//! The server against what real clients do.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use posewire_motion::Stamp;
use posewire_natnet::command::{Connect, ConnectOptions, EchoRequest, Response, Sender, Text};
use posewire_natnet::frame::{Frame, FrameParams, RigidBody, Skeleton};
use posewire_natnet::model::{Description, RigidBodyDescription, SkeletonDescription};
use posewire_natnet::server::{Delivery, Event, LeftReason, Server, ServerOptions};
use posewire_natnet::{Error, Message, MessageId, Name, Output, Packet, Socket, Transmit, Version};

use crate::network::{START, client_address, frame, model};

fn server() -> Server {
    Server::new(ServerOptions::default())
}

fn encoded(message: &Message) -> Vec<u8> {
    let mut bytes = Vec::new();
    message.encode(Version::LATEST, &mut bytes).unwrap();
    bytes
}

fn client(n: u8) -> SocketAddr {
    ([10, 0, 1, n], 50_000).into()
}

fn connect(server: &mut Server, from: SocketAddr, wish: Option<Version>) {
    let options = wish.map(|bitstream_version| ConnectOptions {
        subscribed_only: false,
        bitstream_version,
    });
    let connect = Message::Connect(Connect::new(Sender::default(), options));
    server.handle(START, from, &encoded(&connect));
}

fn drain(server: &mut Server) -> (Vec<Event>, Vec<Transmit>) {
    let (mut events, mut transmits) = (Vec::new(), Vec::new());
    while let Some(output) = server.poll() {
        match output {
            Output::Event(event) => events.push(event),
            Output::Transmit(transmit) => transmits.push(transmit),
        }
    }
    (events, transmits)
}

/// What the server answers to one message of a client.
fn ask(server: &mut Server, message: &Message) -> Vec<Message> {
    server.handle(START, client_address(), &encoded(message));
    let (_, transmits) = drain(server);
    let decode = |transmit: &Transmit| {
        assert_eq!((transmit.to, transmit.socket), (client_address(), Socket::Command));
        Message::decode(Version::new(4, 1), &transmit.bytes).unwrap().0
    };
    transmits.iter().map(decode).collect()
}

fn granted(connect: &Connect) -> (Version, usize) {
    let mut server = server();
    server.handle(START, client_address(), &encoded(&Message::Connect(connect.clone())));
    let (_, transmits) = drain(&mut server);
    let [transmit] = &transmits[..] else {
        panic!("{transmits:?}")
    };
    let (message, _) = Message::decode(Version::LATEST, &transmit.bytes).unwrap();
    let Message::ServerInfo(info) = message else {
        panic!("{message}")
    };
    assert_eq!(server.clients()[0].version, info.server.natnet_version);
    (info.server.natnet_version, transmit.bytes.len() - Packet::HEADER_SIZE)
}

#[test]
fn every_form_of_connecting_is_answered_with_the_version_to_expect() {
    let speaks = |major, minor| Sender {
        natnet_version: Version::new(major, minor),
        ..Sender::default()
    };
    let wish = |major, minor| {
        Some(ConnectOptions {
            subscribed_only: false,
            bitstream_version: Version::new(major, minor),
        })
    };
    let with_rest = |rest: usize| Connect {
        rest: vec![0; rest],
        ..Connect::new(Sender::default(), wish(3, 1))
    };
    let own = Version::new(4, 1);
    let forms = [
        (Connect::empty(), own, 279),
        (Connect::ping(), own, 279),
        (Connect::new(Sender::default(), None), own, 279),
        (Connect::new(speaks(3, 0), None), Version::new(3, 0), 279),
        (Connect::new(speaks(2, 10), None), Version::new(2, 10), 264),
        (Connect::new(speaks(4, 4), wish(0, 0)), own, 279),
        (Connect::new(speaks(4, 4), wish(4, 4)), own, 279),
        (Connect::new(speaks(4, 4), wish(2, 7)), Version::new(2, 7), 264),
        (with_rest(2), Version::new(3, 1), 279),
        (with_rest(4), Version::new(3, 1), 279),
    ];
    for (form, version, size) in forms {
        assert_eq!(granted(&form), (version, size), "{form}");
    }
}

#[test]
fn requests_get_the_answers_that_clients_wait_for() {
    let mut server = server();
    connect(&mut server, client_address(), None);
    drain(&mut server);
    let number = |value| Message::Response(Response::number(value));
    let cases = [
        ("FrameRate", Message::Response(Response::float(120.0))),
        ("AnalogSamplesPerMocapFrame", number(0)),
        ("Bitstream", Message::Response(Response::text("Bitstream,4.1"))),
        ("Bitstream,3.1", number(0)),
        ("Bitstream", Message::Response(Response::text("Bitstream,3.1"))),
        ("TimelinePlay", number(0)),
        ("SetPlaybackCurrentFrame,0", number(0)),
        ("SubscribeToData,RigidBody,All", number(0)),
    ];
    for (text, answer) in cases {
        assert_eq!(ask(&mut server, &Message::Request(text.into())), [answer], "{text}");
    }
    let unknown = ask(&mut server, &Message::Request("service20,-1,bytes".into()));
    assert!(matches!(&unknown[..], [Message::UnrecognizedRequest(Some(sender))] if sender.name == "Motive"));
}

/// The vendor's Python client takes all that comes behind the dot for a number.
#[test]
fn an_answer_in_text_ends_with_its_last_letter() {
    let mut server = server();
    connect(&mut server, client_address(), None);
    drain(&mut server);
    server.handle(START, client_address(), &encoded(&Message::Request("Bitstream".into())));
    let (_, transmits) = drain(&mut server);
    assert_eq!(&*transmits[0].bytes, b"\x03\0\x0d\0Bitstream,4.1");
}

#[test]
fn a_request_without_its_zero_is_understood() {
    let mut server = server();
    server.handle(START, client_address(), b"\x02\0\x09\0FrameRate");
    let (events, transmits) = drain(&mut server);
    assert_eq!(transmits.len(), 1);
    let request = Event::Request {
        from: client_address(),
        text: Text("FrameRate".into()),
        recognized: true,
    };
    assert_eq!(events, [request]);
}

#[test]
fn an_echo_is_answered_with_the_clock_of_the_server() {
    let mut server = server();
    let request = Message::EchoRequest(EchoRequest { client_ticks: 77 });
    let answers = ask(&mut server, &request);
    let [Message::EchoResponse(echo)] = &answers[..] else {
        panic!("{answers:?}")
    };
    assert_eq!((echo.client_ticks, echo.server_ticks), (77, server.ticks(START)));
    assert_eq!(
        server.ticks(START.after(Duration::from_secs(1))) - server.ticks(START),
        10_000_000
    );
}

#[test]
fn discovery_is_answered_without_becoming_a_client() {
    let mut server = server();
    for question in [Message::Discovery(None), Message::Discovery(Some(Sender::default()))] {
        assert!(matches!(ask(&mut server, &question)[..], [Message::ServerInfo(_)]));
    }
    assert!(server.clients().is_empty());
}

#[test]
fn keep_alives_cost_nothing_and_keep_a_client_that_never_reads() {
    let mut server = server();
    connect(&mut server, client_address(), None);
    drain(&mut server);
    for n in 0..6000 {
        let now = START.after(Duration::from_millis(10 * n));
        let bytes: &[u8] = if n % 2 == 0 { b"\x0a\0\0\0\0" } else { b"\x0a\0\0\0" };
        server.handle(now, client_address(), bytes);
        server.handle_timeout(now);
    }
    assert_eq!(drain(&mut server), (vec![], vec![]));
    assert_eq!(server.clients().len(), 1);
}

#[test]
fn a_silent_client_is_told_and_dropped() {
    let mut server = server();
    connect(&mut server, client_address(), None);
    drain(&mut server);
    let due = server.timeout().unwrap();
    assert_eq!(due.since(START), Duration::from_secs(10));
    server.handle_timeout(Stamp(due.0 - 1));
    assert_eq!(server.clients().len(), 1);
    server.handle_timeout(due);
    let (events, transmits) = drain(&mut server);
    let reason = LeftReason::Silent;
    let client = client_address();
    assert_eq!(events, [Event::Left { client, reason }]);
    assert_eq!(transmits[0].bytes[0], 11);
    assert_eq!((server.clients().len(), server.timeout()), (0, None));
}

#[test]
fn without_a_limit_a_silent_client_stays() {
    let mut server = Server::new(ServerOptions {
        silence_limit: None,
        ..ServerOptions::default()
    });
    connect(&mut server, client_address(), None);
    server.handle_timeout(START.after(Duration::from_hours(99)));
    assert_eq!((server.clients().len(), server.timeout()), (1, None));
}

#[test]
fn a_frame_is_encoded_once_for_all_clients_of_a_layout() {
    let mut server = server();
    let wishes = [(4, 1), (3, 1), (3, 0), (2, 7), (4, 1)];
    for (n, (major, minor)) in (0..).zip(wishes) {
        connect(&mut server, client(n), Some(Version::new(major, minor)));
    }
    drain(&mut server);
    server.send_frame(&frame(9)).unwrap();
    let (_, transmits) = drain(&mut server);
    assert_eq!(transmits.len(), wishes.len());
    for (transmit, (major, minor)) in transmits.iter().zip(wishes) {
        assert_eq!(transmit.socket, Socket::Data);
        let (message, quirks) = Message::decode(Version::new(major, minor), &transmit.bytes).unwrap();
        assert!(quirks.is_empty() && matches!(message, Message::Frame(frame) if frame.number == 9));
    }
    assert!(Arc::ptr_eq(&transmits[0].bytes, &transmits[4].bytes));
    assert!(Arc::ptr_eq(&transmits[1].bytes, &transmits[2].bytes));
}

#[test]
fn a_copy_goes_to_the_data_port_of_every_host_once() {
    let mut server = Server::new(ServerOptions {
        copy_to_data_port: true,
        ..ServerOptions::default()
    });
    let addresses: [SocketAddr; 3] = [
        ([10, 0, 0, 2], 50_000).into(),
        ([10, 0, 0, 2], 50_001).into(),
        ([10, 0, 0, 3], 1511).into(),
    ];
    for address in addresses {
        connect(&mut server, address, None);
    }
    let destinations = |server: &mut Server| {
        drain(server);
        server.send_frame(&frame(1)).unwrap();
        let (_, transmits) = drain(server);
        transmits.iter().map(|transmit| transmit.to).collect::<Vec<_>>()
    };
    let copy = ([10, 0, 0, 2], 1511).into();
    // Nothing comes between a request for the model and its answer.
    assert_eq!(destinations(&mut server), [addresses[2], copy]);
    server.handle(START, addresses[0], b"\x04\0\0\0");
    server.handle(START, addresses[1], b"\x0a\0\0\0");
    assert_eq!(
        destinations(&mut server),
        [addresses[0], addresses[1], addresses[2], copy]
    );
}

#[test]
fn a_client_at_the_data_port_that_never_keeps_alive_stays_until_its_host_brings_another() {
    let mut server = Server::new(ServerOptions {
        copy_to_data_port: true,
        ..ServerOptions::default()
    });
    let first: SocketAddr = ([10, 0, 0, 2], 50_000).into();
    let second: SocketAddr = ([10, 0, 0, 2], 50_001).into();
    server.handle(START, first, b"\0\0\0\0");
    let later = START.after(Duration::from_hours(1));
    server.handle_timeout(later);
    assert_eq!((server.clients().len(), server.timeout()), (1, None));
    server.handle(later, second, b"\0\0\0\0");
    server.handle(later, second, b"\x0a\0\0\0");
    assert!(server.timeout().is_some_and(|due| due < later));
    server.handle_timeout(later);
    assert_eq!(server.clients().len(), 1);
    server.handle_timeout(later.after(Duration::from_secs(10)));
    assert_eq!((server.clients().len(), server.timeout()), (0, None));
}

#[test]
fn a_group_gets_one_frame_whoever_connects() {
    let mut server = Server::new(ServerOptions {
        delivery: Delivery::Multicast(Ipv4Addr::new(239, 255, 42, 99)),
        ..ServerOptions::default()
    });
    connect(&mut server, client_address(), Some(Version::new(3, 1)));
    let (_, transmits) = drain(&mut server);
    let (message, _) = Message::decode(Version::LATEST, &transmits[0].bytes).unwrap();
    let Message::ServerInfo(info) = message else {
        panic!("{message}")
    };
    assert_eq!(info.server.natnet_version, Version::new(4, 1));
    assert!(info.connection.unwrap().is_multicast);
    server.send_frame(&frame(1)).unwrap();
    let (_, transmits) = drain(&mut server);
    assert_eq!(transmits.len(), 1);
    assert_eq!(transmits[0].to, ([239, 255, 42, 99], 1511).into());
}

#[test]
fn a_client_more_than_there_is_place_for_is_told_so() {
    let mut server = server();
    for n in 0..65 {
        connect(&mut server, client(n), None);
    }
    assert_eq!(server.clients().len(), 64);
    let (events, transmits) = drain(&mut server);
    assert_eq!(events.last(), Some(&Event::Refused { client: client(64) }));
    assert_eq!(transmits.last().unwrap().bytes[0], 8);
    server.handle(START, client(0), &encoded(&Message::Disconnect));
    connect(&mut server, client(64), None);
    assert_eq!(server.clients().last().unwrap().address, client(64));
}

#[test]
fn frames_after_a_new_model_say_that_it_has_changed() {
    let mut server = server();
    connect(&mut server, client_address(), None);
    connect(&mut server, client(1), Some(Version::new(2, 3)));
    server.set_model(model(&["wand"])).unwrap();
    drain(&mut server);
    let mut changed = Vec::new();
    for number in 0..5 {
        server.send_frame(&frame(number)).unwrap();
        let (_, transmits) = drain(&mut server);
        let (message, _) = Message::decode(Version::new(4, 1), &transmits[0].bytes).unwrap();
        let Message::Frame(read) = message else { panic!() };
        changed.push(read.params.unwrap().contains(FrameParams::MODEL_CHANGED));
        assert!(Message::decode(Version::new(2, 3), &transmits[1].bytes).is_ok());
    }
    assert_eq!(changed, [true, true, true, false, false]);
}

#[test]
fn the_model_is_sent_in_the_version_of_who_asks() {
    let mut server = server();
    server.set_model(model(&["wand"])).unwrap();
    let versions = [(4, 1), (3, 1), (2, 7)].map(|(major, minor)| Version::new(major, minor));
    for (n, version) in (0..).zip(versions) {
        connect(&mut server, client(n), Some(version));
        drain(&mut server);
        server.handle(START, client(n), &encoded(&Message::RequestModel));
        let (_, transmits) = drain(&mut server);
        let (message, quirks) = Message::decode(version, &transmits[0].bytes).unwrap();
        assert!(quirks.is_empty());
        let Message::Model(model) = message else { panic!() };
        assert_eq!(model.descriptions[0].name(), Some(&Name::from("wand")));
    }
}

#[test]
fn a_model_that_no_datagram_carries_is_refused_and_the_old_one_stays() {
    let mut server = server();
    server.set_model(model(&["wand"])).unwrap();
    let name = "n".repeat(1000);
    let result = server.set_model(model(&vec![name.as_str(); 66]));
    assert!(matches!(
        result,
        Err(Error::TooLarge {
            message: MessageId::MODEL,
            ..
        })
    ));
    let models = ask(&mut server, &Message::RequestModel);
    assert!(matches!(&models[..], [Message::Model(model)] if model.descriptions.len() == 1));
}

#[test]
fn two_hundred_bodies_and_a_frame_as_large_as_a_datagram_are_sent() {
    let mut server = server();
    let names: Vec<String> = (0..200).map(|n| format!("body {n}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    server.set_model(model(&names)).unwrap();
    let models = ask(&mut server, &Message::RequestModel);
    assert!(matches!(&models[..], [Message::Model(model)] if model.descriptions.len() == 200));
    connect(&mut server, client_address(), None);
    drain(&mut server);
    let markers = |count| Frame {
        other_markers: vec![[1.0, 2.0, 3.0]; count],
        ..Frame::default()
    };
    server.send_frame(&markers(5448)).unwrap();
    let (_, transmits) = drain(&mut server);
    assert!(transmits[0].bytes.len() > 65_490);
    assert!(matches!(server.send_frame(&markers(5449)), Err(Error::TooLarge { .. })));
}

#[test]
fn a_request_for_one_frame_brings_one() {
    let mut server = server();
    assert!(ask(&mut server, &Message::RequestFrame).is_empty());
    for expected in [1, 0] {
        server.send_frame(&frame(1)).unwrap();
        assert_eq!(drain(&mut server).1.len(), expected);
    }
}

#[test]
fn whoever_never_polls_loses_the_oldest_and_knows_how_many() {
    let mut server = server();
    connect(&mut server, client_address(), None);
    for number in 0..1000 {
        server.send_frame(&frame(number)).unwrap();
    }
    assert_eq!(server.outputs_dropped(), 1002 - 512);
    assert_eq!(drain(&mut server).1.len(), 512);
}

#[test]
fn before_skeletons_bones_are_rigid_bodies() {
    let bone = |id, parent_id, name: &str| RigidBodyDescription {
        name: name.into(),
        id,
        parent_id,
        ..RigidBodyDescription::default()
    };
    let skeleton = SkeletonDescription {
        name: "Ada".into(),
        id: 2,
        bones: vec![bone(1, 0, "Pelvis"), bone(2, 1, "L5")],
    };
    let mut model = model(&["wand"]);
    model.descriptions.push(Description::Skeleton(skeleton));
    let bodies = |ids: &[i32]| {
        ids.iter()
            .map(|id| RigidBody {
                id: *id,
                ..RigidBody::default()
            })
            .collect()
    };
    let mut sent = frame(1);
    sent.skeletons = vec![Skeleton {
        id: 2,
        bones: bodies(&[0x2_0001, 0x2_0002]),
    }];
    // 1.4 has no names of bodies.
    for (version, names) in [
        (Version::new(1, 4), ["", ""]),
        (Version::new(2, 0), ["Ada/Pelvis", "Ada/L5"]),
    ] {
        let mut server = server();
        server.set_model(model.clone()).unwrap();
        connect(&mut server, client(1), Some(version));
        drain(&mut server);
        server.send_frame(&sent).unwrap();
        server.handle(START, client(1), &encoded(&Message::RequestModel));
        let (_, transmits) = drain(&mut server);
        let decode = |place: usize| Message::decode(version, &transmits[place].bytes).unwrap().0;
        let (Message::Frame(received), Message::Model(described)) = (decode(0), decode(1)) else {
            panic!("{version}")
        };
        let ids: Vec<_> = received.rigid_bodies.iter().map(|body| body.id).collect();
        assert_eq!(ids, [1, 0x2_0001, 0x2_0002]);
        let of_bones = |one: &Description| match one {
            Description::RigidBody(body) if body.id > 1 => Some((body.name.to_string(), body.id, body.parent_id)),
            _ => None,
        };
        let found: Vec<_> = described.descriptions.iter().filter_map(of_bones).collect();
        let expected = [
            (names[0].to_owned(), 0x2_0001, -1),
            (names[1].to_owned(), 0x2_0002, 0x2_0001),
        ];
        assert_eq!(found, expected);
    }
}
