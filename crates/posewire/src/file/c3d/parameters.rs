//! The parameter section of a C3D file: named values in groups (C3D User Guide, "The Parameter Section").

use super::super::names::shortened;
use std::io;

/// A parameter section that is being written: groups and, after each, its parameters.
///
/// | bytes | a parameter's record |
/// |---|---|
/// | 1 | length of its name |
/// | 1 | id of its group |
/// | n | its name |
/// | 2 | how far the next record is from here |
/// | 1 | type: -1 text, 2 `i16`, 4 `f32` |
/// | 1 + d | how many dimensions, and each, the fastest first |
/// | | the values, little-endian |
/// | 1 | length of its description, which is left empty |
///
/// A group's record has its id negated, and nothing behind the distance but the description.
pub(super) struct Parameters {
    bytes: Vec<u8>,
    group: u8,
    /// Where the value of `POINT:DATA_START` goes.
    data_start: Option<usize>,
}

/// What the values of a parameter are.
#[derive(Clone, Copy)]
enum Kind {
    Text = -1,
    Word = 2,
    Float = 4,
}

impl Parameters {
    /// A section without groups.
    pub(super) fn new() -> Self {
        Self {
            bytes: vec![1, KEY, 0, LITTLE_ENDIAN],
            group: 0,
            data_start: None,
        }
    }

    /// Begins a group, to which the parameters that follow belong.
    pub(super) fn group(&mut self, name: &str) {
        self.group += 1;
        self.bytes.push(name.len() as u8);
        self.bytes.push((-(self.group as i8)) as u8);
        self.bytes.extend_from_slice(name.as_bytes());
        self.bytes.extend_from_slice(&[3, 0, 0]);
    }

    /// A number of 16 bits. One above 32,767 is the same bits without a sign, as all readers take it.
    pub(super) fn word(&mut self, name: &str, value: u16) {
        self.record(name, Kind::Word, &[], &value.to_le_bytes());
    }

    /// A list of numbers of 16 bits.
    pub(super) fn words(&mut self, name: &str, values: &[u16]) {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.record(name, Kind::Word, &[count(values.len())], &bytes);
    }

    /// Where the data begins, which [`finish`](Self::finish) fills in.
    pub(super) fn data_start(&mut self) {
        self.word("DATA_START", 0);
        self.data_start = Some(self.bytes.len() - 3);
    }

    /// A number.
    pub(super) fn float(&mut self, name: &str, value: f32) {
        self.record(name, Kind::Float, &[], &value.to_le_bytes());
    }

    /// An array of numbers, the first dimension of which is the fastest.
    pub(super) fn floats(&mut self, name: &str, dimensions: &[usize], values: &[f32]) {
        let dimensions: Vec<u8> = dimensions.iter().map(|&length| count(length)).collect();
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.record(name, Kind::Float, &dimensions, &bytes);
    }

    /// A text, of which the first 255 bytes are kept.
    pub(super) fn text(&mut self, name: &str, text: &str) {
        let text = shortened(text, MOST);
        self.record(name, Kind::Text, &[count(text.len())], text.as_bytes());
    }

    /// A list of texts of one length, the shorter ones with spaces behind. After 255 of them it goes on in a parameter with
    /// 2 behind its name, then 3.
    pub(super) fn texts<T: AsRef<str>>(&mut self, name: &str, texts: &[T]) {
        if texts.is_empty() {
            self.record(name, Kind::Text, &[0, 0], &[]);
        }
        for (number, part) in (1..).zip(texts.chunks(MOST)) {
            let suffix = if number == 1 {
                String::new()
            } else {
                format!("{number}")
            };
            self.table(&format!("{name}{suffix}"), part);
        }
    }

