//! The receiving side: connect to a server, keep the connection, read what it sends.
//!
//! ```
//! use posewire_motion::Stamp;
//! use posewire_natnet::client::{Client, ClientOptions, Event, Mode};
//! use posewire_natnet::server::{Server, ServerOptions};
//! use posewire_natnet::{Output, Version};
//!
//! let at_server = ([10, 0, 0, 1], 1510).into();
//! let at_client = ([10, 0, 0, 2], 50_000).into();
//! let mut server = Server::new(ServerOptions::default());
//! let mut options = ClientOptions::new(at_server, Mode::Unicast);
//! options.version = Some(Version::new(3, 1));
//! let mut client = Client::new(Stamp(0), options);
//!
//! // What two sockets would do:
//! let Some(Output::Transmit(connect)) = client.poll() else { panic!() };
//! assert_eq!(connect.to, at_server);
//! server.handle(Stamp(1000), at_client, &connect.bytes);
//! while let Some(output) = server.poll() {
//!     if let Output::Transmit(answer) = output {
//!         client.handle(Stamp(2000), at_server, &answer.bytes);
//!     }
//! }
//! let Some(Output::Event(Event::Connected { info, .. })) = client.poll() else { panic!() };
//! assert_eq!(info.server.natnet_version, Version::new(3, 1));
//! ```

mod clock;
mod discovery;
mod event;
mod numbers;
mod options;
mod receive;
mod requests;
mod send;
mod timers;

pub use clock::ClockEstimate;
pub use discovery::{Discovery, Found};
pub use event::{Answer, Event, LostReason, ReceivedFrame};
pub use numbers::{FrameCounts, FrameOrder};
pub use options::{ClientOptions, DataSource, Mode};

use std::net::SocketAddr;

use posewire_motion::Stamp;

use crate::command::ServerInfo;
use crate::output::Outputs;
use crate::{Message, MessageId, Output, Packet, Version};
use clock::ServerClock;
use numbers::FrameNumbers;
use requests::Requests;
use timers::Timers;

/// A client of one server.
///
/// It has no socket and no clock. Hand it every datagram of the command socket, and of the data socket
/// where there is one, with the time of its arrival; call [`handle_timeout`](Self::handle_timeout) when
/// [`timeout`](Self::timeout) says; after each of these take what follows with [`poll`](Self::poll). The time now must
/// not go back; a datagram that has waited in its socket may have arrived before that, as its time then says.
///
/// The client connects, asks for the version that it wants, reads frames as the version that the server
/// grants, asks for the descriptions at the beginning and whenever a frame says that they have changed,
/// asks for the server's clock, and connects again when the server is gone.
///
/// Memory is bounded whatever arrives: 512 outputs that wait to be polled for, the latest frame's bytes,
/// 64 echoes and 16 requests.
#[derive(Debug)]
pub struct Client {
    options: ClientOptions,
    server: Option<Peer>,
    /// The one that answered last.
    last_server: Option<SocketAddr>,
    heard: Stamp,
    timers: Timers,
    requests: Requests,
    clock: ServerClock,
    numbers: FrameNumbers,
    counts: FrameCounts,
    latest: Vec<u8>,
    model_changed: bool,
    closed: bool,
    outputs: Outputs<Event>,
}

/// The server that has answered.
#[derive(Debug)]
struct Peer {
    address: SocketAddr,
    info: ServerInfo,
    version: Version,
}

impl Client {
    /// A client that begins to connect at `now`.
    pub fn new(now: Stamp, options: ClientOptions) -> Self {
        let mut client = Self {
            server: None,
            last_server: None,
            heard: now,
            timers: Timers::new(&options),
            requests: Requests::new(options.retry),
            clock: ServerClock::default(),
            numbers: FrameNumbers::default(),
            counts: FrameCounts::default(),
            latest: Vec::new(),
            model_changed: false,
            closed: false,
            outputs: Outputs::new(),
            options,
        };
        client.timers.connect.start(now);
        client.handle_timeout(now);
        client
    }

    /// Takes in one datagram, from whichever socket, that arrived at `now`.
    pub fn handle(&mut self, now: Stamp, from: SocketAddr, bytes: &[u8]) {
        if self.closed {
            return;
        }
        let packet = Packet::decode(bytes);
        let id = packet.as_ref().ok().map(|packet| packet.id);
        if !self.is_from_server(from, id) {
            self.counts.foreign += 1;
            return;
        }
        let read = match packet {
            Ok(packet) => self.take(now, from, &packet),
            Err(error) => Err(error),
        };
        if let Err(error) = read {
            self.counts.malformed += u64::from(id == Some(MessageId::FRAME));
            self.outputs.event(Event::Malformed { id, error });
        }
    }

    /// Does what is due at `now`.
    pub fn handle_timeout(&mut self, now: Stamp) {
        if self.closed {
            return;
        }
        if self.server.is_some() && now.since(self.heard) >= self.options.lost_after {
            self.lose(now, LostReason::Silent);
        }
        let again = self.timers.stalled.is_due(now) | self.timers.probe.is_due(now);
        if self.timers.connect.is_due(now) || again {
            let connect = Message::Connect(self.connect_message());
            self.outputs.command(self.address(), &connect);
        }
        if self.server.is_some() {
            self.keep_up(now);
            self.ask_for_clock(now);
        }
    }

    /// The next thing that follows. Call it until it returns `None`, after every other call.
    pub fn poll(&mut self) -> Option<Output<Event>> {
        self.outputs.pop()
    }

    /// When [`handle_timeout`](Self::handle_timeout) is next due; `None` after [`disconnect`](Self::disconnect).
    pub fn timeout(&self) -> Option<Stamp> {
        let lost = self.server.as_ref().map(|_| self.heard.after(self.options.lost_after));
        let due = [self.timers.next(), self.requests_due(), lost];
        due.into_iter().flatten().min().filter(|_| !self.closed)
    }

    /// Asks the server something in text, such as `FrameRate`, as soon as it is connected and the requests
    /// before have been answered. The answer comes as [`Event::Answer`]. False when 16 requests wait already.
    pub fn request(&mut self, now: Stamp, text: &str) -> bool {
        let accepted = self.requests.push(now, text, true);
        self.handle_timeout(now);
        accepted
    }

    /// Asks for the descriptions again. A client that is not connected asks for them when it is.
    pub fn request_model(&mut self, now: Stamp) {
        if self.server.is_some() {
            self.timers.model.start(now);
            self.handle_timeout(now);
        }
    }

    /// Says goodbye. Nothing but what waits to be polled for follows.
    pub fn disconnect(&mut self) {
        if self.server.is_some() && !self.closed {
            self.outputs.command(self.address(), &Message::Disconnect);
        }
        self.closed = true;
    }

    /// What the server says about itself, while it is connected.
    pub fn server_info(&self) -> Option<&ServerInfo> {
        self.server.as_ref().map(|peer| &peer.info)
    }

    /// The version that frames and descriptions are read as.
    pub fn version(&self) -> Option<Version> {
        let known = self.server.as_ref().map(|peer| peer.version);
        let is_multicast = self.options.mode == Mode::Multicast;
        known.or(self.options.version.filter(|_| is_multicast))
    }

    /// The server's clock as it is known at `now`; servers before 3.0 do not tell it.
    pub fn clock(&self, now: Stamp) -> Option<ClockEstimate> {
        self.clock.estimate(now)
    }

    /// What was counted about frames.
    pub const fn counts(&self) -> FrameCounts {
        self.counts
    }

    /// Outputs lost because nobody polled for them.
    pub const fn outputs_dropped(&self) -> u64 {
        self.outputs.dropped()
    }
}
