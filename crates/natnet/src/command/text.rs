//! Commands in text, and the answers to them.

use std::fmt;

use crate::name::before_zero;
use crate::{Name, Quirk, Quirks};

/// A text message: a request (message 2) such as `FrameRate`, or a line for the log (message 8).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Text(pub Name);

impl Text {
    /// Reads the payload. Some clients send no terminating zero; then all of it is the text.
    pub fn decode(payload: &[u8]) -> (Self, Quirks) {
        let name = Name::new(payload);
        let length = name.as_bytes().len();
        let mut quirks = Quirks::NONE;
        quirks.insert_if(length == payload.len(), Quirk::TextUnended);
        quirks.insert_if(length + 1 < payload.len(), Quirk::UnexpectedPayload);
        quirks.insert_if(std::str::from_utf8(name.as_bytes()).is_err(), Quirk::TextNotUtf8);
        (Self(name), quirks)
    }

    /// Appends the payload to `out`: the text and a zero.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(self.0.as_bytes());
        out.push(0);
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Self {
        Self(text.into())
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

/// The answer to a request (message 3): a number of 4 bytes or a string, as the request has it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Response {
    /// The payload.
    pub bytes: Vec<u8>,
}

impl Response {
    /// A whole number: 0 for a command that worked.
    pub fn number(value: i32) -> Self {
        Self {
            bytes: value.to_le_bytes().to_vec(),
        }
    }

    /// A number with a fraction, such as the frame rate.
    pub fn float(value: f32) -> Self {
        Self {
            bytes: value.to_le_bytes().to_vec(),
        }
    }

    /// A string, such as `Bitstream,3.1`. No zero ends it, as the payload does: the vendor's Python client reads the
    /// last number up to the end of the datagram and dies of a zero there.
    pub fn text(text: &str) -> Self {
        Self {
            bytes: text.as_bytes().to_vec(),
        }
    }

    /// The answer to a request that has a whole number for an answer.
    pub fn as_number(&self) -> Option<i32> {
        Some(i32::from_le_bytes(self.four_bytes()?))
    }

    /// The answer to a request that has a number with a fraction for an answer.
    pub fn as_float(&self) -> Option<f32> {
        Some(f32::from_le_bytes(self.four_bytes()?))
    }

    /// The answer to a request that has a string for an answer.
    pub fn as_text(&self) -> Name {
        Name::new(before_zero(&self.bytes))
    }

    fn four_bytes(&self) -> Option<[u8; 4]> {
        self.bytes[..].try_into().ok()
    }
}

impl fmt::Display for Response {
    /// The text, or 4 bytes as both numbers: `0x42f00000, 1122959360 or 120`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.four_bytes() {
            Some(bytes) => {
                let (number, float) = (i32::from_le_bytes(bytes), f32::from_le_bytes(bytes));
                write!(f, "{number:#x}, {number} or {float}")
            }
            None => write!(f, "{:?}", self.as_text()),
        }
    }
}
