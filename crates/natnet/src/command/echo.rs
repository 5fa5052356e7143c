//! How a client reads the server's clock.

use crate::reader::Reader;
use crate::writer::Writer;
use crate::{Error, Quirk, Quirks};

/// A question for the server's clock (message 12).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EchoRequest {
    /// The client's clock, in whatever unit it likes.
    pub client_ticks: u64,
}

/// The answer (message 13).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EchoResponse {
    /// The request's.
    pub client_ticks: u64,
    /// The server's clock when the request came, in ticks of the frequency in its server info.
    pub server_ticks: u64,
}

impl EchoRequest {
    /// Reads the payload.
    ///
    /// # Errors
    /// [`Error::Truncated`] for fewer than 8 bytes.
    pub fn decode(payload: &[u8]) -> Result<(Self, Quirks), Error> {
        let mut reader = Reader::new("echo request", payload);
        let client_ticks = reader.u64()?;
        Ok((Self { client_ticks }, leftover(&reader)))
    }

    /// Appends the payload to `out`.
    pub fn encode(&self, out: &mut Vec<u8>) {
        Writer::new(out).u64(self.client_ticks);
    }
}

impl EchoResponse {
    /// Reads the payload.
    ///
    /// # Errors
    /// [`Error::Truncated`] for fewer than 16 bytes.
    pub fn decode(payload: &[u8]) -> Result<(Self, Quirks), Error> {
        let mut reader = Reader::new("echo response", payload);
        let (client_ticks, server_ticks) = (reader.u64()?, reader.u64()?);
        let response = Self {
            client_ticks,
            server_ticks,
        };
        Ok((response, leftover(&reader)))
    }

    /// Appends the payload to `out`.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let mut writer = Writer::new(out);
        writer.u64(self.client_ticks);
        writer.u64(self.server_ticks);
    }
}

fn leftover(reader: &Reader<'_>) -> Quirks {
    let mut quirks = Quirks::NONE;
    quirks.insert_if(reader.left() > 0, Quirk::UnexpectedPayload);
    quirks
}
