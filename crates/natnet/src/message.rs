//! Whole packets of every kind.

use std::fmt;

use crate::command::{Connect, EchoRequest, EchoResponse, Response, Sender, ServerInfo, Text};
use crate::frame::Frame;
use crate::model::Model;
use crate::reader::Reader;
use crate::writer::Writer;
use crate::{Error, MessageId, Packet, Quirk, Quirks, Version};

/// A packet of any kind, read.
///
/// A receiver of frames at speed reads [`Packet`] and [`Frame::decode_into`] instead, which allocate
/// nothing.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// Message 0.
    Connect(Connect),
    /// Message 1.
    ServerInfo(ServerInfo),
    /// Message 2.
    Request(Text),
    /// Message 3.
    Response(Response),
    /// Message 4.
    RequestModel,
    /// Message 5.
    Model(Model),
    /// Message 6.
    RequestFrame,
    /// Message 7.
    Frame(Box<Frame>),
    /// Message 8.
    MessageString(Text),
    /// Message 9.
    Disconnect,
    /// Message 10.
    KeepAlive,
    /// Message 11.
    DisconnectByTimeout,
    /// Message 12.
    EchoRequest(EchoRequest),
    /// Message 13.
    EchoResponse(EchoResponse),
    /// Message 14; some send no sender.
    Discovery(Option<Sender>),
    /// Message 100; Motive says who it is, others do not.
    UnrecognizedRequest(Option<Sender>),
    /// Any other number.
    Unknown {
        /// The number.
        id: MessageId,
        /// The payload.
        bytes: Vec<u8>,
    },
}

impl Message {
    /// Reads one datagram, and what was unusual about it. `version` is that of the bitstream; only
    /// frames and descriptions depend on it.
    ///
    /// # Errors
    /// Bytes that are no packet, or a payload that its kind does not allow.
    pub fn decode(version: Version, bytes: &[u8]) -> Result<(Self, Quirks), Error> {
        let packet = Packet::decode(bytes)?;
        let (message, quirks) = read(version, &packet)?;
        Ok((message, packet.quirks.union(quirks)))
    }

    /// Appends the packet to `out`. On an error `out` is what it was.
    ///
    /// # Errors
    /// [`Error::TooLarge`] for more than a datagram can carry.
    pub fn encode(&self, version: Version, out: &mut Vec<u8>) -> Result<(), Error> {
        Packet::encode(self.id(), out, |out| self.encode_payload(version, out))
    }

    /// The number of the message.
    pub const fn id(&self) -> MessageId {
        match self {
            Self::Connect(_) => MessageId::CONNECT,
            Self::ServerInfo(_) => MessageId::SERVER_INFO,
            Self::Request(_) => MessageId::REQUEST,
            Self::Response(_) => MessageId::RESPONSE,
            Self::RequestModel => MessageId::REQUEST_MODEL,
            Self::Model(_) => MessageId::MODEL,
            Self::RequestFrame => MessageId::REQUEST_FRAME,
            Self::Frame(_) => MessageId::FRAME,
            Self::MessageString(_) => MessageId::MESSAGE_STRING,
            Self::Disconnect => MessageId::DISCONNECT,
            Self::KeepAlive => MessageId::KEEP_ALIVE,
            Self::DisconnectByTimeout => MessageId::DISCONNECT_BY_TIMEOUT,
            Self::EchoRequest(_) => MessageId::ECHO_REQUEST,
            Self::EchoResponse(_) => MessageId::ECHO_RESPONSE,
            Self::Discovery(_) => MessageId::DISCOVERY,
            Self::UnrecognizedRequest(_) => MessageId::UNRECOGNIZED_REQUEST,
            Self::Unknown { id, .. } => *id,
        }
    }

    fn encode_payload(&self, version: Version, out: &mut Vec<u8>) {
        match self {
            Self::Connect(connect) => connect.encode(out),
            Self::ServerInfo(info) => info.encode(out),
            Self::Request(text) | Self::MessageString(text) => text.encode(out),
            Self::Response(Response { bytes }) | Self::Unknown { bytes, .. } => out.extend_from_slice(bytes),
            Self::Model(model) => model.encode(version, out),
            Self::Frame(frame) => frame.encode(version, out),
            Self::EchoRequest(echo) => echo.encode(out),
            Self::EchoResponse(echo) => echo.encode(out),
            Self::Discovery(Some(sender)) | Self::UnrecognizedRequest(Some(sender)) => {
                sender.write(&mut Writer::new(out));
            }
            Self::RequestModel
            | Self::RequestFrame
            | Self::Disconnect
            | Self::KeepAlive
            | Self::DisconnectByTimeout
            | Self::Discovery(None)
            | Self::UnrecognizedRequest(None) => {}
        }
    }
}

