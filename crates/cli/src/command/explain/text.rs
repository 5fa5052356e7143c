//! Explanations for people: a summary, a table of the fields, what is unusual.

use super::{Explained, Tally};
use crate::plain::{cut, grouped, plural, printable};
use posewire_mxtp::{Datagram, Field, Value};
use std::io::{self, Write};

pub(super) fn write_datagram(explained: &Explained<'_>, out: &mut impl Write) -> io::Result<()> {
    let explanation = &explained.explanation;
    if explained.offset > 0 {
        writeln!(out)?;
    }
    writeln!(out, "{}", summary(explained))?;
    writeln!(out, "{}\n", circumstances(explained))?;
    write_table(&explanation.fields, explained.bytes, out)?;
    for (place, quirk) in explanation.quirks.iter().enumerate() {
        let title = if place == 0 { "\nquirks\n" } else { "" };
        writeln!(out, "{title}  {:<22} {}", quirk.name(), quirk.meaning())?;
    }
    match &explanation.error {
        Some(error) => writeln!(out, "\nmalformed\n  {}", printable(&error.to_string())),
        None => Ok(()),
    }
}

pub(super) fn write_skipped(offset: usize, bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    if offset > 0 {
        writeln!(out)?;
    }
    let beginning = hexadecimal(bytes);
    let count = plural(bytes.len() as u64, "byte");
    writeln!(
        out,
        "skipped {count} at byte {}: {beginning}, part of no datagram",
        grouped(offset as u64)
    )
}

pub(super) fn write_tally(tally: &Tally, out: &mut impl Write) -> io::Result<()> {
    write!(out, "\n{}", plural(tally.decoded + tally.malformed, "datagram"))?;
    if tally.malformed > 0 {
        write!(out, ", {} of them malformed", grouped(tally.malformed))?;
    }
    if tally.skipped > 0 {
        write!(out, ", {} skipped", plural(tally.skipped, "byte"))?;
    }
    writeln!(out)
}

/// What it is, in one line.
fn summary(explained: &Explained<'_>) -> String {
    let text = match (Datagram::decode(explained.bytes), explained.header()) {
        (Ok(datagram), _) => datagram.to_string(),
        (Err(_), Some(header)) => format!("{header} malformed"),
        (Err(_), None) => "MXTP malformed header".to_owned(),
    };
    cut(&printable(&text), 200)
}

fn circumstances(explained: &Explained<'_>) -> String {
    let size = plural(explained.bytes.len() as u64, "byte");
    let place = format!("{size} at byte {}", grouped(explained.offset as u64));
    match explained.header() {
        Some(header) => {
            let name = match header.message_type.name() {
                "unknown" => "unknown type",
                name => name,
            };
            format!("{name}, Rev {:?}, {place}", header.revision())
        }
        None => place,
    }
}

fn write_table(fields: &[Field], bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    let table = Table::of(fields);
    table.write_head(out)?;
    for field in fields {
        let field_bytes = bytes.get(field.offset..field.offset + field.length).unwrap_or_default();
        table.write_field(field, field_bytes, out)?;
    }
    Ok(())
}

/// How wide the columns are.
struct Table {
    bytes: usize,
    section: usize,
    name: usize,
    /// Characters before the decimal point.
    whole: usize,
    value: usize,
    unit: usize,
}

impl Table {
    fn of(fields: &[Field]) -> Self {
        let widest = |width: &dyn Fn(&Field) -> usize| fields.iter().map(width).max().unwrap_or(0);
        let whole = widest(&|field| match field.value {
            Value::Float(_) => whole_digits(&value(&field.value)),
            _ => 1,
        });
        let number = |field: &Field| match field.value {
            Value::Text(_) | Value::Bytes(_) => 0,
            _ => aligned(&field.value, whole).len(),
        };
        Self {
            bytes: widest(&|field| (field.length * 2).min(SHOWN * 2 + 1)).max("bytes".len()),
            section: widest(&|field| section(field).len()).max(SPECIFICATION.len()),
            name: widest(&|field| field.name.chars().count()).clamp("field".len(), LONGEST_NAME),
            whole,
            value: widest(&number).max("value".len()),
            unit: widest(&|field| field.unit.map_or(0, str::len)),
        }
    }

    fn write_head(&self, out: &mut impl Write) -> io::Result<()> {
        let line = self.left("offset", "bytes", SPECIFICATION, "field") + "value";
        writeln!(out, "{line}")
    }

