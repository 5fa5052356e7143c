//! What comes from clients.

use std::net::SocketAddr;

use posewire_motion::Stamp;

use super::clients::{Admission, MAX_CLIENTS};
use super::requests::{DONE, INVALID_OPERATION, Wish};
use super::{ConnectedClient, Delivery, Event, LeftReason, Server};
use crate::command::{Connect, EchoRequest, EchoResponse, Response, Text};
use crate::{Error, Message, MessageId, Packet, Version};

impl Server {
    pub(super) fn take(&mut self, now: Stamp, from: SocketAddr, packet: &Packet<'_>) -> Result<(), Error> {
        match packet.id {
            MessageId::CONNECT => self.connect(now, from, Connect::decode(packet.payload)),
            MessageId::DISCOVERY => self.introduce(from, self.version_of(from)),
            MessageId::REQUEST => self.take_request(from, Text::decode(packet.payload).0),
            MessageId::REQUEST_MODEL => self.send_model(from),
            MessageId::REQUEST_FRAME => self.note_single_frame(from),
            MessageId::DISCONNECT => self.disconnect(from),
            MessageId::KEEP_ALIVE => self.note_keep_alive(from),
            MessageId::ECHO_REQUEST => {
                let (EchoRequest { client_ticks }, _) = EchoRequest::decode(packet.payload)?;
                let server_ticks = self.ticks(now);
                let response = EchoResponse {
                    client_ticks,
                    server_ticks,
                };
                self.outputs.command(from, &Message::EchoResponse(response));
            }
            _ => {}
        }
        Ok(())
    }

    /// Connecting again is how clients of old versions ask whether the server is still there.
    fn connect(&mut self, now: Stamp, from: SocketAddr, connect: Connect) {
        if self.options.delivery != Delivery::Unicast {
            self.introduce(from, self.options.version);
            return;
        }
        let version = self.grant(wish_of(&connect));
        let client = ConnectedClient {
            address: from,
            version,
            heard: now,
            keeps_alive: false,
            has_spoken: false,
        };
        match self.clients.admit(client) {
            Admission::Refused => return self.refuse(from),
            Admission::Known => {}
            Admission::New => self.outputs.event(Event::Connected {
                client: from,
                sender: connect.sender,
                version,
            }),
        }
        self.introduce(from, version);
    }

    fn refuse(&mut self, client: SocketAddr) {
        let text = format!("this server has {MAX_CLIENTS} clients and takes no more");
        self.outputs
            .command(client, &Message::MessageString(text.as_str().into()));
        self.outputs.event(Event::Refused { client });
    }

    fn disconnect(&mut self, client: SocketAddr) {
        self.single_frames.retain(|(address, _)| *address != client);
        if self.clients.remove(client) {
            let reason = LeftReason::Disconnected;
            self.outputs.event(Event::Left { client, reason });
        }
    }

    fn take_request(&mut self, from: SocketAddr, text: Text) {
        let wish = Wish::of(&text.0.to_text(), &self.options);
        let recognized = wish != Wish::Unknown;
        let answer = self.fulfil(from, wish);
        self.outputs.command(from, &answer);
        self.outputs.event(Event::Request { from, text, recognized });
    }

    fn fulfil(&mut self, from: SocketAddr, wish: Wish) -> Message {
        match wish {
            Wish::Answer(response) => Message::Response(response),
            Wish::Version => {
                let Version { major, minor, .. } = self.version_of(from);
                Message::Response(Response::text(&format!("Bitstream,{major}.{minor}")))
            }
            Wish::NewVersion(wish) => Message::Response(Response::number(self.change_version(from, wish))),
            Wish::Disconnect => {
                self.disconnect(from);
                Message::Response(Response::number(DONE))
            }
            Wish::Unknown => Message::UnrecognizedRequest(Some(self.sender(self.version_of(from)))),
        }
    }

    fn change_version(&mut self, from: SocketAddr, wish: Version) -> i32 {
        let version = self.grant(Some(wish));
        let Some(client) = self.clients.find_mut(from) else {
            return INVALID_OPERATION;
        };
        if client.version != version {
            client.version = version;
            let client = from;
            self.outputs.event(Event::Version { client, version });
        }
        DONE
    }

    fn note_keep_alive(&mut self, from: SocketAddr) {
        if let Some(client) = self.clients.find_mut(from) {
            client.keeps_alive = true;
        }
    }

    /// A client that is connected gets frames anyway.
    fn note_single_frame(&mut self, from: SocketAddr) {
        let waits = self.single_frames.iter().any(|(address, _)| *address == from);
        if !waits && self.clients.find(from).is_none() && self.single_frames.len() < MAX_CLIENTS {
            self.single_frames.push((from, self.options.version));
        }
    }

    fn grant(&self, wish: Option<Version>) -> Version {
        wish.map_or(self.options.version, |wish| wish.min(self.options.version))
    }

    /// The version that a client gets; the server's own for who is no client.
    pub(super) fn version_of(&self, address: SocketAddr) -> Version {
        self.clients
            .find(address)
            .map_or(self.options.version, |client| client.version)
    }
}

/// What a client wants: a version that it asks for, or else the one that it speaks when it is too old to ask.
fn wish_of(connect: &Connect) -> Option<Version> {
    let speaks = || connect.sender.as_ref().map(|sender| sender.natnet_version);
    match connect.options {
        Some(_) => connect.requested_version(),
        None => speaks().filter(|version| *version >= OLDEST_SPOKEN),
    }
}

const OLDEST_SPOKEN: Version = Version::new(1, 4);
