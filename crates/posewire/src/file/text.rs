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

/// A number with so many decimals, nothing for what is not finite; zero has no sign.
pub(super) fn push_number(text: &mut String, value: f64, decimals: usize) {
    let scale = POWERS.get(decimals).map_or(f64::INFINITY, |power| *power as f64);
    let scaled = (value * scale).round();
    if scaled.abs() < EXACT {
        push_fixed(text, scaled as i64, decimals);
    } else if value.is_finite() {
        let _ = write!(text, "{value:.decimals$}");
    }
}

/// A whole number of units of the last decimal. A CSV of 276 MB takes 1.9 s so, and 4.1 s with the formatting of floats of
/// the standard library.
fn push_fixed(text: &mut String, units: i64, decimals: usize) {
    if units < 0 {
        text.push('-');
    }
    let mut digits = [b'0'; DIGITS];
    let mut rest = units.unsigned_abs();
    let mut begin = DIGITS;
    while rest > 0 || DIGITS - begin <= decimals {
        begin -= 1;
        digits[begin] += (rest % 10) as u8;
        rest /= 10;
    }
    let point = DIGITS - decimals;
    text.extend(digits[begin..point].iter().map(|&digit| char::from(digit)));
    if decimals > 0 {
        text.push('.');
        text.extend(digits[point..].iter().map(|&digit| char::from(digit)));
    }
}

/// Powers of ten, up to the most decimals that are written as whole numbers.
const POWERS: [u64; 11] = [
    1,
    10,
    100,
    1_000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
    1_000_000_000,
    10_000_000_000,
];
/// Whole numbers below are exact in an `f64`.
const EXACT: f64 = 9_007_199_254_740_992.0;
/// More than a number below that has.
const DIGITS: usize = 20;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(value in -1e6..1e6_f64, decimals in 0..12_usize) {
            let mut text = String::new();
            push_number(&mut text, value, decimals);
            let expected = format!("{value:.decimals$}");
            prop_assert_eq!(text.split('.').nth(1).map_or(0, str::len), decimals);
            // Half a unit can be rounded either way.
            let distance = text.parse::<f64>().unwrap() - expected.parse::<f64>().unwrap();
            prop_assert!(distance.abs() < 1.5 * 0.1_f64.powi(decimals as i32), "{text} {expected}");
        }

        #[test]
        fn what_has_six_decimals_keeps_them(micro in -4_000_000_000_000_i64..4_000_000_000_000) {
            let mut text = String::new();
            push_number(&mut text, micro as f64 / 1e6, 6);
            prop_assert_eq!(text.replace('.', "").parse(), Ok(micro));
        }

        #[test]
        fn any_float_is_written(bits: u64, decimals in 0..12_usize) {
            let mut text = String::new();
            let value = f64::from_bits(bits);
            push_number(&mut text, value, decimals);
            prop_assert_eq!(text.is_empty(), !value.is_finite());
        }
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
