//! The client against what real servers and networks do.

use std::net::SocketAddr;
use std::time::Duration;

use posewire_motion::Stamp;
use posewire_natnet::client::{
    Answer, Client, ClientOptions, DataSource, Discovery, Event, Found, FrameOrder, LostReason, Mode,
};
use posewire_natnet::command::{ConnectionInfo, EchoResponse, Response, Sender, ServerInfo};
use posewire_natnet::frame::Frame;
use posewire_natnet::model::Model;
use posewire_natnet::{Error, Message, MessageId, Output, Version};

use crate::network::{START, client_address, data_address, frame, milliseconds, server_address};

/// A client and the messages that it sends.
struct Harness {
    client: Client,
    now: Stamp,
    version: Version,
}

impl Harness {
    fn new(options: ClientOptions) -> Self {
        Self {
            client: Client::new(START, options),
            now: START,
            version: Version::new(3, 1),
        }
    }

    fn unicast() -> Self {
        Self::new(ClientOptions::new(server_address(), Mode::Unicast))
    }

    fn connected(options: ClientOptions) -> Self {
        let mut harness = Self::new(options);
        harness.answer(&Message::ServerInfo(info("Motive", harness.version)));
        harness.wait(Duration::ZERO);
        harness.drain();
        harness
    }

    fn answer(&mut self, message: &Message) {
        self.answer_from(server_address(), message);
    }

    fn answer_from(&mut self, from: SocketAddr, message: &Message) {
        let mut bytes = Vec::new();
        message.encode(self.version, &mut bytes).unwrap();
        self.client.handle(self.now, from, &bytes);
    }

    fn wait(&mut self, duration: Duration) {
        let end = self.now.after(duration);
        while let Some(next) = self.client.timeout().filter(|next| *next <= end) {
            self.now = next;
            self.client.handle_timeout(next);
        }
        self.now = end;
    }

    fn drain(&mut self) -> (Vec<Event>, Vec<Message>) {
        let (mut events, mut messages) = (Vec::new(), Vec::new());
        while let Some(output) = self.client.poll() {
            match output {
                Output::Event(event) => events.push(event),
                Output::Transmit(transmit) => {
                    assert_eq!(transmit.to, server_address());
                    messages.push(Message::decode(self.version, &transmit.bytes).unwrap().0);
                }
            }
        }
        (events, messages)
    }

    fn sent(&mut self, id: MessageId) -> usize {
        let (_, messages) = self.drain();
        messages.iter().filter(|message| message.id() == id).count()
    }
}

fn info(name: &str, version: Version) -> ServerInfo {
    let connection = ConnectionInfo {
        clock_frequency: 10_000_000,
        data_port: 1511,
        is_multicast: false,
        group: [239, 255, 42, 99].into(),
    };
    ServerInfo {
        server: Sender {
            name: name.into(),
            app_version: Version::new(2, 1),
            natnet_version: version,
        },
        connection: version.has_connection_info().then_some(connection),
    }
}

fn boxed(number: i32) -> Message {
    Message::Frame(Box::new(frame(number)))
}

#[test]
fn connecting_is_tried_ever_less_often() {
    let mut harness = Harness::unicast();
    harness.wait(Duration::from_mins(1));
    let count = harness.sent(MessageId::CONNECT);
    assert!((30..36).contains(&count), "{count}");
}

#[test]
fn the_first_message_says_who_connects_and_which_version_it_wants() {
    let mut options = ClientOptions::new(server_address(), Mode::Unicast);
    options.version = Some(Version::new(3, 1));
    let (_, messages) = Harness::new(options.clone()).drain();
    let [Message::Connect(connect)] = &messages[..] else {
        panic!("{messages:?}");
    };
    assert_eq!(connect.requested_version(), options.version);
    assert_eq!(connect.sender.as_ref(), Some(&options.sender));
}

#[test]
fn frames_of_a_server_that_was_lost_are_refused_until_it_answers_and_then_missing() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    harness.answer(&boxed(1));
    harness.wait(Duration::from_secs(4));
    assert_eq!(harness.client.version(), None);
    harness.answer(&boxed(2));
    harness.answer(&boxed(3));
    harness.answer(&Message::ServerInfo(info("Motive", harness.version)));
    harness.answer(&boxed(4));
    let counts = harness.client.counts();
    assert_eq!(
        (counts.received, counts.missing, counts.refused, counts.early),
        (2, 2, 2, 0)
    );
}

#[test]
fn a_connected_client_shows_that_it_lives_and_asks_for_the_clock() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    let (mut keep_alives, mut echoes) = (0, 0);
    for _ in 0..10 {
        harness.wait(Duration::from_secs(1));
        harness.answer(&Message::MessageString("still here".into()));
        let (_, messages) = harness.drain();
        keep_alives += messages.iter().filter(|one| **one == Message::KeepAlive).count();
        echoes += messages
            .iter()
            .filter(|one| one.id() == MessageId::ECHO_REQUEST)
            .count();
    }
    assert_eq!((keep_alives, echoes), (10, 20));
}

