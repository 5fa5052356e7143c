//! Type 25: time code (MV0305 2.7.6).

use std::fmt;

use super::{Body, Text, one_item_quirk, truncated};
use crate::{Error, Header, Quirk, Quirks};

const TEXT: usize = 12;
const PREFIX: usize = 4;

/// UTC time of day as text, `HH:MM:SS.mmm` (MV0305 2.7.6).
///
/// The specification has the twelve characters alone; current software puts their length in front.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | length of the text, 12 (left out by some senders) |
/// | 4 | 12 | `HH:MM:SS.mmm` |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeCode {
    text: [u8; TEXT],
    with_length: bool,
}

impl TimeCode {
    const DAY_MS: u32 = 24 * 60 * 60 * 1000;

    /// The time code of a moment, in milliseconds since midnight UTC; days are cut off.
    pub fn from_millis_of_day(millis: u32) -> Self {
        let millis = millis % Self::DAY_MS;
        let mut text = *b"00:00:00.000";
        write_digits(&mut text[0..2], millis / 3_600_000);
        write_digits(&mut text[3..5], millis / 60_000 % 60);
        write_digits(&mut text[6..8], millis / 1000 % 60);
        write_digits(&mut text[9..12], millis % 1000);
        Self::from_text(text)
    }

    /// A time code with these characters, whatever they say.
    pub const fn from_text(text: [u8; TEXT]) -> Self {
        Self {
            text,
            with_length: true,
        }
    }

    /// The same time code without the length in front of its text, as older software sends.
    #[must_use]
    pub const fn without_length(self) -> Self {
        Self {
            with_length: false,
            ..self
        }
    }

    /// Whether the length stands in front of the text.
    pub const fn has_length(&self) -> bool {
        self.with_length
    }

    /// The twelve characters as they came.
    pub fn text(&self) -> Text<'_> {
        Text::new(&self.text)
    }

    /// Milliseconds since midnight UTC; `None` when the text is not `HH:MM:SS.mmm`.
    pub fn millis_of_day(&self) -> Option<u32> {
        let t = &self.text;
        if (t[2], t[5], t[8]) != (b':', b':', b'.') {
            return None;
        }
        let hours = read_digits(&t[0..2], 23)?;
        let minutes = read_digits(&t[3..5], 59)?;
        let seconds = read_digits(&t[6..8], 59)?;
        let millis = read_digits(&t[9..12], 999)?;
        Some(((hours * 60 + minutes) * 60 + seconds) * 1000 + millis)
    }

    /// Bytes on the wire, 16 or 12.
    pub const fn size(&self) -> usize {
        if self.with_length { PREFIX + TEXT } else { TEXT }
    }

    pub(super) fn encode(&self, out: &mut Vec<u8>) {
        if self.with_length {
            out.extend_from_slice(&(TEXT as u32).to_be_bytes());
        }
        out.extend_from_slice(&self.text);
    }
}

impl fmt::Display for TimeCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.text().fmt(f)
    }
}

pub(super) fn decode<'a>(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Body<'a>, &'a [u8]), Error> {
    one_item_quirk(header, quirks);
    let prefixed = bytes.strip_prefix(&(TEXT as u32).to_be_bytes());
    let text = prefixed.unwrap_or(bytes);
    let Some((text, rest)) = text.split_first_chunk() else {
        let offset = Header::SIZE + bytes.len() - text.len();
        return Err(truncated(header, "time code", TEXT, text.len(), offset));
    };
    let time_code = TimeCode {
        text: *text,
        with_length: prefixed.is_some(),
    };
    quirks.insert_if(!time_code.with_length, Quirk::TimeCodeRaw);
    quirks.insert_if(time_code.millis_of_day().is_none(), Quirk::TimeCodeText);
    Ok((Body::TimeCode(time_code), rest))
}

fn read_digits(text: &[u8], limit: u32) -> Option<u32> {
    let value = text.iter().try_fold(0, |value, digit| {
        digit.is_ascii_digit().then(|| value * 10 + u32::from(digit - b'0'))
    })?;
    (value <= limit).then_some(value)
}

fn write_digits(text: &mut [u8], mut value: u32) {
    for digit in text.iter_mut().rev() {
        *digit = b'0' + (value % 10) as u8;
        value /= 10;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_milliseconds_agree() {
        for millis in [0, 1, 59_999, 3_600_000, 86_399_999, 45_296_789] {
            let code = TimeCode::from_millis_of_day(millis);
            assert_eq!(code.millis_of_day(), Some(millis), "{code}");
        }
        let code = TimeCode::from_millis_of_day(45_296_789);
        assert_eq!(code.to_string(), "12:34:56.789");
    }

    #[test]
    fn impossible_times_are_none() {
        for text in [b"24:00:00.000", b"12:60:00.000", b"12-00-00.000", b"1a:00:00.000"] {
            assert_eq!(TimeCode::from_text(*text).millis_of_day(), None);
        }
    }
}
