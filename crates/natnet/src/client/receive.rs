//! What comes from a server.

use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use posewire_motion::Stamp;

use super::clock::ServerClock;
use super::requests::Request;
use super::send::BITSTREAM;
use super::{Answer, Client, DataSource, Event, LostReason, Peer, ReceivedFrame};
use crate::command::{EchoResponse, Response, ServerInfo, Text};
use crate::frame::{Frame, FrameParams};
use crate::model::Model;
use crate::{Error, MessageId, Packet};

impl Client {
    pub(super) fn take(&mut self, now: Stamp, from: SocketAddr, packet: &Packet<'_>) -> Result<(), Error> {
        if packet.id == MessageId::SERVER_INFO {
            let (info, _) = ServerInfo::decode(packet.payload)?;
            self.take_server_info(now, from, info);
            return Ok(());
        }
        if packet.id == MessageId::FRAME {
            return self.take_frame(now, packet);
        }
        if self.server.is_none() {
            return Ok(());
        }
        self.heard = self.heard.max(now);
        self.take_command(now, packet)
    }

    fn take_command(&mut self, now: Stamp, packet: &Packet<'_>) -> Result<(), Error> {
        let payload = packet.payload;
        match packet.id {
            MessageId::MODEL => self.take_model(payload)?,
            MessageId::ECHO_RESPONSE => {
                let (response, _) = EchoResponse::decode(payload)?;
                if let Some(estimate) = self.clock.answer(now, response) {
                    self.outputs.event(Event::Clock(estimate));
                }
            }
            MessageId::RESPONSE => {
                let bytes = payload.to_vec();
                self.take_answer(now, Answer::Response(Response { bytes }));
            }
            MessageId::UNRECOGNIZED_REQUEST => self.take_answer(now, Answer::Unrecognized),
            MessageId::MESSAGE_STRING => self.outputs.event(Event::Message(Text::decode(payload).0)),
            MessageId::DISCONNECT_BY_TIMEOUT => self.lose(now, LostReason::TimedOut),
            MessageId::DISCONNECT => self.lose(now, LostReason::Closed),
            _ => {}
        }
        Ok(())
    }

    /// The same server may answer many times: to a connect that was sent twice, or when it was asked whether
    /// it is still there.
    fn take_server_info(&mut self, now: Stamp, from: SocketAddr, info: ServerInfo) {
        self.heard = self.heard.max(now);
        self.timers.connect.stop();
        let version = info.server.natnet_version;
        if let Some(known) = self.server.as_ref().filter(|peer| peer.info == info) {
            // It may have forgotten which version it was asked for after connecting.
            if known.version != version {
                self.negotiate(now);
                self.ask(now);
            }
            return;
        }
        self.adopt(now, from, info);
        self.outputs.event(Event::Version(version));
        self.negotiate(now);
        self.keep_up(now);
    }

    /// Begins anew with a server that was not known.
    fn adopt(&mut self, now: Stamp, from: SocketAddr, info: ServerInfo) {
        let version = info.server.natnet_version;
        self.timers.connected(now, info.connection.is_some(), &self.options);
        self.meet(from, info.connection.map_or(0, |connection| connection.clock_frequency));
        self.requests.restart(now);
        self.model_changed = false;
        let event = Event::Connected {
            server: from,
            info: info.clone(),
        };
        self.server = Some(Peer {
            address: from,
            info,
            version,
        });
        self.outputs.event(event);
    }

    /// The numbers and the clock of another server say nothing; those of the same one say what was missed.
    fn meet(&mut self, server: SocketAddr, clock_frequency: u64) {
        if self.last_server.replace(server).is_some_and(|last| last != server) {
            self.numbers.restart();
            self.latest.clear();
            self.clock = ServerClock::new(clock_frequency);
        } else {
            self.clock.resume(clock_frequency);
        }
    }

