//! Steps through the bytes and notes a field at each step.

use std::borrow::Cow;

use super::{Field, Value};

/// Bytes being explained from front to back.
pub(super) struct Walk<'a> {
    bytes: &'a [u8],
    offset: usize,
    section: &'static str,
    fields: Vec<Field>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            offset: 0,
            section: "MV0305 2.4.1",
            fields: Vec::new(),
        }
    }

    /// Sets the section of the fields that follow.
    pub(super) fn enter(&mut self, section: &'static str) {
        self.section = section;
    }

    /// Bytes not yet explained.
    pub(super) fn left(&self) -> &'a [u8] {
        self.bytes.get(self.offset..).unwrap_or_default()
    }

    /// Notes a field of one byte.
    pub(super) fn byte(&mut self, name: impl Into<String>) -> Option<u8> {
        let [value] = self.take()?;
        self.field(name, 1, Value::Unsigned(value.into()));
        Some(value)
    }

    /// Notes a 2-byte number.
    pub(super) fn short(&mut self, name: impl Into<String>) -> Option<u16> {
        let value = u16::from_be_bytes(self.take()?);
        self.field(name, 2, Value::Unsigned(value.into()));
        Some(value)
    }

    /// Notes a 4-byte number.
    pub(super) fn long(&mut self, name: impl Into<String>) -> Option<u32> {
        let value = u32::from_be_bytes(self.take()?);
        self.field(name, 4, Value::Unsigned(value));
        Some(value)
    }

    /// Notes the length of a string.
    pub(super) fn string_length(&mut self, name: impl Into<String>) -> Option<i32> {
        let value = i32::from_be_bytes(self.take()?);
        self.field(name, 4, Value::Signed(value));
        Some(value)
    }

    /// Notes a number with a fraction.
    pub(super) fn float(&mut self, name: impl Into<String>) -> Option<f32> {
        let value = f32::from_be_bytes(self.take()?);
        self.field(name, 4, Value::Float(value));
        if !value.is_finite() {
            self.note("not a finite number");
        }
        Some(value)
    }

    /// Notes a string of so many bytes.
    pub(super) fn text(&mut self, name: impl Into<String>, length: usize) -> Option<()> {
        let bytes = self.left().get(..length)?;
        let value = Value::Text(String::from_utf8_lossy(bytes).into_owned());
        self.field(name, length, value);
        if std::str::from_utf8(bytes).is_err() {
            self.note("not UTF-8");
        }
        Some(())
    }

    /// Notes the rest as bytes.
    pub(super) fn rest(&mut self, name: impl Into<String>) {
        let bytes = self.left().to_vec();
        self.field(name, bytes.len(), Value::Bytes(bytes));
    }

    /// Notes a number of bytes as they are.
    pub(super) fn raw(&mut self, name: impl Into<String>, length: usize) -> Option<()> {
        let bytes = self.left().get(..length)?.to_vec();
        self.field(name, length, Value::Bytes(bytes));
        Some(())
    }

    /// Gives the last field a unit.
    pub(super) fn unit(&mut self, unit: &'static str) {
        if let Some(field) = self.fields.last_mut() {
            field.unit = Some(unit).filter(|unit| !unit.is_empty());
        }
    }

    /// Gives the last field a note, after the one it has.
    pub(super) fn note(&mut self, note: impl Into<Cow<'static, str>>) {
        if let Some(field) = self.fields.last_mut() {
            let note = note.into();
            field.note = Some(match field.note.take() {
                Some(before) => format!("{before}; {note}").into(),
                None => note,
            });
        }
    }

    /// All fields; bytes left over make one more.
    pub(super) fn into_fields(mut self, decoded: bool) -> Vec<Field> {
        if !self.left().is_empty() {
            self.enter("");
            self.rest(if decoded { "trailing" } else { "unread" });
        }
        self.fields
    }

    fn take<const N: usize>(&self) -> Option<[u8; N]> {
        self.left().first_chunk().copied()
    }

    fn field(&mut self, name: impl Into<String>, length: usize, value: Value) {
        self.fields.push(Field {
            offset: self.offset,
            length,
            name: name.into(),
            section: self.section,
            value,
            unit: None,
            note: None,
        });
        self.offset += length;
    }
}
