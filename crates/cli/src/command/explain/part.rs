//! What an input is cut into, and what is told of each datagram.

use super::natnet::Bitstream;
use crate::cli::Protocol;
use posewire_natnet::MessageId;
use std::fmt::Write;

/// A run of bytes of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part<'a> {
    /// One datagram, maybe malformed.
    Datagram {
        /// Where it begins in the input.
        offset: usize,
        bytes: &'a [u8],
    },
    /// Bytes that belong to no datagram.
    Skipped {
        /// Where they begin in the input.
        offset: usize,
        bytes: &'a [u8],
    },
}

/// The lengths of parts that follow each other and are all of an input, those of skipped bytes negative.
#[cfg(test)]
pub(super) fn lengths<'a>(parts: impl Iterator<Item = Part<'a>>, input: usize) -> Vec<isize> {
    let mut end = 0;
    let lengths = parts.map(|part| {
        let (offset, length, sign) = match part {
            Part::Datagram { offset, bytes } => (offset, bytes.len(), 1),
            Part::Skipped { offset, bytes } => (offset, bytes.len(), -1),
        };
        assert_eq!(offset, end);
        end += length;
        length as isize * sign
    });
    let lengths = lengths.collect();
    assert_eq!(end, input);
    lengths
}

/// A datagram of the input, explained: the same for every protocol.
pub(super) struct Explained<'a> {
    /// Where it begins in the input.
    pub(super) offset: usize,
    pub(super) bytes: &'a [u8],
    pub(super) protocol: Protocol,
    /// What it says in one line, malformed or not.
    pub(super) title: String,
    /// `None` when it is cut short.
    pub(super) header: Option<Header>,
    /// The bitstream it was read as; `None` when its layout depends on none.
    pub(super) bitstream: Option<&'a Bitstream>,
    /// The document whose sections have numbers; without one their names are in those of the fields.
    pub(super) document: Option<&'static str>,
    pub(super) fields: Vec<Field>,
    pub(super) quirks: Vec<Quirk>,
    pub(super) error: Option<String>,
}

/// The header of a datagram.
pub(super) enum Header {
    Mxtp(posewire_mxtp::Header),
    NatNet { message: MessageId, payload_size: u16 },
}

/// A deviation from the documents.
pub(super) struct Quirk {
    pub(super) name: &'static str,
    pub(super) meaning: &'static str,
}

/// One field of a datagram.
pub(super) struct Field {
    /// Where it begins in the datagram.
    pub(super) offset: usize,
    pub(super) length: usize,
    pub(super) name: String,
    /// Empty where there is none.
    pub(super) section: &'static str,
    pub(super) value: Value,
    pub(super) unit: Option<&'static str>,
    pub(super) note: Option<String>,
}

/// The value of a field.
pub(super) enum Value {
    Unsigned(u64),
    Signed(i32),
    Float(f32),
    Double(f64),
    Text(String),
    Bytes(Vec<u8>),
}

/// Bytes as hexadecimal digits.
pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut digits, byte| {
        _ = write!(digits, "{byte:02x}");
        digits
    })
}
