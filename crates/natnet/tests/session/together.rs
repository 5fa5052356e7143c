//! Client and server over the network.

use std::net::Ipv4Addr;
use std::time::Duration;

use posewire_natnet::client::{Answer, ClientOptions, Event, LostReason, Mode};
use posewire_natnet::command::Response;
use posewire_natnet::server::{self, Delivery, ServerOptions};
use posewire_natnet::{Message, MessageId, Version};

use crate::network::{Link, World, client_address, milliseconds, model, server_address};

const SECOND: Duration = Duration::from_secs(1);

fn unicast_wishing(server: Version, wish: Option<Version>) -> World {
    let server = ServerOptions {
        version: server,
        ..ServerOptions::default()
    };
    let client = ClientOptions {
        version: wish,
        ..ClientOptions::new(server_address(), Mode::Unicast)
    };
    World::new(server, client)
}

fn keep_alive() -> Vec<u8> {
    let mut bytes = Vec::new();
    Message::KeepAlive.encode(Version::LATEST, &mut bytes).unwrap();
    bytes
}

fn names(event: &Event) -> Option<Vec<String>> {
    let Event::Model { model, .. } = event else {
        return None;
    };
    let names = model.descriptions.iter().filter_map(|one| one.name());
    Some(names.map(ToString::to_string).collect())
}

#[test]
fn a_client_gets_the_model_and_every_frame() {
    let mut world = World::unicast();
    world.run(SECOND * 10);
    let positions: Vec<f32> = world
        .frames()
        .map(|received| received.frame.rigid_bodies[0].position[0])
        .collect();
    assert!(positions.len() >= 999, "{}", positions.len());
    assert!(positions.windows(2).all(|pair| (pair[1] - pair[0] - 1.0).abs() < 0.5));
    assert_eq!(world.events.iter().find_map(names), Some(vec!["wand".into()]));
    let counts = world.client.counts();
    assert_eq!((counts.missing, counts.malformed, counts.foreign), (0, 0, 0));
    assert_eq!(world.server_events.len(), 1 + 1, "connected, asked for the version");
}

#[test]
fn every_version_that_a_client_wants_is_what_it_gets() {
    for wish in Version::LAYOUTS {
        for server in [Version::new(4, 1), Version::LATEST] {
            let mut world = unicast_wishing(server, Some(wish));
            world.run(SECOND);
            let granted = wish.min(server);
            assert_eq!(world.client.version(), Some(granted));
            assert!(world.frames().count() >= 99, "{wish}");
            assert_eq!(world.client.counts().malformed, 0, "{wish}");
            assert!(world.events.iter().any(|event| names(event).is_some()), "{wish}");
        }
    }
}

#[test]
fn a_client_without_a_wish_gets_the_servers_version() {
    let mut world = unicast_wishing(Version::new(4, 5), None);
    world.run(SECOND);
    assert_eq!(world.client.version(), Some(Version::new(4, 5)));
    assert!(world.frames().count() >= 99);
}

#[test]
fn a_group_gets_the_servers_own_version_whatever_the_wish() {
    let server = ServerOptions {
        version: Version::new(3, 1),
        delivery: Delivery::Multicast(Ipv4Addr::new(239, 255, 42, 99)),
        ..ServerOptions::default()
    };
    let client = ClientOptions {
        version: Some(Version::new(4, 1)),
        ..ClientOptions::new(server_address(), Mode::Multicast)
    };
    let mut world = World::new(server, client);
    world.run(SECOND * 2);
    assert_eq!(world.client.version(), Some(Version::new(3, 1)));
    assert!(world.frames().count() >= 198);
    assert!(world.server.as_ref().unwrap().clients().is_empty());
    let keep_alive = MessageId::KEEP_ALIVE.0 as u8;
    assert!(world.sent.iter().all(|bytes| bytes[0] != keep_alive));
}

