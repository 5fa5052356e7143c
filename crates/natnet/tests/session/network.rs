//! A network without sockets, and a clock without waiting.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use posewire_motion::Stamp;
use posewire_natnet::client::{Client, ClientOptions, Event, Mode, ReceivedFrame};
use posewire_natnet::frame::{BodyParams, Frame, HostStamps, RigidBody};
use posewire_natnet::model::{Description, Model, RigidBodyDescription};
use posewire_natnet::server::{self, Server, ServerOptions};
use posewire_natnet::{Output, Socket, Transmit};

pub(crate) const START: Stamp = Stamp(1_700_000_000_000_000_000);

pub(crate) fn server_address() -> SocketAddr {
    ([10, 0, 0, 1], 1510).into()
}

pub(crate) fn data_address() -> SocketAddr {
    ([10, 0, 0, 1], 1511).into()
}

pub(crate) fn client_address() -> SocketAddr {
    ([10, 0, 0, 2], 50_000).into()
}

pub(crate) const fn milliseconds(count: u64) -> Duration {
    Duration::from_millis(count)
}

/// How bad the network is. Delays are in microseconds; they differ, so datagrams overtake each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub(crate) loss_percent: u64,
    pub(crate) shortest_delay: u64,
    pub(crate) longest_delay: u64,
    pub(crate) duplicate_percent: u64,
}

impl Link {
    pub(crate) const GOOD: Self = Self {
        loss_percent: 0,
        shortest_delay: 150,
        longest_delay: 300,
        duplicate_percent: 0,
    };
    pub(crate) const BAD: Self = Self {
        loss_percent: 20,
        shortest_delay: 500,
        longest_delay: 30_000,
        duplicate_percent: 5,
    };
}

/// One server, one client, and the frames that the server sends at 100 Hz.
pub(crate) struct World {
    pub(crate) now: Stamp,
    pub(crate) server: Option<Server>,
    pub(crate) client: Client,
    pub(crate) link: Link,
    pub(crate) streaming: bool,
    pub(crate) frame_number: i32,
    pub(crate) events: Vec<Event>,
    pub(crate) server_events: Vec<server::Event>,
    /// Every datagram that the client sent.
    pub(crate) sent: Vec<Arc<[u8]>>,
    under_way: BTreeMap<(Stamp, u64), Datagram>,
    next_frame: Stamp,
    random: u64,
    serial: u64,
}

struct Datagram {
    from: SocketAddr,
    to_server: bool,
    bytes: Arc<[u8]>,
}

impl World {
    pub(crate) fn new(server: ServerOptions, client: ClientOptions) -> Self {
        let mut server = Server::new(server);
        server.set_model(model(&["wand"])).unwrap();
        Self {
            now: START,
            server: Some(server),
            client: Client::new(START, client),
            link: Link::GOOD,
            streaming: true,
            frame_number: 0,
            events: Vec::new(),
            server_events: Vec::new(),
            sent: Vec::new(),
            under_way: BTreeMap::new(),
            next_frame: START,
            random: 1,
            serial: 0,
        }
    }

    pub(crate) fn unicast() -> Self {
        Self::new(
            ServerOptions::default(),
            ClientOptions::new(server_address(), Mode::Unicast),
        )
    }

    /// Lets time pass: every arrival, timeout and frame at its instant.
    pub(crate) fn run(&mut self, duration: Duration) {
        let end = self.now.after(duration);
        self.settle();
        while let Some(next) = self.next().filter(|next| *next <= end) {
            self.now = self.now.max(next);
            self.step();
            self.settle();
        }
        self.now = end;
    }

    pub(crate) fn frames(&self) -> impl Iterator<Item = &ReceivedFrame> {
        self.events.iter().filter_map(|event| match event {
            Event::Frame(frame) => Some(frame),
            _ => None,
        })
    }

    pub(crate) fn count(&self, matches: impl Fn(&Event) -> bool) -> usize {
        self.events.iter().filter(|event| matches(event)).count()
    }

