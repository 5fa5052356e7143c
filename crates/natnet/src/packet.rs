//! The packet: a message number, a size and a payload.

use std::fmt;

use crate::writer::Writer;
use crate::{Error, Quirk, Quirks};

/// Bytes of a header: two numbers of 16 bits.
pub(crate) const HEADER_SIZE: usize = 4;

/// The number that says what a packet is.
///
/// Numbers without a named constant stay what they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MessageId(pub u16);

impl MessageId {
    /// Client to server: who are you, here I am. Also called PING.
    pub const CONNECT: Self = Self(0);
    /// Server to client: name, versions, port and group. Also called PINGRESPONSE.
    pub const SERVER_INFO: Self = Self(1);
    /// Client to server: a command in text.
    pub const REQUEST: Self = Self(2);
    /// Server to client: the answer to a command.
    pub const RESPONSE: Self = Self(3);
    /// Client to server: asks for the descriptions.
    pub const REQUEST_MODEL: Self = Self(4);
    /// Server to client: the descriptions of all that is streamed.
    pub const MODEL: Self = Self(5);
    /// Client to server: asks for one frame.
    pub const REQUEST_FRAME: Self = Self(6);
    /// Server to client: one frame.
    pub const FRAME: Self = Self(7);
    /// A text for the log of the other side.
    pub const MESSAGE_STRING: Self = Self(8);
    /// Client to server: no more frames, please.
    pub const DISCONNECT: Self = Self(9);
    /// Client to server: still here (unicast).
    pub const KEEP_ALIVE: Self = Self(10);
    /// Server to client: no keep-alive came for too long.
    pub const DISCONNECT_BY_TIMEOUT: Self = Self(11);
    /// Client to server: what does your clock say?
    pub const ECHO_REQUEST: Self = Self(12);
    /// Server to client: what the clock says.
    pub const ECHO_RESPONSE: Self = Self(13);
    /// Client to everybody: which servers are there?
    pub const DISCOVERY: Self = Self(14);
    /// Server to client: this command is unknown.
    pub const UNRECOGNIZED_REQUEST: Self = Self(100);

    /// The name in the documents; `unknown` for a number that they do not have.
    pub const fn name(self) -> &'static str {
        match self {
            Self::CONNECT => "CONNECT",
            Self::SERVER_INFO => "SERVERINFO",
            Self::REQUEST => "REQUEST",
            Self::RESPONSE => "RESPONSE",
            Self::REQUEST_MODEL => "REQUEST_MODELDEF",
            Self::MODEL => "MODELDEF",
            Self::REQUEST_FRAME => "REQUEST_FRAMEOFDATA",
            Self::FRAME => "FRAMEOFDATA",
            Self::MESSAGE_STRING => "MESSAGESTRING",
            Self::DISCONNECT => "DISCONNECT",
            Self::KEEP_ALIVE => "KEEPALIVE",
            Self::DISCONNECT_BY_TIMEOUT => "DISCONNECTBYTIMEOUT",
            Self::ECHO_REQUEST => "ECHOREQUEST",
            Self::ECHO_RESPONSE => "ECHORESPONSE",
            Self::DISCOVERY => "DISCOVERY",
            Self::UNRECOGNIZED_REQUEST => "UNRECOGNIZED_REQUEST",
            _ => "unknown",
        }
    }
}

impl fmt::Display for MessageId {
    /// `FRAMEOFDATA`, or `message 55` for a number without a name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name() {
            "unknown" => write!(f, "message {}", self.0),
            name => f.pad(name),
        }
    }
}

/// A packet whose payload is not read yet, borrowed from its bytes.
///
/// | bytes | field |
/// |---|---|
/// | 0-1 | message number |
/// | 2-3 | bytes of the payload |
/// | 4- | payload |
///
/// All numbers of NatNet are little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    /// What the payload is.
    pub id: MessageId,
    /// Bytes of the payload as the header states them.
    pub stated_size: u16,
    /// The payload: what the header states, or what is there when that is less.
    pub payload: &'a [u8],
    /// Whether the header is wrong about the size.
    pub quirks: Quirks,
}

