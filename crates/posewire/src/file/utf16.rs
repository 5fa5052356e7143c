//! Text in UTF-16, which some editors and tools make of XML.

use std::io::{self, Read};

/// Bytes of a file, those of UTF-16 text as UTF-8. Which it is the first bytes tell.
#[derive(Debug)]
pub(super) struct Decoded<R> {
    source: R,
    /// Whether the high byte of a unit comes first; `None` when the text is not UTF-16.
    big_endian: Option<bool>,
    /// Bytes that were read and not given yet.
    ready: Vec<u8>,
    /// How many of them were given.
    given: usize,
    /// A unit of which only one byte was read, or the first half of a character.
    rest: Vec<u8>,
}

impl<R: Read> Decoded<R> {
    pub(super) fn new(mut source: R) -> io::Result<Self> {
        let mut beginning = Vec::with_capacity(2);
        source.by_ref().take(2).read_to_end(&mut beginning)?;
        let (big_endian, is_mark) = match *beginning {
            [0xfe, 0xff] => (Some(true), true),
            [0xff, 0xfe] => (Some(false), true),
            [0, b'<'] => (Some(true), false),
            [b'<', 0] => (Some(false), false),
            _ => (None, false),
        };
        let mut decoded = Self {
            source,
            big_endian,
            ready: Vec::new(),
            given: 0,
            rest: Vec::new(),
        };
        match big_endian {
            Some(big_endian) if !is_mark => decoded.decode(&beginning, big_endian),
            None => decoded.ready = beginning,
            Some(_) => {}
        }
        Ok(decoded)
    }

    /// Adds more bytes of UTF-16 to what is ready.
    fn decode(&mut self, bytes: &[u8], big_endian: bool) {
        self.rest.extend_from_slice(bytes);
        let unit = |pair: &[u8]| {
            let bytes = [pair[0], pair[1]];
            if big_endian {
                u16::from_be_bytes(bytes)
            } else {
                u16::from_le_bytes(bytes)
            }
        };
        let mut units: Vec<_> = self.rest.chunks_exact(2).map(unit).collect();
        // The second half of the last character may be still to come.
        if units.last().is_some_and(|unit| (0xd800..0xdc00).contains(unit)) && !bytes.is_empty() {
            units.pop();
        }
        self.rest.drain(..2 * units.len());
        let mut utf8 = [0; 4];
        for character in char::decode_utf16(units) {
            let character = character.unwrap_or(char::REPLACEMENT_CHARACTER);
            self.ready
                .extend_from_slice(character.encode_utf8(&mut utf8).as_bytes());
        }
    }
}

impl<R: Read> Read for Decoded<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        while self.given == self.ready.len() {
            let Some(big_endian) = self.big_endian else {
                return self.source.read(to);
            };
            self.ready.clear();
            self.given = 0;
            let mut bytes = [0; 8192];
            let count = self.source.read(&mut bytes)?;
            self.decode(&bytes[..count], big_endian);
            if count == 0 {
                break;
            }
        }
        let left = &self.ready[self.given..];
        let count = left.len().min(to.len());
        to[..count].copy_from_slice(&left[..count]);
        self.given += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn decoded(bytes: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        Decoded::new(bytes).unwrap().read_to_end(&mut out).unwrap();
        out
    }

    #[test]
    fn text_without_a_mark_is_told_by_its_first_bracket() {
        assert_eq!(decoded(b"\0<\0a\0>"), b"<a>");
        assert_eq!(decoded(b"<\0a\0>\0"), b"<a>");
        assert_eq!(decoded(b"<a>"), b"<a>");
        assert_eq!(decoded(b""), b"");
        assert_eq!(decoded(b"<"), b"<");
    }

    proptest! {
        #[test]
        fn any_text_comes_out_as_utf8(text in ".{0,6000}") {
            let units: Vec<_> = std::iter::once(0xfeff).chain(text.encode_utf16()).collect();
            let big: Vec<_> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
            let little: Vec<_> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
            prop_assert_eq!(decoded(&big), text.as_bytes());
            prop_assert_eq!(decoded(&little), text.as_bytes());
        }

        #[test]
        fn any_bytes_are_read_to_their_end(bytes: Vec<u8>) {
            let is_utf16 = matches!(*bytes, [0xfe, 0xff, ..] | [0xff, 0xfe, ..] | [0, b'<', ..] | [b'<', 0, ..]);
            prop_assert!(is_utf16 || decoded(&bytes) == bytes);
            let _ = decoded(&[&[0xff, 0xfe], &bytes[..]].concat());
        }
    }
}