#[test]
fn an_echo_that_is_read_after_a_later_frame_is_as_fast_as_it_was() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Multicast));
    harness.wait(Duration::from_secs(1));
    let asked = harness.drain().1.into_iter().rev().find_map(|message| match message {
        Message::EchoRequest(request) => Some(request.client_ticks),
        _ => None,
    });
    let client_ticks = asked.unwrap();
    let sent = Stamp(client_ticks as i64);
    harness.now = sent.after(milliseconds(9));
    harness.answer_from(data_address(), &boxed(1));
    harness.now = sent.after(milliseconds(2));
    harness.answer(&Message::EchoResponse(EchoResponse {
        client_ticks,
        server_ticks: 7,
    }));
    let estimate = harness.client.clock(sent.after(milliseconds(9))).unwrap();
    assert_eq!(
        (estimate.round_trip, estimate.at),
        (milliseconds(2), sent.after(milliseconds(1)))
    );
}

#[test]
fn the_model_is_asked_for_until_it_comes() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    harness.wait(Duration::from_secs(2));
    assert!(harness.sent(MessageId::REQUEST_MODEL) > 1);
    harness.answer(&Message::Model(Model::default()));
    harness.wait(Duration::from_secs(2));
    assert_eq!(harness.sent(MessageId::REQUEST_MODEL), 0);
    harness.client.request_model(harness.now);
    assert_eq!(harness.sent(MessageId::REQUEST_MODEL), 1);
}

#[test]
fn a_server_that_ignores_the_wish_is_asked_once_more_and_then_believed() {
    let mut options = ClientOptions::new(server_address(), Mode::Unicast);
    options.version = Some(Version::new(4, 0));
    let mut harness = Harness::new(options);
    harness.answer(&Message::ServerInfo(info("Motive", Version::new(4, 1))));
    let (_, messages) = harness.drain();
    assert!(messages.contains(&Message::Request("Bitstream,4.0".into())));
    harness.answer(&Message::Response(Response::number(0)));
    let (_, messages) = harness.drain();
    assert!(messages.contains(&Message::Request("Bitstream".into())));
    harness.answer(&Message::Response(Response::text("Bitstream,4.0")));
    let (events, messages) = harness.drain();
    assert_eq!(events, [Event::Version(Version::new(4, 0))]);
    assert_eq!(harness.client.version(), Some(Version::new(4, 0)));
    assert!(messages.is_empty());
    harness.wait(milliseconds(1));
    assert_eq!(harness.sent(MessageId::REQUEST_MODEL), 1);
}

#[test]
fn a_server_that_introduces_itself_again_is_asked_which_version_it_sends() {
    let mut options = ClientOptions::new(server_address(), Mode::Unicast);
    options.version = Some(Version::new(4, 0));
    let mut harness = Harness::new(options);
    let introduction = Message::ServerInfo(info("Motive", Version::new(4, 1)));
    harness.answer(&introduction);
    for version in ["4.0", "4.1"] {
        harness.answer(&Message::Response(Response::number(0)));
        harness.answer(&Message::Response(Response::text(&format!("Bitstream,{version}"))));
        assert_eq!(harness.client.version(), version.parse().ok());
        harness.drain();
        harness.answer(&introduction);
    }
    let (_, messages) = harness.drain();
    assert!(messages.is_empty(), "the versions agree");
}

#[test]
fn frames_before_the_server_has_answered_are_counted() {
    let mut harness = Harness::unicast();
    harness.answer_from(data_address(), &boxed(1));
    assert_eq!(harness.client.counts().early, 1);
    assert!(harness.drain().0.is_empty());
}

#[test]
fn a_group_can_be_read_without_a_server_that_answers() {
    let mut options = ClientOptions::new(server_address(), Mode::Multicast);
    options.version = Some(Version::new(3, 1));
    let mut harness = Harness::new(options);
    harness.answer_from(data_address(), &boxed(1));
    assert!(matches!(&harness.drain().0[..], [Event::Frame(_)]));
}

#[test]
fn frames_of_other_servers_in_the_group_are_not_taken_unless_wanted() {
    let other: SocketAddr = ([10, 0, 0, 9], 1511).into();
    let sources = [
        (DataSource::Server, 1, 1),
        (DataSource::Address(other.ip()), 1, 1),
        (DataSource::Any, 2, 0),
    ];
    for (data_source, taken, foreign) in sources {
        let mut options = ClientOptions::new(server_address(), Mode::Multicast);
        options.data_source = data_source;
        let mut harness = Harness::connected(options);
        harness.answer_from(data_address(), &boxed(1));
        harness.answer_from(other, &boxed(2));
        let counts = harness.client.counts();
        assert_eq!((counts.received, counts.foreign), (taken, foreign));
    }
}