    fn take_frame(&mut self, now: Stamp, packet: &Packet<'_>) -> Result<(), Error> {
        let Some(version) = self.version() else {
            self.count_unread();
            return Ok(());
        };
        self.heard = self.heard.max(now);
        if packet.payload == self.latest {
            self.counts.duplicate += 1;
            return Ok(());
        }
        let (frame, quirks) = Frame::decode(version, packet.payload)?;
        self.latest.clear();
        self.latest.extend_from_slice(packet.payload);
        if self.server.is_some() {
            self.note_frame(now, &frame);
        }
        let order = self.numbers.note(now, &frame, &mut self.counts);
        let number = frame.number;
        self.outputs.event(Event::Frame(ReceivedFrame {
            frame: Arc::new(frame),
            received: now,
            order,
            late: self.numbers.newest() != Some(number),
            quirks: packet.quirks.union(quirks),
        }));
        Ok(())
    }

    fn count_unread(&mut self) {
        if self.numbers.have_begun() {
            self.counts.refused += 1;
        } else {
            self.counts.early += 1;
        }
    }

    /// The bits of a frame ask for something when they appear; some servers leave them set.
    fn note_frame(&mut self, now: Stamp, frame: &Frame) {
        let params = frame.params.unwrap_or_default();
        let model_changed = params.contains(FrameParams::MODEL_CHANGED);
        // After a pause the server may be another one at the same place.
        let after_pause = self.timers.frame_came(now, &self.options);
        if after_pause {
            self.numbers.pause();
            self.negotiate(now);
        }
        if after_pause || (model_changed && !self.model_changed) {
            self.timers.model.start(now);
            self.keep_up(now);
        }
        self.model_changed = model_changed;
        if params.contains(FrameParams::BITSTREAM_CHANGED) && self.requests.next().is_none() {
            self.requests.push(now, BITSTREAM, false);
        }
    }

    fn take_model(&mut self, payload: &[u8]) -> Result<(), Error> {
        let Some(version) = self.version() else {
            return Ok(());
        };
        let (model, quirks) = Model::decode(version, payload)?;
        self.timers.model.stop();
        let model = Arc::new(model);
        self.outputs.event(Event::Model { model, quirks });
        Ok(())
    }

    fn take_answer(&mut self, now: Stamp, answer: Answer) {
        if let Some(request) = self.requests.answered(now) {
            self.answer(now, request, answer);
            self.ask(now);
        }
    }

    pub(super) fn answer(&mut self, now: Stamp, request: Request, answer: Answer) {
        if request.is_callers {
            let request = request.text;
            self.outputs.event(Event::Answer { request, answer });
        } else if let Answer::Response(response) = answer {
            self.take_version(now, &response);
        }
    }

    /// `Bitstream,3.1`: what the server says that it sends.
    fn take_version(&mut self, now: Stamp, response: &Response) {
        let text = response.as_text();
        let text = text.to_text();
        let stated = text
            .strip_prefix("Bitstream,")
            .and_then(|text| text.trim().parse().ok());
        let (Some(version), Some(peer)) = (stated, &mut self.server) else {
            return;
        };
        if peer.version != version {
            peer.version = version;
            self.outputs.event(Event::Version(version));
            self.timers.model.start(now);
        }
    }

    pub(super) fn is_from_server(&self, from: SocketAddr, id: Option<MessageId>) -> bool {
        let server = self.address().ip();
        let is = |address: IpAddr| address == from.ip();
        match self.options.data_source {
            DataSource::Any if id == Some(MessageId::FRAME) => true,
            DataSource::Address(address) if id == Some(MessageId::FRAME) => is(address),
            _ => is(server) || self.server.is_none() && !names_one_host(server),
        }
    }
}

/// Whether an address is that of one host, which alone may answer.
fn names_one_host(address: IpAddr) -> bool {
    let is_broadcast = matches!(address, IpAddr::V4(v4) if v4.is_broadcast());
    !(is_broadcast || address.is_multicast() || address.is_unspecified())
}
