//! Type 12: meta data (MV0305 2.6.1).

use super::{Body, Text, one_item_quirk, truncated};
use crate::{Error, Header, Quirk, Quirks};

const PREFIX: usize = 4;

/// Meta data of a character: lines of text, each `tag:value` and a line feed (MV0305 2.6.1).
///
/// Tags may come in any order and any may be missing; unknown ones are kept.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 4 | length of the text (left out by some senders) |
/// | 4 | n | text, UTF-8 |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meta<'a> {
    text: Text<'a>,
    with_length: bool,
}

/// One line of meta data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tag<'a> {
    /// What stands before the first colon.
    pub name: Text<'a>,
    /// What stands after it; empty on a line without a colon.
    pub value: Text<'a>,
}

impl<'a> Meta<'a> {
    /// Meta data with this text; [`push_tag`] writes such text line by line.
    pub const fn new(text: &'a str) -> Self {
        Self {
            text: Text::new(text.as_bytes()),
            with_length: true,
        }
    }

    /// The same meta data without the length in front of its text.
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

    /// The whole text.
    pub const fn text(&self) -> Text<'a> {
        self.text
    }

    /// The tags in the order they came; empty lines are left out.
    pub fn tags(&self) -> impl Iterator<Item = Tag<'a>> + use<'a> {
        self.text
            .as_bytes()
            .split(|byte| *byte == b'\n')
            .map(|line| line.strip_suffix(b"\r").unwrap_or(line))
            .filter(|line| !line.is_empty())
            .map(Tag::from_line)
    }

    /// The value of the first tag with this name.
    pub fn value(&self, name: &str) -> Option<Text<'a>> {
        self.tags().find(|tag| tag.name == name).map(|tag| tag.value)
    }

    /// `name`: the name of the character.
    pub fn name(&self) -> Option<Text<'a>> {
        self.value("name")
    }

    /// `xmid`: the ID of the receiving station or body pack.
    pub fn xmid(&self) -> Option<Text<'a>> {
        self.value("xmid")
    }

    /// `color`: the colour of the character, red, green, blue.
    pub fn color(&self) -> Option<[u8; 3]> {
        let digits = self.value("color")?.as_bytes();
        let hexadecimal = digits.len() == 6 && digits.iter().all(u8::is_ascii_hexdigit);
        let text = std::str::from_utf8(digits).ok().filter(|_| hexadecimal)?;
        let [_, rgb @ ..] = u32::from_str_radix(text, 16).ok()?.to_be_bytes();
        Some(rgb)
    }

    /// `count`: the number of characters in the stream.
    pub fn count(&self) -> Option<u32> {
        self.number("count")
    }

    /// `timeOffset`: UTC minus local time, in milliseconds.
    pub fn time_offset_ms(&self) -> Option<i64> {
        self.number("timeOffset")
    }

    /// Bytes on the wire.
    pub const fn size(&self) -> usize {
        let prefix = if self.with_length { PREFIX } else { 0 };
        prefix + self.text.as_bytes().len()
    }

    pub(super) fn encode(&self, out: &mut Vec<u8>) {
        let text = self.text.as_bytes();
        if self.with_length {
            out.extend_from_slice(&(text.len() as u32).to_be_bytes());
        }
        out.extend_from_slice(text);
    }

    fn number<T: std::str::FromStr>(&self, name: &str) -> Option<T> {
        let digits = self.value(name)?.as_bytes();
        std::str::from_utf8(digits).ok()?.trim().parse().ok()
    }
}

impl<'a> Tag<'a> {
    fn from_line(line: &'a [u8]) -> Self {
        let colon = line.iter().position(|byte| *byte == b':');
        let (name, value) = match colon {
            Some(at) => (&line[..at], &line[at + 1..]),
            None => (line, &line[line.len()..]),
        };
        Self {
            name: Text::new(name),
            value: Text::new(value),
        }
    }
}

/// Appends the line `name:value` to the text of meta data. Line breaks in the value become spaces,
/// so that a value can never add a tag.
///
/// Some clients lose the first line: send `color` first, and always `color`, `count`, `name` and
/// `timeOffset`.
pub fn push_tag(text: &mut String, name: &str, value: &str) {
    text.push_str(name);
    text.push(':');
    text.extend(value.chars().map(|c| match c {
        '\n' | '\r' => ' ',
        other => other,
    }));
    text.push('\n');
}

pub(super) fn decode<'a>(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Body<'a>, &'a [u8]), Error> {
    one_item_quirk(header, quirks);
    let (meta, rest) = split(header, bytes)?;
    quirks.insert_if(!meta.with_length, Quirk::MetaWithoutLength);
    quirks.insert_if(!meta.text.is_utf8(), Quirk::TextNotUtf8);
    let mut lines = meta.text.as_bytes().split(|byte| *byte == b'\n');
    let odd_line = lines.any(|line| !line.is_empty() && !line.contains(&b':'));
    quirks.insert_if(odd_line, Quirk::MetaLine);
    Ok((Body::Meta(meta), rest))
}

/// Tells a length from the beginning of a text: no text begins with two zero bytes, and no length
/// that fits a datagram begins otherwise.
fn split<'a>(header: &Header, bytes: &'a [u8]) -> Result<(Meta<'a>, &'a [u8]), Error> {
    let Some((&[0, 0, high, low], text)) = bytes.split_first_chunk() else {
        let meta = Meta {
            text: Text::new(bytes),
            with_length: false,
        };
        return Ok((meta, &[]));
    };
    let length = usize::from(u16::from_be_bytes([high, low]));
    let Some((text, rest)) = text.split_at_checked(length) else {
        let offset = Header::SIZE + PREFIX;
        return Err(truncated(header, "meta data", length, text.len(), offset));
    };
    let meta = Meta {
        text: Text::new(text),
        with_length: true,
    };
    Ok((meta, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_tags_are_read() {
        let meta = Meta::new("color:e96417\ncount:1\nname:Ann\ntimeOffset:-3600000\nx:y:z\n");
        assert_eq!(meta.color(), Some([0xE9, 0x64, 0x17]));
        assert_eq!(meta.count(), Some(1));
        assert_eq!(meta.name().unwrap(), "Ann");
        assert_eq!(meta.time_offset_ms(), Some(-3_600_000));
        assert_eq!(meta.value("x").unwrap(), "y:z");
        assert_eq!(meta.xmid(), None);
        assert_eq!(meta.tags().count(), 5);
    }

    #[test]
    fn a_value_cannot_add_a_tag() {
        let mut text = String::new();
        push_tag(&mut text, "name", "Ann\ncolor:000000");
        assert_eq!(text, "name:Ann color:000000\n");
    }

    #[test]
    fn colours_that_are_no_colours_are_none() {
        for text in ["color:+12345\n", "color:12345\n", "color:gggggg\n", "name:\n"] {
            assert_eq!(Meta::new(text).color(), None);
        }
    }
}
