//! Steps through the bytes and notes a field at each step.

use std::borrow::Cow;

use super::{Field, Value};

/// Bytes being explained from front to back.
pub(super) struct Walk<'a> {
    bytes: &'a [u8],
    offset: usize,
    end: usize,
    section: &'static str,
    fields: Vec<Field>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            offset: 0,
            end: bytes.len(),
            section: "header",
            fields: Vec::new(),
        }
    }

    /// Sets the section of the fields that follow.
    pub(super) fn enter(&mut self, section: &'static str) {
        self.section = section;
    }

    /// Bytes not yet explained, up to the end of the part.
    pub(super) fn left(&self) -> &'a [u8] {
        self.bytes.get(self.offset..self.end).unwrap_or_default()
    }

    /// Explains a part of so many bytes; what `explain` leaves of it is one field.
    pub(super) fn within(&mut self, length: usize, explain: impl FnOnce(&mut Self) -> Option<()>) -> Option<()> {
        if length > self.left().len() {
            return None;
        }
        let end = std::mem::replace(&mut self.end, self.offset + length);
        let complete = explain(self);
        if complete.is_some() && !self.left().is_empty() {
            self.rest("leftover");
        }
        self.end = end;
        complete
    }

    pub(super) fn u8(&mut self, name: impl Into<String>) -> Option<u8> {
        let [value] = self.take()?;
        self.field(name, 1, Value::Unsigned(value.into()));
        Some(value)
    }

    pub(super) fn u16(&mut self, name: impl Into<String>) -> Option<u16> {
        let value = u16::from_le_bytes(self.take()?);
        self.field(name, 2, Value::Unsigned(value.into()));
        Some(value)
    }

    pub(super) fn i16(&mut self, name: impl Into<String>) -> Option<i16> {
        let value = i16::from_le_bytes(self.take()?);
        self.field(name, 2, Value::Signed(value.into()));
        Some(value)
    }

    pub(super) fn i32(&mut self, name: impl Into<String>) -> Option<i32> {
        let value = i32::from_le_bytes(self.take()?);
        self.field(name, 4, Value::Signed(value));
        Some(value)
    }

    pub(super) fn u32(&mut self, name: impl Into<String>) -> Option<u32> {
        let value = u32::from_le_bytes(self.take()?);
        self.field(name, 4, Value::Unsigned(value.into()));
        Some(value)
    }

    pub(super) fn u64(&mut self, name: impl Into<String>, unit: &'static str) -> Option<u64> {
        let value = u64::from_le_bytes(self.take()?);
        self.field(name, 8, Value::Unsigned(value));
        self.unit(unit);
        Some(value)
    }

    pub(super) fn f32(&mut self, name: impl Into<String>, unit: &'static str) -> Option<f32> {
        let value = f32::from_le_bytes(self.take()?);
        self.field(name, 4, Value::Float(value));
        self.unit(unit);
        if !value.is_finite() {
            self.note("not a finite number");
        }
        Some(value)
    }

    pub(super) fn f64(&mut self, name: impl Into<String>, unit: &'static str) -> Option<f64> {
        let value = f64::from_le_bytes(self.take()?);
        self.field(name, 8, Value::Double(value));
        self.unit(unit);
        Some(value)
    }

    /// Notes three numbers in metres.
    pub(super) fn position(&mut self, name: &str) -> Option<()> {
        ["x", "y", "z"]
            .into_iter()
            .try_for_each(|axis| self.f32(format!("{name}.{axis}"), "m").map(drop))
    }

    /// Notes the four numbers of a quaternion.
    pub(super) fn orientation(&mut self, name: &str) -> Option<()> {
        ["x", "y", "z", "w"]
            .into_iter()
            .try_for_each(|axis| self.f32(format!("{name}.{axis}"), "").map(drop))
    }

    /// Notes a string and its terminating zero.
    pub(super) fn name(&mut self, name: impl Into<String>) -> Option<()> {
        let length = self.left().iter().position(|byte| *byte == 0)? + 1;
        self.text(name, length)
    }

    /// Notes so many bytes that hold a string up to a zero, or to their end.
    pub(super) fn text(&mut self, name: impl Into<String>, length: usize) -> Option<()> {
        let bytes = crate::name::before_zero(self.left().get(..length)?);
        let text = String::from_utf8_lossy(bytes).into_owned();
        self.field(name, length, Value::Text(text));
        if std::str::from_utf8(bytes).is_err() {
            self.note("not UTF-8");
        }
        Some(())
    }

    /// Notes a count and each of the items; `item` has the name of its own.
    pub(super) fn list(&mut self, name: &str, mut item: impl FnMut(&mut Self, &str) -> Option<()>) -> Option<()> {
        let count = self.i32(format!("{name}.count"))?;
        (0..count).try_for_each(|n| item(self, &format!("{name}[{n}]")))
    }

    /// Notes the rest as bytes.
    pub(super) fn rest(&mut self, name: impl Into<String>) {
        let bytes = self.left().to_vec();
        self.field(name, bytes.len(), Value::Bytes(bytes));
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

    /// Gives the last field the names of the bits that are set.
    pub(super) fn bits(&mut self, value: i16, names: &[&str]) {
        let set = names.iter().enumerate().filter(|(bit, _)| value & (1 << bit) != 0);
        let set: Vec<_> = set.map(|(_, name)| *name).collect();
        if !set.is_empty() {
            self.note(set.join(", "));
        }
    }

    /// All fields; bytes left over make one more.
    pub(super) fn into_fields(mut self, decoded: bool) -> Vec<Field> {
        self.end = self.bytes.len();
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