    fn write_field(&self, field: &Field, bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
        let name = cut(&printable(&field.name), LONGEST_NAME);
        let left = self.left(&field.offset.to_string(), &hexadecimal(bytes), section(field), &name);
        let unit = field.unit.unwrap_or_default();
        let number = aligned(&field.value, self.whole);
        let width = self.value;
        let mut line = format!("{left}{number:<width$}  {unit}").trim_end().to_owned();
        if let Some(note) = &field.note {
            line = self.with_note(&line, &printable(note), unit.is_empty());
        }
        writeln!(out, "{line}")?;
        match &field.value {
            Value::Bytes(bytes) if bytes.len() > SHOWN => write_dump(field.offset, bytes, out),
            _ => Ok(()),
        }
    }

    /// The columns before the value.
    fn left(&self, offset: &str, bytes: &str, section: &str, name: &str) -> String {
        let (b, s, n) = (self.bytes, self.section, self.name);
        format!("{offset:>6}  {bytes:<b$}  {section:<s$}  {name:<n$}  ")
    }

    /// The line with a note behind it, or on a line of its own when there is no room.
    fn with_note(&self, line: &str, note: &str, without_unit: bool) -> String {
        let begin = self.left("", "", "", "").chars().count();
        let column = begin + self.value + 2 + if without_unit { 0 } else { self.unit + 2 };
        let width = note.chars().count();
        let used = (line.chars().count() + 2).max(column);
        if used + width <= PAGE {
            let column = used - 2;
            format!("{line:<column$}  {note}")
        } else {
            let indent = begin.min(PAGE.saturating_sub(width));
            format!("{line}\n{:indent$}{note}", "")
        }
    }
}

/// The section's number; the head of the column names the document.
fn section(field: &Field) -> &str {
    field
        .section
        .strip_prefix(SPECIFICATION)
        .unwrap_or(field.section)
        .trim_start()
}

fn aligned(of: &Value, whole: usize) -> String {
    let text = value(of);
    match of {
        Value::Text(_) | Value::Bytes(_) => text,
        _ => format!("{:gap$}{text}", "", gap = whole.saturating_sub(whole_digits(&text))),
    }
}

fn whole_digits(number: &str) -> usize {
    number.find(['.', 'e']).unwrap_or(number.len())
}

fn value(of: &Value) -> String {
    match of {
        // Shortest digits that give the same bits again; as a power of ten where that is shorter.
        Value::Float(number) if *number != 0.0 && !(1e-4..1e7).contains(&number.abs()) => format!("{number:e}"),
        Value::Float(number) => number.to_string(),
        Value::Text(text) => cut(&format!("{:?}", cut(text, LONGEST_TEXT)), LONGEST_TEXT * 2),
        Value::Bytes(bytes) if bytes.len() > SHOWN => plural(bytes.len() as u64, "byte"),
        other => other.to_string(),
    }
}

/// The first bytes of a field.
fn hexadecimal(bytes: &[u8]) -> String {
    let shown = Value::Bytes(bytes[..bytes.len().min(SHOWN)].to_vec()).to_string();
    if bytes.len() > SHOWN { shown + "…" } else { shown }
}

/// Bytes without a meaning, sixteen a line.
fn write_dump(offset: usize, bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    for (row, line) in bytes.chunks(16).take(DUMPED_LINES).enumerate() {
        let digits: Vec<_> = line.chunks(2).map(hexadecimal).collect();
        let letter = |&byte: &u8| {
            if byte.is_ascii_graphic() || byte == b' ' {
                byte as char
            } else {
                '.'
            }
        };
        let letters: String = line.iter().map(letter).collect();
        writeln!(out, "{:>14}  {:<39}  {letters}", offset + row * 16, digits.join(" "))?;
    }
    match bytes.len().saturating_sub(DUMPED_LINES * 16) {
        0 => Ok(()),
        more => writeln!(
            out,
            "{:>14}  {} more; --json has them all",
            "…",
            plural(more as u64, "byte")
        ),
    }
}

const SPECIFICATION: &str = "MV0305";
const PAGE: usize = 100;
/// Bytes of a field in its row.
const SHOWN: usize = 8;
const LONGEST_NAME: usize = 40;
const LONGEST_TEXT: usize = 120;
const DUMPED_LINES: usize = 16;
