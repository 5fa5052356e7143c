//! Text in UTF-16, which some editors and tools make of XML.

use std::io::{self, BufRead, Read};

/// Which byte of a unit comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Big,
    Little,
}

impl Order {
    /// What the first two bytes of XML in UTF-16 tell, and whether they are a mark, which is no text; `None` when they begin
    /// no such text.
    pub(crate) fn of(beginning: &[u8]) -> Option<(Self, bool)> {
        match beginning {
            [0xfe, 0xff, ..] => Some((Self::Big, true)),
            [0xff, 0xfe, ..] => Some((Self::Little, true)),
            [0, b'<', ..] => Some((Self::Big, false)),
            [b'<', 0, ..] => Some((Self::Little, false)),
            _ => None,
        }
    }

    fn unit(self, pair: &[u8]) -> u16 {
        let bytes = [pair[0], pair[1]];
        match self {
            Self::Big => u16::from_be_bytes(bytes),
            Self::Little => u16::from_le_bytes(bytes),
        }
    }
}

/// Text in UTF-16 as UTF-8. What is no character is U+FFFD.
#[derive(Debug)]
pub(crate) struct Utf16<R> {
    source: R,
    order: Order,
    /// Bytes of UTF-8 that were decoded, and how many of them were given.
    ready: Vec<u8>,
    given: usize,
    /// A unit of which only one byte was read, or the first half of a character.
    rest: Vec<u8>,
}

impl<R: Read> Utf16<R> {
    /// Of what follows the mark.
    pub(crate) fn new(source: R, order: Order) -> Self {
        Self {
            source,
            order,
            ready: Vec::new(),
            given: 0,
            rest: Vec::new(),
        }
    }

    /// Makes more bytes of UTF-16 what is ready. None are the end.
    fn decode(&mut self, bytes: &[u8]) {
        (self.given, self.rest) = (0, [&self.rest, bytes].concat());
        self.ready.clear();
        let mut units: Vec<_> = self.rest.chunks_exact(2).map(|pair| self.order.unit(pair)).collect();
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

impl<R: Read> BufRead for Utf16<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.given == self.ready.len() {
            let mut bytes = [0; 8192];
            let count = self.source.read(&mut bytes)?;
            self.decode(&bytes[..count]);
            if count == 0 {
                break;
            }
        }
        Ok(&self.ready[self.given..])
    }

    fn consume(&mut self, count: usize) {
        self.given = self.ready.len().min(self.given + count);
    }
}

impl<R: Read> Read for Utf16<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(to)?;
        self.consume(read);
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::io::BufReader;

    fn decoded(bytes: &[u8], order: Order) -> Vec<u8> {
        let mut out = Vec::new();
        // One byte at a time: units and characters may be cut anywhere.
        let source = BufReader::with_capacity(1, bytes);
        Utf16::new(source, order).read_to_end(&mut out).unwrap();
        out
    }

    #[test]
    fn the_order_is_told_by_the_mark_or_the_first_bracket() {
        assert_eq!(Order::of(b"\xfe\xff\0<"), Some((Order::Big, true)));
        assert_eq!(Order::of(b"\xff\xfe<\0"), Some((Order::Little, true)));
        assert_eq!(Order::of(b"\0<\0a"), Some((Order::Big, false)));
        assert_eq!(Order::of(b"<\0a\0"), Some((Order::Little, false)));
        for other in [&b""[..], b"<", b"<a", b"\xef\xbb\xbf<", b"\x1f\x8b"] {
            assert_eq!(Order::of(other), None);
        }
    }

    #[test]
    fn half_a_character_at_the_end_is_told() {
        assert_eq!(decoded(b"a\0\x3d\xd8", Order::Little), "a\u{fffd}".as_bytes());
        assert_eq!(decoded(b"a\0b", Order::Little), b"a");
    }

    proptest! {
        #[test]
        fn any_text_comes_out_as_utf8(text in ".{0,6000}") {
            let big: Vec<_> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
            let little: Vec<_> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            prop_assert_eq!(decoded(&big, Order::Big), text.as_bytes());
            prop_assert_eq!(decoded(&little, Order::Little), text.as_bytes());
        }

        #[test]
        fn any_bytes_become_text(bytes: Vec<u8>) {
            prop_assert!(String::from_utf8(decoded(&bytes, Order::Little)).is_ok());
        }
    }
}