#[test]
fn on_a_bad_network_a_client_connects_and_counts_what_is_missing() {
    let mut world = World::unicast();
    world.link = Link::BAD;
    world.run(SECOND * 20);
    let counts = world.client.counts();
    assert!(world.events.iter().any(|event| names(event).is_some()));
    assert_eq!(world.count(|event| matches!(event, Event::Lost(_))), 0);
    let lost = counts.missing as f64 / (counts.received + counts.missing) as f64;
    assert!((0.15..0.25).contains(&lost), "{lost}");
    assert!(
        counts.late > 100 && counts.repeated + counts.duplicate > 10,
        "{counts:?}"
    );
    assert_eq!((counts.jumps, counts.malformed), (0, 0));
}

#[test]
fn the_servers_clock_is_known_within_what_it_says() {
    for link in [Link::GOOD, Link::BAD] {
        let mut world = World::unicast();
        world.link = link;
        world.run(SECOND * 10);
        let estimate = world.client.clock(world.now).unwrap();
        let ticks = world.server.as_ref().unwrap().ticks(world.now);
        let error = (estimate.stamp_of(ticks) - world.now).unsigned_abs();
        assert!(
            u128::from(error) <= estimate.uncertainty.as_nanos() + 100,
            "{estimate:?}"
        );
        assert!(estimate.uncertainty < milliseconds(30));
    }
}

#[test]
fn stamps_of_frames_become_stamps_of_the_client() {
    let mut world = World::unicast();
    world.run(SECOND * 2);
    let estimate = world.client.clock(world.now).unwrap();
    let last = world.frames().last().unwrap();
    let sent = estimate.stamp_of(last.frame.host_stamps.unwrap().transmit);
    let delay = (last.received - sent) / 1000;
    assert!((0..600).contains(&delay), "{delay} us");
}

#[test]
fn a_changed_model_is_asked_for_again() {
    let mut world = World::unicast();
    world.run(SECOND);
    world.events.clear();
    world
        .server
        .as_mut()
        .unwrap()
        .set_model(model(&["wand", "drone"]))
        .unwrap();
    world.run(SECOND);
    let models: Vec<_> = world.events.iter().filter_map(names).collect();
    assert_eq!(models, [["wand", "drone"]]);
}

#[test]
fn a_model_that_changes_while_a_change_is_announced_is_asked_for_too() {
    let mut world = World::unicast();
    world.run(SECOND);
    for names in [&["wand", "drone"][..], &["stick"]] {
        world.server.as_mut().unwrap().set_model(model(names)).unwrap();
        world.run(milliseconds(15));
    }
    world.run(SECOND);
    let last = world.events.iter().filter_map(names).next_back();
    assert_eq!(last, Some(vec!["stick".into()]));
}

#[test]
fn a_server_that_vanishes_is_lost_and_found_when_it_returns() {
    let mut world = World::unicast();
    world.run(SECOND);
    let server = world.server.take();
    world.run(SECOND * 8);
    assert_eq!(world.count(|event| *event == Event::Lost(LostReason::Silent)), 1);
    assert_eq!(world.client.version(), None);
    world.events.clear();
    world.server = server;
    world.run(SECOND * 4);
    assert_eq!(world.count(|event| matches!(event, Event::Connected { .. })), 1);
    assert!(world.events.iter().any(|event| names(event).is_some()));
    assert!(world.frames().count() > 150);
}

#[test]
fn frames_sent_while_the_connection_was_lost_are_missing() {
    let mut world = World::unicast();
    world.run(SECOND);
    let server_heard_us = world.now.after(SECOND * 5);
    world.link.loss_percent = 100;
    world.run(SECOND * 5);
    world
        .server
        .as_mut()
        .unwrap()
        .handle(server_heard_us, client_address(), &keep_alive());
    world.link.loss_percent = 0;
    world.run(SECOND * 4);
    assert_eq!(world.count(|event| matches!(event, Event::Connected { .. })), 2);
    let counts = world.client.counts();
    let sent = u64::try_from(world.frame_number).unwrap();
    assert!(counts.missing >= 500 && counts.jumps == 0, "{counts:?}");
    assert!(
        (sent - 2..=sent).contains(&(counts.received + counts.missing)),
        "{sent} {counts:?}"
    );
}

