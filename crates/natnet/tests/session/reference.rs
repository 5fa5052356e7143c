//! Captured packets of Motive and of the SDK, where they are at hand, told to the other side.

use std::fs;
use std::path::Path;

use posewire_natnet::client::{Client, ClientOptions, Event, Mode};
use posewire_natnet::server::{Server, ServerOptions};
use posewire_natnet::{Message, MessageId, Output, Version};

use crate::network::{START, client_address, data_address, model, server_address};

fn captured(name: &str) -> Option<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/natnet");
    let bytes = fs::read(path.join(name)).ok();
    if bytes.is_none() {
        println!("skipped: reference data not here");
    }
    bytes
}

/// The events of a client to which these packets come.
fn follow(names: &[&str]) -> Option<(Client, Vec<Event>)> {
    let mut client = Client::new(START, ClientOptions::new(server_address(), Mode::Multicast));
    for name in names {
        let bytes = captured(name)?;
        let is_frame = bytes[0] == MessageId::FRAME.0 as u8;
        let from = if is_frame { data_address() } else { server_address() };
        client.handle(START, from, &bytes);
    }
    let outputs = std::iter::from_fn(|| client.poll());
    let events = outputs.filter_map(|output| match output {
        Output::Event(event) => Some(event),
        Output::Transmit(_) => None,
    });
    let events = events.collect();
    Some((client, events))
}

#[test]
fn motive_2_1_is_followed() {
    let names = [
        "serverinfo_packet_v3.bin",
        "modeldef_packet_v3.bin",
        "mocapframe_packet_v3.bin",
    ];
    let Some((client, events)) = follow(&names) else { return };
    assert_eq!(client.version(), Some(Version::new(3, 0)));
    assert!(matches!(
        &events[..],
        [
            Event::Connected { .. },
            Event::Version(_),
            Event::Model { .. },
            Event::Frame(_)
        ]
    ));
}

#[test]
fn motive_1_7_is_followed() {
    let names = ["000", "001", "002"].map(|n| format!("frame-motive-1.7.2-{n}.bin"));
    let Some((client, events)) = follow(&names.each_ref().map(String::as_str)) else {
        return;
    };
    assert_eq!(
        client.version().map(|version| (version.major, version.minor)),
        Some((2, 7))
    );
    assert_eq!(
        events.iter().filter(|event| matches!(event, Event::Frame(_))).count(),
        2
    );
    assert_eq!(client.counts().malformed, 0);
}

#[test]
fn what_the_sdk_asks_is_answered() {
    let pairs = [
        ("discovery_packet_v3.bin", MessageId::SERVER_INFO),
        ("connect_packet_v3.bin", MessageId::SERVER_INFO),
        ("requestmodeldef_packet_v3.bin", MessageId::MODEL),
        ("echorequest_packet_v3.bin", MessageId::ECHO_RESPONSE),
    ];
    let mut server = Server::new(ServerOptions::default());
    server.set_model(model(&["wand"])).unwrap();
    for (name, expected) in pairs {
        let Some(bytes) = captured(name) else { return };
        server.handle(START, client_address(), &bytes);
        let answer = std::iter::from_fn(|| server.poll()).find_map(|output| match output {
            Output::Transmit(transmit) => Some(transmit),
            Output::Event(_) => None,
        });
        let answer = answer.unwrap_or_else(|| panic!("no answer to {name}"));
        let version = server
            .clients()
            .first()
            .map_or(Version::new(4, 1), |client| client.version);
        let (message, quirks) = Message::decode(version, &answer.bytes).unwrap();
        assert_eq!(message.id(), expected, "{name}");
        assert!(quirks.is_empty(), "{name}: {quirks}");
    }
    assert_eq!(server.clients().len(), 1);
    println!("the SDK is granted {}", server.clients()[0].version);
}
