//! MXTP datagrams, as the explanations of every protocol are told.

mod split;

use super::part::{Explained, Field, Header, Quirk, Value};
use crate::cli::Protocol;
use posewire_mxtp::{self as mxtp, Datagram};

pub(super) use split::Parts;

pub(super) fn explain(offset: usize, bytes: &[u8]) -> Explained<'_> {
    let explanation = mxtp::explain(bytes);
    let header = mxtp::Header::decode(bytes).ok();
    Explained {
        offset,
        bytes,
        protocol: Protocol::Mxtp,
        title: title(bytes, header.as_ref()),
        header: header.map(Header::Mxtp),
        bitstream: None,
        document: Some("MV0305"),
        fields: explanation.fields.into_iter().map(Field::from).collect(),
        quirks: explanation.quirks.iter().map(Quirk::from).collect(),
        error: explanation.error.map(|error| error.to_string()),
    }
}

fn title(bytes: &[u8], header: Option<&mxtp::Header>) -> String {
    match (Datagram::decode(bytes), header) {
        (Ok(datagram), _) => datagram.to_string(),
        (Err(_), Some(header)) => format!("{header} malformed"),
        (Err(_), None) => "MXTP malformed header".to_owned(),
    }
}

impl From<mxtp::Quirk> for Quirk {
    fn from(quirk: mxtp::Quirk) -> Self {
        Self {
            name: quirk.name(),
            meaning: quirk.meaning(),
        }
    }
}

impl From<mxtp::Field> for Field {
    fn from(field: mxtp::Field) -> Self {
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

impl From<mxtp::Value> for Value {
    fn from(value: mxtp::Value) -> Self {
        match value {
            mxtp::Value::Unsigned(number) => Self::Unsigned(number.into()),
            mxtp::Value::Signed(number) => Self::Signed(number),
            mxtp::Value::Float(number) => Self::Float(number),
            mxtp::Value::Text(text) => Self::Text(text),
            mxtp::Value::Bytes(bytes) => Self::Bytes(bytes),
        }
    }
}
