//! The sending side: be Motive to its clients.

mod bones;
mod clients;
mod encodings;
mod event;
mod options;
mod receive;
mod requests;
mod send;

pub use clients::ConnectedClient;
pub use event::{Event, LeftReason};
pub use options::{Delivery, ServerOptions};

use std::net::SocketAddr;

use posewire_motion::Stamp;

use crate::frame::Frame;
use crate::model::Model;
use crate::output::{Outputs, Socket};
use crate::{Error, Message, MessageId, Output, Packet, Version};
use clients::Clients;
use encodings::Encodings;
use send::{frame_packet, model_packet, rewritten};

/// A server of any number of versions at once.
///
/// It has no socket and no clock. Hand it every datagram of the command socket with the time of its arrival, the
/// descriptions with [`set_model`](Self::set_model) and every frame with [`send_frame`](Self::send_frame); call
/// [`handle_timeout`](Self::handle_timeout) when [`timeout`](Self::timeout) says; after each of these take what
/// follows with [`poll`](Self::poll). Times must not go back.
///
/// A client that connects is told the version that it will get: the one that it asks for, or the server's own when
/// that is older or there is no wish. An old client that cannot wish gets what it says that it speaks. Before 2.1 there are
/// no skeletons: there, bones are rigid bodies called `Subject/Bone`, with the IDs that bones have in frames.
///
/// Memory is bounded whatever arrives: 64 clients and 512 outputs that wait to be polled for. A client that never
/// reads costs what it costs to send to it.
///
/// ```
/// use posewire_motion::Stamp;
/// use posewire_natnet::frame::Frame;
/// use posewire_natnet::server::{Server, ServerOptions};
/// use posewire_natnet::{Message, Output, Socket, Version};
///
/// let client = ([10, 0, 0, 2], 50_000).into();
/// let mut server = Server::new(ServerOptions::default());
/// server.handle(Stamp(0), client, &[0, 0, 0, 0]); // The shortest connect.
/// let frame = Frame { number: 7, ..Frame::default() };
/// server.send_frame(&frame)?;
///
/// let sent = std::iter::from_fn(|| server.poll()).find_map(|output| match output {
///     Output::Transmit(transmit) if transmit.socket == Socket::Data => Some(transmit),
///     _ => None,
/// });
/// let sent = sent.expect("one client is connected");
/// assert_eq!(sent.to, client);
/// let (message, _) = Message::decode(Version::new(4, 1), &sent.bytes)?;
/// assert!(matches!(message, Message::Frame(frame) if frame.number == 7));
/// # Ok::<(), posewire_natnet::Error>(())
/// ```
#[derive(Debug)]
pub struct Server {
    options: ServerOptions,
    clients: Clients,
    model: Model,
    models: Encodings,
    /// Frames that are still to say that the descriptions have changed.
    announcements: u32,
    /// Whether the last frame said so, and whether the next one must not: clients heed the bit when it appears.
    announced: bool,
    pauses: bool,
    /// Who asked for a single frame, in which version.
    single_frames: Vec<(SocketAddr, Version)>,
    outputs: Outputs<Event>,
}

impl Server {
    /// A server without clients and descriptions.
    pub const fn new(options: ServerOptions) -> Self {
        Self {
            options,
            clients: Clients::new(),
            model: Model {
                descriptions: Vec::new(),
            },
            models: Encodings::new(),
            announcements: 0,
            announced: false,
            pauses: false,
            single_frames: Vec::new(),
            outputs: Outputs::new(),
        }
    }

    /// Takes in one datagram of the command socket that arrived at `now`.
    pub fn handle(&mut self, now: Stamp, from: SocketAddr, bytes: &[u8]) {
        let packet = Packet::decode(bytes);
        let id = packet.as_ref().ok().map(|packet| packet.id);
        if let Some(client) = self.clients.find_mut(from) {
            client.heard = now;
            client.has_spoken |= id != Some(MessageId::CONNECT);
        }
        if let Err(error) = packet.and_then(|packet| self.take(now, from, &packet)) {
            self.outputs.event(Event::Malformed { from, id, error });
        }
    }

    /// Drops the clients that have been silent for too long.
    pub fn handle_timeout(&mut self, now: Stamp) {
        let Some(limit) = self.options.silence_limit else {
            return;
        };
        while let Some(client) = self.clients.remove_silent(now, limit, self.options.copy_to_data_port) {
            self.outputs.command(client, &Message::DisconnectByTimeout);
            let reason = LeftReason::Silent;
            self.outputs.event(Event::Left { client, reason });
        }
    }

