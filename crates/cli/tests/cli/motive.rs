//! A NatNet server that is driven frame by frame.

use posewire::clock::Clock;
use posewire_natnet::frame::{BodyParams, Frame, HostStamps, LabeledMarker, MarkerParams, RigidBody, Skeleton};
use posewire_natnet::model::{BodyMarkerDescription, Description, Model, RigidBodyDescription, SkeletonDescription};
use posewire_natnet::server::{Server, ServerOptions};
use posewire_natnet::{Output, Socket, Version};
use std::net::UdpSocket;
use std::time::{Duration, Instant};

/// A server on a port of the system's choice, with a skeleton of two bones and two rigid bodies.
pub(crate) struct Motive {
    command: UdpSocket,
    data: UdpSocket,
    server: Server,
    clock: Clock,
    frames: i32,
}

impl Motive {
    /// A server that speaks this version.
    pub(crate) fn open(version: Version) -> Self {
        let bind = || UdpSocket::bind("127.0.0.1:0").unwrap();
        let (command, data) = (bind(), bind());
        command.set_read_timeout(Some(Duration::from_millis(2))).unwrap();
        let mut server = Server::new(ServerOptions {
            version,
            data_port: data.local_addr().unwrap().port(),
            ..ServerOptions::default()
        });
        server.set_model(model()).unwrap();
        Self {
            command,
            data,
            server,
            clock: Clock::new(),
            frames: 0,
        }
    }

    /// Where it is, as an endpoint.
    pub(crate) fn endpoint(&self) -> String {
        format!("natnet://{}", self.command.local_addr().unwrap())
    }

    /// Answers what has come.
    pub(crate) fn answer(&mut self) {
        let mut buffer = [0; 2048];
        while let Ok((length, from)) = self.command.recv_from(&mut buffer) {
            self.server.handle(self.clock.steady(), from, &buffer[..length]);
            self.flush();
        }
        self.server.handle_timeout(self.clock.steady());
        self.flush();
    }

    /// Answers and sends fifty frames a second for a while.
    pub(crate) fn play(&mut self, time: Duration) {
        let mut due = Instant::now();
        let end = due + time;
        while due < end {
            self.answer();
            if Instant::now() >= due {
                self.send(true);
                due += Duration::from_millis(20);
            }
        }
    }

    /// Sends the next frame: of the skeleton a bone is lost, of the bodies the second; the first has a marker, and there is a
    /// loose one. The cameras may tell when they
    /// exposed.
    pub(crate) fn send(&mut self, exposure: bool) {
        self.frames += 1;
        let transmit = self.server.ticks(self.clock.steady());
        let frame = Frame {
            number: self.frames,
            rigid_bodies: vec![body(1, [0.5, 1.0, 0.0], true), body(2, [0.0; 3], false)],
            skeletons: vec![Skeleton {
                id: 3,
                bones: vec![
                    body(3 << 16 | 1, [0.0, 1.0, 0.2], true),
                    body(3 << 16 | 2, [0.0; 3], false),
                ],
            }],
            labeled_markers: vec![marker(1 << 16 | 1, [0.5, 1.1, 0.0]), marker(50_007, [1.0, 0.0, 2.0])],
            host_stamps: Some(HostStamps {
                mid_exposure: if exposure { transmit - 50_000 } else { 0 },
                data_received: transmit - 20_000,
                transmit,
            }),
            ..Frame::default()
        };
        self.server.send_frame(&frame).unwrap();
        self.flush();
    }

    fn flush(&mut self) {
        while let Some(output) = self.server.poll() {
            let Output::Transmit(transmit) = output else { continue };
            let socket = match transmit.socket {
                Socket::Command => &self.command,
                Socket::Data => &self.data,
            };
            // A client that has gone is told of by the next send on some systems.
            let _ = socket.send_to(&transmit.bytes, transmit.to);
        }
    }
}

fn model() -> Model {
    let body = |id, name: &str, parent_id| RigidBodyDescription {
        name: name.into(),
        id,
        parent_id,
        ..RigidBodyDescription::default()
    };
    let tip = BodyMarkerDescription {
        name: "Tip".into(),
        ..BodyMarkerDescription::default()
    };
    Model {
        descriptions: vec![
            Description::Skeleton(SkeletonDescription {
                name: "Ada".into(),
                id: 3,
                bones: vec![body(1, "Hip", 0), body(2, "Chest", 1)],
            }),
            Description::RigidBody(RigidBodyDescription {
                markers: vec![tip],
                ..body(1, "Wand", -1)
            }),
            Description::RigidBody(body(2, "Hat", -1)),
        ],
    }
}

fn marker(id: i32, position: [f32; 3]) -> LabeledMarker {
    LabeledMarker {
        id,
        position,
        params: Some(MarkerParams::POINT_CLOUD_SOLVED),
        residual: Some(0.0),
        ..LabeledMarker::default()
    }
}

fn body(id: i32, position: [f32; 3], tracked: bool) -> RigidBody {
    RigidBody {
        id,
        position,
        orientation: [0.0, 0.0, 0.0, 1.0],
        params: Some(if tracked { BodyParams::TRACKED } else { BodyParams(0) }),
        ..RigidBody::default()
    }
}
