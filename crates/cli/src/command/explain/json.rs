//! Explanations as JSON, one object a line. The field names are documented in docs/json.md.

use super::natnet::{Bitstream, Origin};
use super::part::{Explained, Field, Header, Value, hexadecimal};
use crate::json;
use posewire::capture::Captured;
use posewire_natnet::{MessageId, Version};
use serde::Serialize;
use std::io::Write;

pub(super) fn write_datagram(explained: &Explained<'_>, out: &mut impl Write) -> posewire::Result<()> {
    json::write(out, &DatagramRecord::of(explained, None))
}

/// Also says when a datagram was captured, and between whom.
pub(super) fn write_captured(
    explained: &Explained<'_>,
    captured: &Captured,
    out: &mut impl Write,
) -> posewire::Result<()> {
    let datagram = &captured.datagram;
    let captured = CapturedRecord {
        source: captured.source,
        wire: datagram.wire.name(),
        from: datagram.from.to_string(),
        to: datagram.to.to_string(),
        received_ns: datagram.received.nanoseconds(),
    };
    json::write(out, &DatagramRecord::of(explained, Some(captured)))
}

pub(super) fn write_skipped(offset: usize, length: usize, out: &mut impl Write) -> posewire::Result<()> {
    json::write(
        out,
        &SkippedRecord {
            kind: "skipped",
            offset,
            length,
        },
    )
}

#[derive(Serialize)]
struct SkippedRecord {
    kind: &'static str,
    offset: usize,
    length: usize,
}

#[derive(Serialize)]
struct CapturedRecord {
    source: u16,
    wire: &'static str,
    from: String,
    to: String,
    received_ns: i64,
}

#[derive(Serialize)]
struct DatagramRecord<'a> {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    captured: Option<CapturedRecord>,
    protocol: &'static str,
    offset: usize,
    length: usize,
    summary: Option<&'a str>,
    header: Option<HeaderRecord>,
    bitstream: Option<BitstreamRecord>,
    fields: Vec<FieldRecord<'a>>,
    quirks: Vec<&'static str>,
    error: Option<&'a str>,
}

impl<'a> DatagramRecord<'a> {
    fn of(explained: &'a Explained<'_>, captured: Option<CapturedRecord>) -> Self {
        Self {
            kind: "datagram",
            captured,
            protocol: explained.protocol.name(),
            offset: explained.offset,
            length: explained.bytes.len(),
            summary: Some(&*explained.title).filter(|_| explained.error.is_none()),
            header: explained.header.as_ref().map(HeaderRecord::of),
            bitstream: explained.bitstream.map(BitstreamRecord::of),
            fields: explained.fields.iter().map(FieldRecord::of).collect(),
            quirks: explained.quirks.iter().map(|quirk| quirk.name).collect(),
            error: explained.error.as_deref(),
        }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum HeaderRecord {
    Mxtp(MxtpHeaderRecord),
    NatNet(NatNetHeaderRecord),
}

impl HeaderRecord {
    fn of(header: &Header) -> Self {
        match header {
            Header::Mxtp(header) => Self::Mxtp(MxtpHeaderRecord::of(header)),
            Header::NatNet { message, payload_size } => Self::NatNet(NatNetHeaderRecord::of(*message, *payload_size)),
        }
    }
}

#[derive(Serialize)]
struct MxtpHeaderRecord {
    #[serde(rename = "type")]
    message_type: String,
    name: &'static str,
    revision: String,
    sample: u32,
    counter: u8,
    items: u8,
    time_ms: u32,
    character: u8,
    body_segments: u8,
    props: u8,
    finger_segments: u8,
    reserved: [u8; 2],
    payload_size: u16,
}

impl MxtpHeaderRecord {
    fn of(header: &posewire_mxtp::Header) -> Self {
        Self {
            message_type: header.message_type.to_string(),
            name: header.message_type.name(),
            revision: format!("{:?}", header.revision()),
            sample: header.sample,
            counter: header.counter.0,
            items: header.items,
            time_ms: header.time_ms,
            character: header.character,
            body_segments: header.body_segments,
            props: header.props,
            finger_segments: header.finger_segments,
            reserved: header.reserved,
            payload_size: header.payload_size,
        }
    }
}

#[derive(Serialize)]
struct NatNetHeaderRecord {
    message: u16,
    name: &'static str,
    payload_size: u16,
}

impl NatNetHeaderRecord {
    const fn of(message: MessageId, payload_size: u16) -> Self {
        Self {
            message: message.0,
            name: message.name(),
            payload_size,
        }
    }
}

#[derive(Serialize)]
struct BitstreamRecord {
    version: String,
    given: bool,
    by: &'static str,
    alike: Vec<String>,
    otherwise: Vec<String>,
}

impl BitstreamRecord {
    fn of(bitstream: &Bitstream) -> Self {
        let texts = |versions: &[Version]| versions.iter().map(ToString::to_string).collect();
        let (alike, otherwise) = match &bitstream.origin {
            Origin::Fits { alike, otherwise, .. } => (texts(alike), texts(otherwise)),
            _ => (Vec::new(), Vec::new()),
        };
        Self {
            version: bitstream.version.to_string(),
            given: bitstream.origin == Origin::Given,
            by: match bitstream.origin {
                Origin::Given => "version",
                Origin::Stated => "server",
                Origin::Fits { .. } | Origin::FitsNone => "bytes",
            },
            alike,
            otherwise,
        }
    }
}

#[derive(Serialize)]
struct FieldRecord<'a> {
    offset: usize,
    length: usize,
    name: &'a str,
    value: ValueRecord<'a>,
    unit: Option<&'a str>,
    section: Option<&'a str>,
    note: Option<&'a str>,
}

impl<'a> FieldRecord<'a> {
    fn of(field: &'a Field) -> Self {
        Self {
            offset: field.offset,
            length: field.length,
            name: &field.name,
            value: match &field.value {
                Value::Unsigned(number) => ValueRecord::Unsigned(*number),
                Value::Signed(number) => ValueRecord::Signed(*number),
                Value::Float(number) => ValueRecord::Float(*number),
                Value::Double(number) => ValueRecord::Double(*number),
                Value::Text(text) => ValueRecord::Text(text),
                Value::Bytes(bytes) => ValueRecord::Hex(hexadecimal(bytes)),
            },
            unit: field.unit,
            section: Some(field.section).filter(|section| !section.is_empty()),
            note: field.note.as_deref(),
        }
    }
}

/// A number that is not finite becomes `null`.
#[derive(Serialize)]
#[serde(untagged)]
enum ValueRecord<'a> {
    Unsigned(u64),
    Signed(i32),
    Float(f32),
    Double(f64),
    Text(&'a str),
    Hex(String),
}
