//! Lines of numbers.

use std::fmt::Write as _;
use std::io::{self, Write};

/// A line of fields, made again for each line in the same memory.
#[derive(Debug)]
pub(super) struct Line {
    text: String,
    separator: char,
    /// Whether the next field is the first.
    empty: bool,
}

impl Line {
    pub(super) fn new(separator: char) -> Self {
        Self {
            text: String::new(),
            separator,
            empty: true,
        }
    }

    /// Adds a field as it is.
    pub(super) fn field(&mut self, text: &str) {
        self.separate();
        self.text.push_str(text);
    }

    /// Adds a whole number.
    pub(super) fn whole(&mut self, number: impl Into<u64>) {
        self.separate();
        // To write to a string cannot fail.
        let _ = write!(self.text, "{}", number.into());
    }

    /// Adds a number with so many decimals, an empty field for what is not finite.
    pub(super) fn number(&mut self, value: f64, decimals: usize) {
        self.separate();
        push_number(&mut self.text, value, decimals);
    }

    /// Adds one field of numbers with commas between them.
    pub(super) fn list(&mut self, values: &[f64], decimals: usize) {
        self.separate();
        for (place, value) in values.iter().enumerate() {
            if place > 0 {
                self.text.push(',');
            }
            push_number(&mut self.text, *value, decimals);
        }
    }

    /// Writes the line with this at its end and begins anew.
    pub(super) fn end(&mut self, out: &mut impl Write, end: &str) -> io::Result<()> {
        self.text.push_str(end);
        let written = out.write_all(self.text.as_bytes());
        self.text.clear();
        self.empty = true;
        written
    }

    /// The line so far.
    pub(super) fn into_text(self) -> String {
        self.text
    }

    fn separate(&mut self) {
        if !self.empty {
            self.text.push(self.separator);
        }
        self.empty = false;
    }
}

/// A number with so many decimals; zero has no sign.
pub(super) fn push_number(text: &mut String, value: f64, decimals: usize) {
    if !value.is_finite() {
        return;
    }
    let before = text.len();
    let _ = write!(text, "{value:.decimals$}");
    let is_zero = text[before..].bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    if is_zero && text[before..].starts_with('-') {
        text.remove(before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_separates_its_fields_and_begins_anew() {
        let mut line = Line::new('\t');
        let mut out = Vec::new();
        line.field("a");
        line.number(f64::NAN, 3);
        line.number(1.23456, 3);
        line.list(&[0.5, -1.0], 1);
        line.end(&mut out, "\n").unwrap();
        line.whole(7_u32);
        line.end(&mut out, "\n").unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "a\t\t1.235\t0.5,-1.0\n7\n");
    }

    #[test]
    fn zero_has_no_sign() {
        let mut text = String::new();
        for value in [-0.0, -0.000_000_4, -0.000_000_6, -12.0] {
            push_number(&mut text, value, 6);
            text.push(' ');
        }
        assert_eq!(text, "0.000000 0.000000 -0.000001 -12.000000 ");
    }
}