impl<'a> Packet<'a> {
    /// Bytes of the header.
    pub const HEADER_SIZE: usize = HEADER_SIZE;

    /// The largest payload that a UDP datagram over IPv4 has room for.
    pub const MAX_PAYLOAD: usize = 65_503;

    /// Reads the header of one datagram. Clients that send a byte more than they state are common;
    /// the smaller size counts.
    ///
    /// # Errors
    /// [`Error::ShortHeader`] for fewer than 4 bytes.
    pub fn decode(bytes: &'a [u8]) -> Result<Self, Error> {
        let Some(([a, b, c, d], rest)) = bytes.split_first_chunk() else {
            return Err(Error::ShortHeader { found: bytes.len() });
        };
        let stated_size = u16::from_le_bytes([*c, *d]);
        let mut quirks = Quirks::NONE;
        quirks.insert_if(usize::from(stated_size) != rest.len(), Quirk::PayloadSize);
        Ok(Self {
            id: MessageId(u16::from_le_bytes([*a, *b])),
            stated_size,
            payload: rest.get(..stated_size.into()).unwrap_or(rest),
            quirks,
        })
    }

    /// Appends a packet to `out` whose payload `payload` appends. On an error `out` is what it was.
    ///
    /// ```
    /// use posewire_natnet::{MessageId, Packet};
    ///
    /// let mut bytes = Vec::new();
    /// Packet::encode(MessageId::REQUEST, &mut bytes, |out| out.extend(b"FrameRate\0"))?;
    /// assert_eq!(bytes, b"\x02\0\x0a\0FrameRate\0");
    /// # Ok::<(), posewire_natnet::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::TooLarge`] for more than [`MAX_PAYLOAD`](Self::MAX_PAYLOAD) bytes.
    pub fn encode(id: MessageId, out: &mut Vec<u8>, payload: impl FnOnce(&mut Vec<u8>)) -> Result<(), Error> {
        let start = out.len();
        let mut writer = Writer::new(out);
        writer.u16(id.0);
        writer.u16(0);
        payload(out);
        let found = out.len().saturating_sub(start + HEADER_SIZE);
        if found > Self::MAX_PAYLOAD {
            out.truncate(start);
            return Err(Error::TooLarge {
                message: id,
                limit: Self::MAX_PAYLOAD,
                found,
            });
        }
        if let Some(place) = out.get_mut(start + 2..start + 4) {
            place.copy_from_slice(&(found as u16).to_le_bytes());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smaller_of_stated_and_found_size_counts() {
        let decode = |bytes| Packet::decode(bytes).unwrap();
        let exact = decode(b"\x0a\0\x01\0a");
        assert_eq!((exact.id, exact.payload), (MessageId::KEEP_ALIVE, &b"a"[..]));
        assert_eq!(exact.quirks, Quirks::NONE);
        for (bytes, payload) in [(&b"\x0a\0\0\0\0"[..], &b""[..]), (b"\x0a\0\x09\0ab", b"ab")] {
            let packet = decode(bytes);
            assert_eq!(packet.payload, payload);
            assert_eq!(packet.quirks, Quirk::PayloadSize.into());
        }
        assert_eq!(Packet::decode(b"abc"), Err(Error::ShortHeader { found: 3 }));
    }

    #[test]
    fn a_payload_that_no_datagram_carries_is_refused() {
        let mut out = b"before".to_vec();
        let encode = |out: &mut Vec<u8>, size| {
            Packet::encode(MessageId::FRAME, out, |out| out.extend(std::iter::repeat_n(7, size)))
        };
        assert!(encode(&mut out, Packet::MAX_PAYLOAD + 1).is_err());
        assert_eq!(out, b"before");
        assert_eq!(encode(&mut out, Packet::MAX_PAYLOAD), Ok(()));
        assert_eq!(out.len(), 6 + 65_507);
    }
}