impl fmt::Display for Message {
    /// One line: `NatNet FRAMEOFDATA frame 162734: 1 of 1 bodies tracked, time 1356.117s`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "NatNet {}", self.id())?;
        match self {
            Self::Connect(connect) => write!(f, " {connect}"),
            Self::ServerInfo(info) => write!(f, " {info}"),
            Self::Request(text) | Self::MessageString(text) => write!(f, " {text}"),
            Self::Response(response) => write!(f, " {response}"),
            Self::Model(model) => write!(f, " {model}"),
            Self::Frame(frame) => write!(f, " {frame}"),
            Self::EchoRequest(echo) => write!(f, " client {}", echo.client_ticks),
            Self::EchoResponse(echo) => write!(f, " client {}, server {}", echo.client_ticks, echo.server_ticks),
            Self::Discovery(Some(sender)) | Self::UnrecognizedRequest(Some(sender)) => write!(f, " {sender}"),
            Self::Unknown { bytes, .. } => write!(f, " {} bytes", bytes.len()),
            _ => Ok(()),
        }
    }
}

fn read(version: Version, packet: &Packet<'_>) -> Result<(Message, Quirks), Error> {
    let payload = packet.payload;
    Ok(match packet.id {
        MessageId::CONNECT => (Message::Connect(Connect::decode(payload)), Quirks::NONE),
        MessageId::SERVER_INFO => with(Message::ServerInfo, ServerInfo::decode(payload)?),
        MessageId::REQUEST => with(Message::Request, Text::decode(payload)),
        MessageId::RESPONSE => {
            let bytes = payload.to_vec();
            (Message::Response(Response { bytes }), Quirks::NONE)
        }
        MessageId::MODEL => with(Message::Model, Model::decode(version, payload)?),
        MessageId::FRAME => with(
            |frame| Message::Frame(Box::new(frame)),
            Frame::decode(version, payload)?,
        ),
        MessageId::MESSAGE_STRING => with(Message::MessageString, Text::decode(payload)),
        MessageId::ECHO_REQUEST => with(Message::EchoRequest, EchoRequest::decode(payload)?),
        MessageId::ECHO_RESPONSE => with(Message::EchoResponse, EchoResponse::decode(payload)?),
        MessageId::DISCOVERY => with(Message::Discovery, optional_sender(payload)),
        MessageId::UNRECOGNIZED_REQUEST => with(Message::UnrecognizedRequest, optional_sender(payload)),
        id => without_payload(id, payload),
    })
}

fn with<T>(wrap: impl FnOnce(T) -> Message, (value, quirks): (T, Quirks)) -> (Message, Quirks) {
    (wrap(value), quirks)
}

fn without_payload(id: MessageId, payload: &[u8]) -> (Message, Quirks) {
    let message = match id {
        MessageId::REQUEST_MODEL => Message::RequestModel,
        MessageId::REQUEST_FRAME => Message::RequestFrame,
        MessageId::DISCONNECT => Message::Disconnect,
        MessageId::KEEP_ALIVE => Message::KeepAlive,
        MessageId::DISCONNECT_BY_TIMEOUT => Message::DisconnectByTimeout,
        id => {
            let bytes = payload.to_vec();
            return (Message::Unknown { id, bytes }, Quirks::NONE);
        }
    };
    (message, surplus(payload.len()))
}

/// A sender, or nothing; anything else counts as a quirk.
fn optional_sender(payload: &[u8]) -> (Option<Sender>, Quirks) {
    let mut reader = Reader::new("sender", payload);
    let sender = Sender::read(&mut reader).ok();
    (sender, surplus(reader.left()))
}

fn surplus(bytes: usize) -> Quirks {
    let mut quirks = Quirks::NONE;
    quirks.insert_if(bytes > 0, Quirk::UnexpectedPayload);
    quirks
}