    /// The next thing that follows. Call it until it returns `None`, after every other call.
    pub fn poll(&mut self) -> Option<Output<Event>> {
        self.outputs.pop()
    }

    /// When [`handle_timeout`](Self::handle_timeout) is next due.
    pub fn timeout(&self) -> Option<Stamp> {
        let limit = self.options.silence_limit?;
        let heard = self.clients.longest_silent(self.options.copy_to_data_port)?;
        Some(heard.after(limit))
    }

    /// Replaces the descriptions. The next frames say that they have changed, so that clients ask for them.
    ///
    /// # Errors
    /// [`Error::TooLarge`] when no datagram of the server's own version can carry them; the old ones stay.
    pub fn set_model(&mut self, model: Model) -> Result<(), Error> {
        model_packet(&model, self.options.version)?;
        self.model = model;
        self.models.clear();
        self.announcements = ANNOUNCEMENTS;
        self.pauses = self.announced;
        Ok(())
    }

    /// Changes how many frames a second those who ask are told.
    pub const fn set_frame_rate(&mut self, frame_rate: f32) {
        self.options.frame_rate = frame_rate;
    }

    /// Sends a frame to all who get frames, each in its version; it is encoded once for every layout.
    ///
    /// # Errors
    /// [`Error::TooLarge`] when the frame is too large in one of the versions; the others are sent.
    pub fn send_frame(&mut self, frame: &Frame) -> Result<(), Error> {
        let announce = self.announces();
        let mut encodings = Encodings::new();
        let mut result = Ok(());
        for (to, version) in self.destinations() {
            match encodings.of(version, |layout| frame_packet(frame, layout, announce)) {
                Ok(bytes) => self.outputs.transmit(Socket::Data, to, bytes),
                Err(error) => result = Err(error),
            }
        }
        result
    }

    /// Sends a frame that is there as a packet of the server's own version: as it is to all who get that layout, and written anew for
    /// the others.
    ///
    /// # Errors
    /// Those of [`Message::decode`] and [`Error::TooLarge`] when it cannot be written anew; those who get it as it is have it all
    /// the same.
    pub fn relay_frame(&mut self, packet: &[u8]) -> Result<(), Error> {
        let own = self.options.version;
        let mut encodings = Encodings::new();
        // The first of its layout is what all of them get.
        let _ = encodings.of(own, |_| Ok(packet.into()));
        let mut result = Ok(());
        for (to, version) in self.destinations() {
            match encodings.of(version, |layout| rewritten(packet, own, layout)) {
                Ok(bytes) => self.outputs.transmit(Socket::Data, to, bytes),
                Err(error) => result = Err(error),
            }
        }
        result
    }

    /// Whether the next frame says that the descriptions have changed.
    fn announces(&mut self) -> bool {
        self.announced = self.announcements > 0 && !self.pauses;
        self.announcements -= u32::from(self.announced);
        self.pauses = false;
        self.announced
    }

    /// Sends a line for the log to every client (unicast).
    pub fn send_message(&mut self, text: &str) {
        let message = Message::MessageString(text.into());
        for client in self.clients.as_slice() {
            self.outputs.command(client.address, &message);
        }
    }

    /// Says goodbye to every client.
    pub fn close(&mut self) {
        for client in std::mem::take(&mut self.clients).as_slice() {
            self.outputs.command(client.address, &Message::Disconnect);
        }
    }

    /// What the server's clock shows at `now`: for the host stamps of frames.
    pub fn ticks(&self, now: Stamp) -> u64 {
        let ticks = i128::from(now.0) * i128::from(self.options.clock_frequency) / 1_000_000_000;
        ticks.clamp(0, u64::MAX.into()) as u64
    }

    /// The clients that get frames, in the order in which they have connected. There are none when frames go to a
    /// group.
    pub fn clients(&self) -> &[ConnectedClient] {
        self.clients.as_slice()
    }

    /// Outputs lost because nobody polled for them.
    pub const fn outputs_dropped(&self) -> u64 {
        self.outputs.dropped()
    }
}

/// How many frames say that the descriptions have changed: one may be lost, and some clients ask each time.
const ANNOUNCEMENTS: u32 = 3;
