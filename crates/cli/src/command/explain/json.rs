//! Explanations as JSON, one object a line. The field names are documented in docs/json.md.

use super::Explained;
use crate::json;
use posewire_mxtp::{Datagram, Field, Header, Quirk, Value};
use serde::Serialize;
use std::io::Write;

pub(super) fn write_datagram(explained: &Explained<'_>, out: &mut impl Write) -> posewire::Result<()> {
    let explanation = &explained.explanation;
    let record = DatagramRecord {
        kind: "datagram",
        offset: explained.offset,
        length: explained.bytes.len(),
        summary: Datagram::decode(explained.bytes)
            .ok()
            .map(|datagram| datagram.to_string()),
        header: explained.header().map(HeaderRecord::of),
        fields: explanation.fields.iter().map(FieldRecord::of).collect(),
        quirks: explanation.quirks.iter().map(Quirk::name).collect(),
        error: explanation.error.as_ref().map(ToString::to_string),
    };
    json::write(out, &record)
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
struct DatagramRecord<'a> {
    kind: &'static str,
    offset: usize,
    length: usize,
    summary: Option<String>,
    header: Option<HeaderRecord>,
    fields: Vec<FieldRecord<'a>>,
    quirks: Vec<&'static str>,
    error: Option<String>,
}

#[derive(Serialize)]
struct HeaderRecord {
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

impl HeaderRecord {
    fn of(header: Header) -> Self {
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
                Value::Text(text) => ValueRecord::Text(text),
                bytes @ Value::Bytes(_) => ValueRecord::Hex(bytes.to_string()),
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
    Unsigned(u32),
    Signed(i32),
    Float(f32),
    Text(&'a str),
    Hex(String),
}
