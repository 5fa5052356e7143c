//! What holds whatever arrives.

use std::net::SocketAddr;
use std::time::Duration;

use posewire_motion::Stamp;
use posewire_natnet::client::{Client, ClientOptions, DataSource, Mode};
use posewire_natnet::command::{Connect, ConnectOptions, ConnectionInfo, EchoResponse, Response, Sender, ServerInfo};
use posewire_natnet::server::{Server, ServerOptions};
use posewire_natnet::{Message, MessageId, Packet, Version};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::network::{START, frame, model, server_address};

/// One datagram, and how long after the one before it comes.
type Arrival = (u8, Duration, Vec<u8>);

fn version() -> impl Strategy<Value = Version> {
    any::<[u8; 4]>().prop_map(|[a, b, c, d]| [a % 6, b % 12, c % 2, d % 2].into())
}

fn message() -> impl Strategy<Value = Message> {
    let sender = |natnet_version| Sender {
        natnet_version,
        ..Sender::default()
    };
    let connect = move |(version, wish): (Version, Option<Version>)| {
        let options = wish.map(|bitstream_version| ConnectOptions {
            subscribed_only: false,
            bitstream_version,
        });
        Message::Connect(Connect::new(sender(version), options))
    };
    let info = move |(version, clock_frequency): (Version, u64)| {
        let connection = ConnectionInfo {
            clock_frequency,
            data_port: 1511,
            is_multicast: false,
            group: [239, 255, 42, 99].into(),
        };
        Message::ServerInfo(ServerInfo {
            server: sender(version),
            connection: Some(connection),
        })
    };
    let echo = |(client_ticks, server_ticks)| {
        Message::EchoResponse(EchoResponse {
            client_ticks,
            server_ticks,
        })
    };
    let near_start = (0..2_000_000_000_u64).prop_map(|after| START.0 as u64 + after);
    prop_oneof![
        (version(), proptest::option::of(version())).prop_map(connect),
        (version(), any::<u64>()).prop_map(info),
        (near_start, any::<u64>()).prop_map(echo),
        any::<i32>().prop_map(|number| Message::Frame(Box::new(frame(number)))),
        Just(Message::Model(model(&["wand"]))),
        Just(Message::Response(Response::text("Bitstream,3.1"))),
        Just(Message::UnrecognizedRequest(None)),
        Just(Message::RequestModel),
        Just(Message::RequestFrame),
        Just(Message::Disconnect),
        Just(Message::DisconnectByTimeout),
        "[A-Za-z]{0,9},?[0-9.]{0,4}".prop_map(|text| Message::Request(text.as_str().into())),
        "Bitstream,[0-9]\\.[0-9]".prop_map(|text| Message::Request(text.as_str().into())),
    ]
}

fn datagram() -> impl Strategy<Value = Vec<u8>> {
    let valid = (message(), version()).prop_map(|(message, version)| {
        let mut bytes = Vec::new();
        message.encode(version, &mut bytes).unwrap();
        bytes
    });
    let framed = (0..16_u16, vec(any::<u8>(), 0..300)).prop_map(|(id, payload)| {
        let mut bytes = Vec::new();
        Packet::encode(MessageId(id), &mut bytes, |out| out.extend(payload)).unwrap();
        bytes
    });
    prop_oneof![3 => valid, 1 => framed, 1 => vec(any::<u8>(), 0..40)]
}

fn arrivals() -> impl Strategy<Value = Vec<Arrival>> {
    let wait = (0..4000_u64).prop_map(Duration::from_millis);
    vec((any::<u8>(), wait, datagram()), 0..200)
}

fn from(n: u8) -> SocketAddr {
    ([10, 0, 0, n], 1510).into()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_server_stays_bounded_whatever_arrives(arrivals in arrivals(), polls in any::<bool>()) {
        let mut server = Server::new(ServerOptions { copy_to_data_port: true, ..ServerOptions::default() });
        server.set_model(model(&["wand"])).unwrap();
        let mut now = START;
        for (n, wait, bytes) in arrivals {
            now = now.after(wait);
            server.handle(now, from(n), &bytes);
            server.handle_timeout(now);
            prop_assert!(server.timeout().is_none_or(|due| due > now));
            prop_assert!(server.clients().len() <= 64);
            prop_assert!(server.send_frame(&frame(i32::from(n))).is_ok());
            while polls && server.poll().is_some() {}
        }
        prop_assert!(std::iter::from_fn(|| server.poll()).count() <= 512);
    }

    #[test]
    fn a_client_stays_bounded_and_never_due_whatever_arrives(arrivals in arrivals(), multicast in any::<bool>()) {
        let mode = if multicast { Mode::Multicast } else { Mode::Unicast };
        let mut options = ClientOptions::new(server_address(), mode);
        options.data_source = DataSource::Any;
        options.version = Some(Version::new(3, 1));
        let mut client = Client::new(START, options);
        let mut now = START;
        for (n, wait, bytes) in arrivals {
            now = now.after(wait);
            client.handle(now, from(if n < 200 { 1 } else { n }), &bytes);
            client.request(now, "FrameRate");
            client.request_model(now);
            client.handle_timeout(now);
            prop_assert!(client.timeout().is_some_and(|due| due > now));
        }
        prop_assert!(std::iter::from_fn(|| client.poll()).count() <= 512);
    }

    #[test]
    fn stamps_at_the_ends_of_time_do_no_harm(at in any::<i64>(), bytes in datagram()) {
        let mut server = Server::new(ServerOptions { clock_frequency: u64::MAX, ..ServerOptions::default() });
        server.handle(Stamp(at), from(1), &bytes);
        server.handle_timeout(Stamp(at.wrapping_add(1)));
        let mut client = Client::new(Stamp(at), ClientOptions::new(server_address(), Mode::Unicast));
        client.handle(Stamp(at), from(1), &bytes);
        client.handle_timeout(Stamp(at.wrapping_mul(3)));
    }
}
