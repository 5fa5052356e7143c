//! What goes to clients.

use std::net::SocketAddr;

use super::bones::{fitting_frame, fitting_model};
use super::encodings::Encoded;
use super::{ConnectedClient, Delivery, Event, Server};
use crate::command::{ConnectionInfo, Sender, ServerInfo};
use crate::frame::{Frame, FrameParams};
use crate::model::Model;
use crate::output::Socket;
use crate::{Message, MessageId, Packet, Version};

impl Server {
    /// Everybody who gets the next frame. Who has asked for a single one gets no more.
    pub(super) fn destinations(&mut self) -> Vec<(SocketAddr, Version)> {
        let mut all = std::mem::take(&mut self.single_frames);
        match self.options.delivery {
            Delivery::Unicast => {
                let clients = self.clients().iter().filter(|client| self.is_sent_to(client));
                all.extend(clients.map(|client| (client.address, client.version)));
                if self.options.copy_to_data_port {
                    all.extend(self.copies());
                }
            }
            Delivery::Multicast(group) => all.push(((group, self.options.data_port).into(), self.options.version)),
        }
        all
    }

    /// Where copies go out, a client that has only connected gets nothing else: one that listens at the data port takes
    /// the first packet after its next request for the answer, and a frame must not be that.
    const fn is_sent_to(&self, client: &ConnectedClient) -> bool {
        let is_copied_to = self.options.copy_to_data_port && client.address.port() != self.options.data_port;
        client.has_spoken || !is_copied_to
    }

    /// One copy for every host, unless a client there is at the data port already.
    fn copies(&self) -> impl Iterator<Item = (SocketAddr, Version)> {
        let port = self.options.data_port;
        let copies = self.clients.last_of_each_host().into_iter().map(move |client| {
            let mut address = client.address;
            address.set_port(port);
            (address, client.version)
        });
        copies.filter(|(address, _)| self.clients.find(*address).is_none())
    }

    pub(super) fn introduce(&mut self, to: SocketAddr, version: Version) {
        let info = ServerInfo {
            server: self.sender(version),
            connection: version.has_connection_info().then(|| self.connection()),
        };
        self.outputs.command(to, &Message::ServerInfo(info));
    }

    pub(super) fn send_model(&mut self, to: SocketAddr) {
        let version = self.version_of(to);
        let model = &self.model;
        let packet = self.models.of(version, |layout| model_packet(model, layout));
        match packet {
            Ok(bytes) => self.outputs.transmit(Socket::Command, to, bytes),
            Err(error) => self.outputs.event(Event::ModelTooLarge { client: to, error }),
        }
    }

    pub(super) fn sender(&self, natnet_version: Version) -> Sender {
        Sender {
            name: self.options.name.clone(),
            app_version: self.options.app_version,
            natnet_version,
        }
    }

    fn connection(&self) -> ConnectionInfo {
        let (is_multicast, group) = match self.options.delivery {
            Delivery::Unicast => (false, Delivery::MOTIVE_GROUP),
            Delivery::Multicast(group) => (true, group),
        };
        ConnectionInfo {
            clock_frequency: self.options.clock_frequency,
            data_port: self.options.data_port,
            is_multicast,
            group,
        }
    }
}

pub(super) fn model_packet(model: &Model, layout: Version) -> Encoded {
    let mut bytes = Vec::new();
    let model = fitting_model(model, layout);
    Packet::encode(MessageId::MODEL, &mut bytes, |out| model.encode(layout, out))?;
    Ok(bytes.into())
}

pub(super) fn frame_packet(frame: &Frame, layout: Version, announce: bool) -> Encoded {
    let mut bytes = Vec::new();
    let frame = fitting_frame(frame, layout);
    Packet::encode(MessageId::FRAME, &mut bytes, |out| frame.encode(layout, out))?;
    if announce && layout.has_params() {
        set_model_changed(&mut bytes);
    }
    Ok(bytes.into())
}

/// The packet of a frame in another layout.
pub(super) fn rewritten(packet: &[u8], own: Version, layout: Version) -> Encoded {
    let (message, _) = Message::decode(own, packet)?;
    match message {
        Message::Frame(frame) => frame_packet(&frame, layout, false),
        _ => Ok(packet.into()),
    }
}

/// The bits of a frame are the last but the number that ends it.
fn set_model_changed(packet: &mut [u8]) {
    if let [.., low, _, _, _, _, _] = packet {
        *low |= FrameParams::MODEL_CHANGED.0 as u8;
    }
}