    /// The section's bytes, whole blocks, and the number of the block that follows it.
    ///
    /// # Errors
    /// When the parameters need more than the 255 blocks that a section can have.
    pub(super) fn finish(mut self) -> io::Result<(Vec<u8>, u16)> {
        self.bytes.extend_from_slice(&[0, 0]);
        let blocks = self.bytes.len().div_ceil(BLOCK);
        let too_many = || {
            let found = self.bytes.len();
            let message = format!("a C3D file has room for {} bytes of names, found {found}", BLOCK * MOST);
            io::Error::new(io::ErrorKind::InvalidInput, message)
        };
        self.bytes[2] = u8::try_from(blocks).map_err(|_| too_many())?;
        self.bytes.resize(blocks * BLOCK, 0);
        let after = FIRST_BLOCK + blocks as u16;
        if let Some(at) = self.data_start {
            self.bytes[at..at + 2].copy_from_slice(&after.to_le_bytes());
        }
        Ok((self.bytes, after))
    }

    fn table<T: AsRef<str>>(&mut self, name: &str, texts: &[T]) {
        let texts = texts.iter().map(|text| shortened(text.as_ref(), MOST));
        let width = texts.clone().map(str::len).max().unwrap_or(0).max(1);
        let mut bytes = Vec::with_capacity(width * texts.len());
        for text in texts.clone() {
            bytes.extend_from_slice(text.as_bytes());
            bytes.resize(bytes.len() + width - text.len(), b' ');
        }
        self.record(name, Kind::Text, &[count(width), count(texts.len())], &bytes);
    }

    fn record(&mut self, name: &str, kind: Kind, dimensions: &[u8], values: &[u8]) {
        let distance = 2 + 1 + 1 + dimensions.len() + values.len() + 1;
        self.bytes.push(name.len() as u8);
        self.bytes.push(self.group);
        self.bytes.extend_from_slice(name.as_bytes());
        self.bytes.extend_from_slice(&(distance as u16).to_le_bytes());
        self.bytes.push((kind as i8) as u8);
        self.bytes.push(dimensions.len() as u8);
        self.bytes.extend_from_slice(dimensions);
        self.bytes.extend_from_slice(values);
        self.bytes.push(0);
    }
}

/// A dimension; nothing longer than [`MOST`] comes here.
fn count(length: usize) -> u8 {
    u8::try_from(length).unwrap_or(u8::MAX)
}

/// Bytes of a block: a C3D file is made of them.
pub(super) const BLOCK: usize = 512;
/// The block of the parameter section, counted from 1.
pub(super) const FIRST_BLOCK: u16 = 2;
/// The second byte of header and parameter section.
pub(super) const KEY: u8 = 0x50;
/// The longest dimension of a parameter.
pub(super) const MOST: usize = 255;
/// The processor whose numbers the file has: Intel's.
const LITTLE_ENDIAN: u8 = 84;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_names_its_group_and_leads_to_the_next() {
        let mut parameters = Parameters::new();
        parameters.group("POINT");
        parameters.word("USED", 3);
        parameters.data_start();
        let (bytes, after) = parameters.finish().unwrap();
        assert_eq!((bytes.len(), after), (512, 3));
        assert_eq!(bytes[..4], [1, 0x50, 1, 84]);
        assert_eq!(bytes[4..14], *b"\x05\xffPOINT\x03\0\0");
        assert_eq!(bytes[14..27], *b"\x04\x01USED\x07\0\x02\0\x03\0\0");
        assert_eq!(bytes[27..46], *b"\x0a\x01DATA_START\x07\0\x02\0\x03\0\0");
        assert!(bytes[46..].iter().all(|byte| *byte == 0));
    }

    #[test]
    fn more_than_255_texts_go_on_in_the_next_parameter() {
        let texts: Vec<_> = (0..300).map(|number| number.to_string()).collect();
        let mut parameters = Parameters::new();
        parameters.texts("LABELS", &texts);
        let (bytes, _) = parameters.finish().unwrap();
        let second = bytes.windows(7).position(|name| name == b"LABELS2").unwrap();
        assert_eq!(bytes[second + 9..second + 16], b"\xff\x02\x03\x2d255"[..]);
    }

    #[test]
    fn what_no_section_can_hold_is_refused() {
        let texts = vec!["x".repeat(255); 600];
        let mut parameters = Parameters::new();
        parameters.texts("LABELS", &texts);
        let error = parameters.finish().unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("a C3D file has room for 130560 bytes of names, found 15")
        );
    }
}
