//! A server at work, and frames for it to send.

use crate::harness::{Gathered, PATIENCE, Receiver};
use posewire::clock::Clock;
use posewire_natnet::frame::{BodyParams, Frame, HostStamps, RigidBody};
use posewire_natnet::model::{Description, Model, RigidBodyDescription};
use posewire_natnet::server::{Delivery, Server, ServerOptions};
use posewire_natnet::{Error, Name, Output, Socket, Version};
use socket2::SockRef;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The sockets of a server that does not serve yet.
pub(super) struct Sockets {
    command: UdpSocket,
    data: UdpSocket,
    /// Where frames go instead of where the server says.
    pub(super) redirected: Option<SocketAddr>,
}

impl Sockets {
    pub(super) fn bind() -> Self {
        Self::bind_at(([127, 0, 0, 1], 0).into())
    }

    pub(super) fn bind_at(command: SocketAddr) -> Self {
        let data = UdpSocket::bind("127.0.0.1:0").unwrap();
        SockRef::from(&data).set_multicast_if_v4(&Ipv4Addr::LOCALHOST).unwrap();
        let command = UdpSocket::bind(command).unwrap();
        command.set_read_timeout(Some(Duration::from_millis(5))).unwrap();
        Self {
            command,
            data,
            redirected: None,
        }
    }

    pub(super) fn command(&self) -> SocketAddr {
        self.command.local_addr().unwrap()
    }

    pub(super) fn data(&self) -> SocketAddr {
        self.data.local_addr().unwrap()
    }

    /// Serves `model` as the options say, with the data port of the socket unless they multicast.
    pub(super) fn serve(self, mut options: ServerOptions, model: Model) -> Motive {
        if options.delivery == Delivery::Unicast && self.redirected.is_none() {
            options.data_port = self.data().port();
        }
        let mut server = Server::new(options);
        server.set_model(model).unwrap();
        let shared = Arc::new(Shared {
            sockets: self,
            server: Mutex::new(server),
            clock: Clock::new(),
            ended: AtomicBool::new(false),
        });
        let at_work = Arc::clone(&shared);
        Motive {
            thread: Some(thread::spawn(move || at_work.answer())),
            shared,
        }
    }
}

/// A server at work. It vanishes when dropped, without a goodbye.
pub(super) struct Motive {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    sockets: Sockets,
    server: Mutex<Server>,
    clock: Clock,
    ended: AtomicBool,
}

impl Motive {
    /// A server that sends to each client.
    pub(super) fn unicast(version: Version, model: Model) -> Self {
        Sockets::bind().serve(of_version(version), model)
    }

    pub(super) fn command(&self) -> SocketAddr {
        self.shared.sockets.command()
    }

    /// A receiver that is connected and has been told of the subjects.
    pub(super) fn connect(&self, options: &str) -> Receiver {
        let receiver = Receiver::start(&format!("natnet://{}{options}", self.command()));
        receiver.gatherer.wait_until(|gathered| !gathered.subjects.is_empty());
        receiver
    }

    /// The stamps of a frame that is sent now and was exposed 5 ms ago.
    pub(super) fn stamps(&self) -> HostStamps {
        let transmit = self.shared.server.lock().unwrap().ticks(self.shared.clock.steady());
        HostStamps {
            mid_exposure: transmit - 50_000,
            data_received: transmit - 20_000,
            transmit,
        }
    }

    pub(super) fn send(&self, frame: &Frame) -> Result<(), Error> {
        let mut server = self.shared.server.lock().unwrap();
        let sent = server.send_frame(frame);
        self.shared.flush(&mut server);
        sent
    }

    /// Sends a frame and waits until as many samples have come as it holds.
    pub(super) fn send_to(&self, receiver: &Receiver, frame: &Frame, samples: usize) {
        let before = receiver.gatherer.lock().frames.len();
        self.send(frame).unwrap();
        receiver
            .gatherer
            .wait_until(|gathered| gathered.frames.len() >= before + samples);
    }

    /// Sends one frame after the other until what was gathered is enough.
    pub(super) fn send_until(&self, receiver: &Receiver, first: i32, enough: impl Fn(&Gathered) -> bool) {
        let begun = Instant::now();
        for number in first.. {
            self.send(&frame(number)).unwrap();
            if receiver.gatherer.comes_within(Duration::from_millis(10), &enough) {
                return;
            }
            assert!(begun.elapsed() < PATIENCE, "it did not come about");
        }
    }

    pub(super) fn describe(&self, model: Model) {
        self.shared.server.lock().unwrap().set_model(model).unwrap();
    }

    /// Takes a datagram that arrived elsewhere.
    pub(super) fn take(&self, from: SocketAddr, bytes: &[u8]) {
        let mut server = self.shared.server.lock().unwrap();
        server.handle(self.shared.clock.steady(), from, bytes);
        self.shared.flush(&mut server);
    }

    /// Sends any bytes to every client, from the command socket.
    pub(super) fn send_raw(&self, bytes: &[u8]) {
        let server = self.shared.server.lock().unwrap();
        for client in server.clients() {
            self.shared.sockets.command.send_to(bytes, client.address).unwrap();
        }
    }
}

impl Drop for Motive {
    fn drop(&mut self) {
        self.shared.ended.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        assert!(thread::panicking() || ended.is_none_or(|ended| ended.is_ok()));
    }
}

impl Shared {
    fn answer(&self) {
        let mut buffer = [0; 2048];
        while !self.ended.load(Ordering::Relaxed) {
            let received = self.sockets.command.recv_from(&mut buffer);
            let mut server = self.server.lock().unwrap();
            if let Ok((length, from)) = received {
                server.handle(self.clock.steady(), from, &buffer[..length]);
            }
            server.handle_timeout(self.clock.steady());
            self.flush(&mut server);
        }
    }

    fn flush(&self, server: &mut Server) {
        while let Some(output) = server.poll() {
            let Output::Transmit(transmit) = output else { continue };
            // A client that has gone is told of by the next send on some systems.
            let _ = match transmit.socket {
                Socket::Command => self.sockets.command.send_to(&transmit.bytes, transmit.to),
                Socket::Data => {
                    let to = self.sockets.redirected.unwrap_or(transmit.to);
                    self.sockets.data.send_to(&transmit.bytes, to)
                }
            };
        }
    }
}

/// The options of a server that speaks this version.
pub(super) fn of_version(version: Version) -> ServerOptions {
    ServerOptions {
        version,
        ..ServerOptions::default()
    }
}

/// Rigid bodies of these names, numbered from 1.
pub(super) fn bodies<N: AsRef<[u8]>>(names: &[N]) -> Model {
    let describe = |(id, name): (i32, &N)| {
        Description::RigidBody(RigidBodyDescription {
            name: Name::new(name),
            id,
            parent_id: -1,
            ..RigidBodyDescription::default()
        })
    };
    Model {
        descriptions: (1..).zip(names).map(describe).collect(),
    }
}

/// A body of a frame.
pub(super) fn body(id: i32, position: [f32; 3], tracked: bool) -> RigidBody {
    RigidBody {
        id,
        position,
        orientation: [0.0, 0.0, 0.0, 1.0],
        params: Some(if tracked { BodyParams::TRACKED } else { BodyParams(0) }),
        ..RigidBody::default()
    }
}

/// A frame with body 1 where its number says.
pub(super) fn frame(number: i32) -> Frame {
    Frame {
        number,
        rigid_bodies: vec![body(1, [number as f32, 1.5, -0.1], true)],
        timestamp: Some(f64::from(number) / 128.0),
        ..Frame::default()
    }
}