    fn next(&self) -> Option<Stamp> {
        let arrival = self.under_way.keys().next().map(|(at, _)| *at);
        let server = self.server.as_ref().and_then(Server::timeout);
        let frame = self.server.as_ref().map(|_| self.next_frame);
        [arrival, server, frame, self.client.timeout()]
            .into_iter()
            .flatten()
            .min()
    }

    fn step(&mut self) {
        if self.now >= self.next_frame {
            self.next_frame = self.now.after(milliseconds(10));
            self.send_frame();
        }
        while let Some(entry) = self.under_way.first_entry().filter(|entry| entry.key().0 <= self.now) {
            let datagram = entry.remove();
            self.deliver(&datagram);
        }
        self.client.handle_timeout(self.now);
        if let Some(server) = &mut self.server {
            server.handle_timeout(self.now);
        }
    }

    fn send_frame(&mut self) {
        let Some(server) = self.server.as_mut().filter(|_| self.streaming) else {
            return;
        };
        self.frame_number += 1;
        let mut frame = frame(self.frame_number);
        let transmit = server.ticks(self.now);
        frame.host_stamps = Some(HostStamps {
            mid_exposure: transmit - 50_000,
            data_received: transmit - 10_000,
            transmit,
        });
        server.send_frame(&frame).unwrap();
    }

    fn deliver(&mut self, datagram: &Datagram) {
        if !datagram.to_server {
            self.client.handle(self.now, datagram.from, &datagram.bytes);
        } else if let Some(server) = &mut self.server {
            server.handle(self.now, datagram.from, &datagram.bytes);
        }
    }

    /// Takes what both sides have to say.
    fn settle(&mut self) {
        while let Some(output) = self.client.poll() {
            match output {
                Output::Event(event) => self.events.push(event),
                Output::Transmit(Transmit { bytes, .. }) => {
                    self.sent.push(bytes.clone());
                    self.send(client_address(), true, &bytes);
                }
            }
        }
        while let Some(output) = self.server.as_mut().and_then(Server::poll) {
            match output {
                Output::Event(event) => self.server_events.push(event),
                Output::Transmit(Transmit { socket, bytes, .. }) => {
                    let from = match socket {
                        Socket::Command => server_address(),
                        Socket::Data => data_address(),
                    };
                    self.send(from, false, &bytes);
                }
            }
        }
    }

    fn send(&mut self, from: SocketAddr, to_server: bool, bytes: &Arc<[u8]>) {
        if self.roll(100) < self.link.loss_percent {
            return;
        }
        let copies = 1 + u64::from(self.roll(100) < self.link.duplicate_percent);
        for _ in 0..copies {
            let spread = self.link.longest_delay - self.link.shortest_delay + 1;
            let delay = self.link.shortest_delay + self.roll(spread);
            self.serial += 1;
            let bytes = bytes.clone();
            let key = (self.now.after(Duration::from_micros(delay)), self.serial);
            let datagram = Datagram { from, to_server, bytes };
            self.under_way.insert(key, datagram);
        }
    }

    /// A number below `limit`, the same in every run.
    fn roll(&mut self, limit: u64) -> u64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random % limit
    }
}

pub(crate) fn frame(number: i32) -> Frame {
    Frame {
        number,
        rigid_bodies: vec![RigidBody {
            id: 1,
            position: [number as f32, 1.5, -0.25],
            orientation: [0.0, 0.0, 0.0, 1.0],
            params: Some(BodyParams::TRACKED),
            ..RigidBody::default()
        }],
        timestamp: Some(f64::from(number) / 100.0),
        ..Frame::default()
    }
}

pub(crate) fn model(names: &[&str]) -> Model {
    let describe = |(id, name): (i32, &&str)| {
        Description::RigidBody(RigidBodyDescription {
            name: (*name).into(),
            id,
            ..RigidBodyDescription::default()
        })
    };
    Model {
        descriptions: (1..).zip(names).map(describe).collect(),
    }
}
