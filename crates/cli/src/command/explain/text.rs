//! Explanations for people: a summary, a table of the fields, what is unusual.

use super::Tally;
use super::capture::Place;
use super::natnet::Bitstream;
use super::part::{self, Explained, Field, Header, Value};
use crate::plain::{cut, grouped, plural, printable};
use posewire::Datagram;
use std::fmt::{Display, LowerExp};
use std::io::{self, Write};

pub(super) fn write_datagram(explained: &Explained<'_>, out: &mut impl Write) -> io::Result<()> {
    if explained.offset > 0 {
        writeln!(out)?;
    }
    writeln!(out, "{}", cut(&printable(&explained.title), LONGEST_TITLE))?;
    writeln!(out, "{}", circumstances(explained))?;
    if let Some(reason) = explained.bitstream.and_then(Bitstream::reason) {
        writeln!(out, "{reason}")?;
    }
    writeln!(out)?;
    write_table(explained, out)?;
    for (place, quirk) in explained.quirks.iter().enumerate() {
        let title = if place == 0 { "\nquirks\n" } else { "" };
        writeln!(out, "{title}  {:<22} {}", quirk.name, quirk.meaning)?;
    }
    match &explained.error {
        Some(error) => writeln!(out, "\nmalformed\n  {}", printable(error)),
        None => Ok(()),
    }
}

/// A datagram of a capture: when it came and between whom, then what it says, or only a line of that.
pub(super) fn write_captured(
    explained: &Explained<'_>,
    place: &Place<'_>,
    summary: bool,
    out: &mut impl Write,
) -> io::Result<()> {
    let Place { datagram, seconds } = place;
    let Datagram { from, to, wire, .. } = datagram;
    if summary {
        let title = cut(&printable(&explained.title), LONGEST_TITLE);
        return writeln!(out, "{seconds:>12.6}  {from} > {to}  {title}");
    }
    let received = datagram.received.nanoseconds();
    let (whole, rest) = (received.div_euclid(1_000_000_000), received.rem_euclid(1_000_000_000));
    writeln!(out, "+{seconds:.6} s, at {whole}.{rest:09}, {from} > {to}, {wire}")?;
    write_datagram(explained, out)?;
    writeln!(out)
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

fn circumstances(explained: &Explained<'_>) -> String {
    let size = plural(explained.bytes.len() as u64, "byte");
    let place = format!("{size} at byte {}", grouped(explained.offset as u64));
    match (&explained.header, explained.bitstream) {
        (Some(Header::Mxtp(header)), _) => {
            let name = match header.message_type.name() {
                "unknown" => "unknown type",
                name => name,
            };
            format!("{name}, Rev {:?}, {place}", header.revision())
        }
        (Some(Header::NatNet { message, .. }), Some(Bitstream { version, .. })) => {
            format!("{message}, bitstream {version}, {place}")
        }
        (Some(Header::NatNet { message, .. }), None) => format!("{message}, {place}"),
        (None, _) => place,
    }
}

fn write_table(explained: &Explained<'_>, out: &mut impl Write) -> io::Result<()> {
    let table = Table::of(&explained.fields, explained.document);
    table.write_head(out)?;
    for field in &explained.fields {
        let bytes = explained.bytes.get(field.offset..field.offset + field.length);
        table.write_field(field, bytes.unwrap_or_default(), out)?;
    }
    Ok(())
}

/// How wide the columns are.
struct Table {
    document: Option<&'static str>,
    bytes: usize,
    /// The column of a document that numbers its sections.
    section: usize,
    name: usize,
    /// Characters before the decimal point.
    whole: usize,
    value: usize,
    unit: usize,
}

impl Table {
    fn of(fields: &[Field], document: Option<&'static str>) -> Self {
        let widest = |width: &dyn Fn(&Field) -> usize| fields.iter().map(width).max().unwrap_or(0);
        let whole = widest(&|field| match field.value {
            Value::Float(_) | Value::Double(_) => whole_digits(&value(&field.value)),
            _ => 1,
        });
        let number = |field: &Field| match field.value {
            Value::Text(_) | Value::Bytes(_) => 0,
            _ => aligned(&field.value, whole).len(),
        };
        Self {
            document,
            bytes: widest(&|field| (field.length * 2).min(SHOWN * 2 + 1)).max("bytes".len()),
            section: document.map_or(0, |document| {
                widest(&|field| section(field, document).len()).max(document.len())
            }),
            name: widest(&|field| field.name.chars().count()).clamp("field".len(), LONGEST_NAME),
            whole,
            value: widest(&number).max("value".len()),
            unit: widest(&|field| field.unit.map_or(0, str::len)),
        }
    }

    fn write_head(&self, out: &mut impl Write) -> io::Result<()> {
        let line = self.left("offset", "bytes", self.document.unwrap_or_default(), "field") + "value";
        writeln!(out, "{line}")
    }

    fn write_field(&self, field: &Field, bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
        let name = cut(&printable(&field.name), LONGEST_NAME);
        let section = self.document.map_or("", |document| section(field, document));
        let left = self.left(&field.offset.to_string(), &hexadecimal(bytes), section, &name);
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
        match self.document {
            Some(_) => format!("{offset:>6}  {bytes:<b$}  {section:<s$}  {name:<n$}  "),
            None => format!("{offset:>6}  {bytes:<b$}  {name:<n$}  "),
        }
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
fn section<'a>(field: &'a Field, document: &str) -> &'a str {
    let section = field.section;
    section.strip_prefix(document).unwrap_or(section).trim_start()
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
        Value::Unsigned(number) => number.to_string(),
        Value::Signed(number) => number.to_string(),
        Value::Float(number) => float(number, f64::from(*number)),
        Value::Double(number) => float(number, *number),
        Value::Text(text) => cut(&format!("{:?}", cut(text, LONGEST_TEXT)), LONGEST_TEXT * 2),
        Value::Bytes(bytes) if bytes.len() > SHOWN => plural(bytes.len() as u64, "byte"),
        Value::Bytes(bytes) => part::hexadecimal(bytes),
    }
}

/// Shortest digits that give the same bits again; as a power of ten where that is shorter.
fn float(number: &(impl Display + LowerExp), size: f64) -> String {
    if size != 0.0 && !(1e-4..1e7).contains(&size.abs()) {
        format!("{number:e}")
    } else {
        number.to_string()
    }
}

/// The first bytes of a field.
fn hexadecimal(bytes: &[u8]) -> String {
    let shown = part::hexadecimal(&bytes[..bytes.len().min(SHOWN)]);
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

const PAGE: usize = 100;
/// Bytes of a field in its row.
const SHOWN: usize = 8;
const LONGEST_TITLE: usize = 200;
const LONGEST_NAME: usize = 40;
const LONGEST_TEXT: usize = 120;
const DUMPED_LINES: usize = 16;