#[test]
fn the_same_bytes_twice_are_one_frame_and_the_same_number_twice_are_two() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    harness.answer(&boxed(1));
    harness.answer(&boxed(1));
    let moved = Frame {
        rigid_bodies: Vec::new(),
        ..frame(1)
    };
    harness.answer(&Message::Frame(Box::new(moved)));
    let counts = harness.client.counts();
    assert_eq!((counts.received, counts.duplicate, counts.repeated), (2, 1, 1));
    let orders: Vec<_> = harness
        .drain()
        .0
        .into_iter()
        .filter_map(|event| match event {
            Event::Frame(received) => Some((received.order, received.late)),
            _ => None,
        })
        .collect();
    assert_eq!(orders, [(FrameOrder::Next, false), (FrameOrder::Repeated, false)]);
}

#[test]
fn a_frame_after_a_newer_one_is_late_whether_or_not_it_came_before() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    for number in [1, 3, 2, 1, 4] {
        harness.answer(&boxed(number));
    }
    let late = harness.drain().0.into_iter().filter_map(|event| match event {
        Event::Frame(received) => Some((received.frame.number, received.late)),
        _ => None,
    });
    let late: Vec<_> = late.collect();
    assert_eq!(late, [(1, false), (3, false), (2, true), (1, true), (4, false)]);
}

#[test]
fn what_cannot_be_read_is_told_and_counted() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    harness.client.handle(harness.now, server_address(), b"abc");
    harness.client.handle(harness.now, server_address(), b"\x07\0\x02\0ab");
    let (events, _) = harness.drain();
    let short = Event::Malformed {
        id: None,
        error: Error::ShortHeader { found: 3 },
    };
    assert_eq!(events[0], short);
    assert!(matches!(
        events[1],
        Event::Malformed {
            id: Some(MessageId::FRAME),
            ..
        }
    ));
    assert_eq!(harness.client.counts().malformed, 1);
}

#[test]
fn a_server_that_says_goodbye_is_lost() {
    for (message, reason) in [
        (Message::Disconnect, LostReason::Closed),
        (Message::DisconnectByTimeout, LostReason::TimedOut),
    ] {
        let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
        harness.answer(&message);
        assert_eq!(harness.drain().0, [Event::Lost(reason)]);
        harness.wait(Duration::from_secs(1));
        assert!(harness.sent(MessageId::CONNECT) >= 1);
    }
}

#[test]
fn a_request_without_an_answer_is_given_up() {
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    harness.client.request(harness.now, "FrameRate");
    harness.wait(milliseconds(2500));
    let (events, messages) = harness.drain();
    let given_up = Event::Answer {
        request: "FrameRate".into(),
        answer: Answer::Nothing,
    };
    assert!(events.contains(&given_up));
    let asked = Message::Request("FrameRate".into());
    assert_eq!(messages.iter().filter(|message| **message == asked).count(), 3);
}

#[test]
fn a_model_is_asked_for_when_the_bit_appears_and_not_while_it_stays() {
    use posewire_natnet::frame::FrameParams;
    let mut harness = Harness::connected(ClientOptions::new(server_address(), Mode::Unicast));
    harness.answer(&Message::Model(Model::default()));
    for number in 1..50 {
        let params = Some(FrameParams::MODEL_CHANGED);
        let frame = Frame {
            params,
            ..frame(number)
        };
        harness.answer(&Message::Frame(Box::new(frame)));
        harness.answer(&Message::Model(Model::default()));
    }
    assert_eq!(harness.sent(MessageId::REQUEST_MODEL), 1);
}

#[test]
fn discovery_tells_of_every_server_once() {
    let everybody = ([255, 255, 255, 255], 1510).into();
    let mut discovery = Discovery::new(START, Sender::default(), vec![everybody]);
    let servers: [SocketAddr; 2] = [server_address(), ([10, 0, 0, 9], 1510).into()];
    let (mut asked, mut found) = (0, Vec::new());
    while let Some(due) = discovery.timeout() {
        for (server, name) in servers.into_iter().zip(["one", "two"]) {
            let mut bytes = Vec::new();
            let answer = Message::ServerInfo(info(name, Version::new(3, 1)));
            answer.encode(Version::new(3, 1), &mut bytes).unwrap();
            discovery.handle(server, &bytes);
        }
        discovery.handle(client_address(), b"\x0e\0\0\0");
        discovery.handle_timeout(due);
        while let Some(output) = discovery.poll() {
            match output {
                Output::Event(Found { server, info }) => found.push((server, info.server.name.to_string())),
                Output::Transmit(transmit) => asked += usize::from(transmit.to == everybody),
            }
        }
    }
    assert_eq!(asked, 3);
    assert_eq!(found, [(servers[0], "one".into()), (servers[1], "two".into())]);
}