#[test]
fn a_server_that_counts_anew_after_a_restart_is_a_reset() {
    let mut world = World::unicast();
    world.run(milliseconds(300));
    world.server = None;
    world.run(SECOND * 4);
    let mut server = server::Server::new(ServerOptions::default());
    server.set_model(model(&["wand"])).unwrap();
    world.server = Some(server);
    world.frame_number = 0;
    world.run(SECOND * 4);
    let counts = world.client.counts();
    assert_eq!((counts.jumps, counts.missing, counts.late), (1, 0, 0), "{counts:?}");
}

#[test]
fn a_server_that_restarts_at_once_is_connected_to_again() {
    let mut world = World::unicast();
    world.run(SECOND);
    let mut server = server::Server::new(ServerOptions::default());
    server.set_model(model(&["drone"])).unwrap();
    world.server = Some(server);
    world.events.clear();
    world.run(SECOND * 8);
    assert!(world.frames().count() > 300, "{}", world.frames().count());
    assert!(world.events.iter().filter_map(names).any(|names| names == ["drone"]));
}

#[test]
fn a_server_that_pauses_is_not_lost() {
    for version in [Version::new(2, 10), Version::new(4, 1)] {
        let mut world = unicast_wishing(version, None);
        world.run(SECOND);
        world.streaming = false;
        world.run(SECOND * 60);
        world.streaming = true;
        world.run(SECOND);
        assert_eq!(world.count(|event| matches!(event, Event::Lost(_))), 0, "{version}");
        assert!(world.frames().count() > 190, "{version}");
        assert_eq!(world.client.counts().missing, 0);
    }
}

#[test]
fn a_client_that_was_dropped_for_its_silence_connects_again() {
    let mut world = World::unicast();
    world.run(SECOND);
    world.link.loss_percent = 100;
    let cut_off = world.now.after(SECOND * 11);
    world.server.as_mut().unwrap().handle_timeout(cut_off);
    world.link.loss_percent = 0;
    world.run(SECOND);
    assert_eq!(world.count(|event| *event == Event::Lost(LostReason::TimedOut)), 1);
    assert_eq!(world.count(|event| matches!(event, Event::Connected { .. })), 2);
    assert_eq!(world.server.as_ref().unwrap().clients().len(), 1);
}

#[test]
fn requests_are_answered_in_order_even_when_datagrams_are_lost() {
    let mut world = World::unicast();
    world.link.loss_percent = 20;
    for text in ["FrameRate", "AnalogSamplesPerMocapFrame", "UnitesToMillimeters"] {
        assert!(world.client.request(world.now, text));
    }
    world.run(SECOND * 10);
    let answers: Vec<_> = world
        .events
        .iter()
        .filter_map(|event| match event {
            Event::Answer { request, answer } => Some((request.as_str(), answer.clone())),
            _ => None,
        })
        .collect();
    let expected = [
        ("FrameRate", Answer::Response(Response::float(120.0))),
        ("AnalogSamplesPerMocapFrame", Answer::Response(Response::number(0))),
        ("UnitesToMillimeters", Answer::Unrecognized),
    ];
    assert_eq!(answers, expected);
}

#[test]
fn a_client_that_disconnects_gets_no_more_frames() {
    let mut world = World::unicast();
    world.run(SECOND);
    world.client.disconnect();
    world.run(SECOND);
    let frames = world.frames().count();
    world.run(SECOND);
    assert_eq!(world.frames().count(), frames);
    assert_eq!(world.client.timeout(), None);
    let left = server::Event::Left {
        client: client_address(),
        reason: server::LeftReason::Disconnected,
    };
    assert!(world.server_events.contains(&left));
}
