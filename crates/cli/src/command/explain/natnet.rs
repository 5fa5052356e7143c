//! NatNet packets, as the explanations of every protocol are told.

mod bitstream;
mod split;

use super::part::{Explained, Field, Header, Quirk, Value};
use crate::cli::Protocol;
use posewire_natnet::{self as natnet, Message, MessageId, Packet, Version};

pub(super) use bitstream::{Bitstream, Origin};
pub(super) use split::{Parts, begins_packet};

pub(super) fn explain<'a>(bitstream: &'a Bitstream, offset: usize, bytes: &'a [u8]) -> Explained<'a> {
    let explanation = natnet::explain(bitstream.version, bytes);
    let packet = Packet::decode(bytes).ok();
    Explained {
        offset,
        bytes,
        protocol: Protocol::Natnet,
        title: title(bitstream.version, bytes, packet.as_ref()),
        header: packet.map(|packet| Header::NatNet {
            message: packet.id,
            payload_size: packet.stated_size,
        }),
        bitstream: has_layout(bytes).then_some(bitstream),
        document: None,
        fields: explanation.fields.into_iter().map(Field::from).collect(),
        quirks: explanation.quirks.iter().map(Quirk::from).collect(),
        error: explanation.error.map(|error| error.to_string()),
    }
}

/// Whether the layout of a packet depends on the bitstream.
fn has_layout(bytes: &[u8]) -> bool {
    Packet::decode(bytes).is_ok_and(|packet| matches!(packet.id, MessageId::FRAME | MessageId::MODEL))
}

fn title(version: Version, bytes: &[u8], packet: Option<&Packet<'_>>) -> String {
    match (Message::decode(version, bytes), packet) {
        (Ok((message, _)), _) => message.to_string(),
        (Err(_), Some(packet)) => format!("NatNet {} malformed", packet.id),
        (Err(_), None) => "NatNet malformed header".to_owned(),
    }
}

impl From<natnet::Quirk> for Quirk {
    fn from(quirk: natnet::Quirk) -> Self {
        Self {
            name: quirk.name(),
            meaning: quirk.meaning(),
        }
    }
}

impl From<natnet::Field> for Field {
    fn from(field: natnet::Field) -> Self {
        Self {
            offset: field.offset,
            length: field.length,
            name: field.name,
            section: field.section,
            value: field.value.into(),
            unit: field.unit,
            note: field.note.map(Into::into),
        }
    }
}

impl From<natnet::Value> for Value {
    fn from(value: natnet::Value) -> Self {
        match value {
            natnet::Value::Unsigned(number) => Self::Unsigned(number),
            natnet::Value::Signed(number) => Self::Signed(number),
            natnet::Value::Float(number) => Self::Float(number),
            natnet::Value::Double(number) => Self::Double(number),
            natnet::Value::Text(text) => Self::Text(text),
            natnet::Value::Bytes(bytes) => Self::Bytes(bytes),
        }
    }
}
