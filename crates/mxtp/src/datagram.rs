//! One datagram: header, body, and what was unusual about them.

use std::fmt;

use crate::body::Body;
use crate::{Error, Header, Quirk, Quirks, Revision};

/// A datagram (MV0305 2.4), borrowed from its bytes.
///
/// Nothing is copied and nothing allocated; the value is `Copy`. [`encode`](Self::encode) gives back
/// the very bytes that [`decode`](Self::decode) read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Datagram<'a> {
    /// The header, as it was sent.
    pub header: Header,
    /// The payload.
    pub body: Body<'a>,
    /// Bytes after the last item; empty in a regular datagram.
    pub trailing: &'a [u8],
    /// Deviations from the specification found while decoding.
    pub quirks: Quirks,
}

impl<'a> Datagram<'a> {
    /// Most bytes that a datagram can have: a header and the largest payload it can state.
    pub const MAX_SIZE: usize = Header::SIZE + u16::MAX as usize;

    /// A datagram to send. The message type follows from the body (an opaque body keeps the
    /// header's), and the header's item count and payload size are filled in; the payload size stays
    /// 0 in a Rev J header. Opaque bodies keep the header's item count too.
    ///
    /// # Errors
    /// [`Error::TooLarge`] when the body has more than 255 items or 65535 bytes.
    #[inline]
    pub fn new(mut header: Header, body: Body<'a>) -> Result<Self, Error> {
        header.message_type = body.message_type().unwrap_or(header.message_type);
        let too_large = |field, limit, found| Error::TooLarge {
            message_type: header.message_type,
            field,
            limit,
            found,
        };
        let items = body.items().unwrap_or(header.items.into());
        header.items = u8::try_from(items).map_err(|_| too_large("items", u8::MAX.into(), items))?;
        let size = body.size();
        let payload_size = u16::try_from(size).map_err(|_| too_large("payload bytes", u16::MAX.into(), size))?;
        header.payload_size = match header.revision() {
            Revision::J => 0,
            Revision::N => payload_size,
        };
        Ok(Self {
            header,
            body,
            trailing: &[],
            quirks: Quirks::NONE,
        })
    }

    /// Reads one datagram. `bytes` are all of it and nothing else: the length decides, the header's
    /// payload size does not.
    ///
    /// What real senders get wrong is accepted and noted in [`quirks`](Self::quirks).
    ///
    /// # Errors
    /// Any [`Error`] but the two for senders: bytes that are not MXTP, that end too early, or that
    /// count what they cannot hold.
    #[inline]
    pub fn decode(bytes: &'a [u8]) -> Result<Self, Error> {
        let header = Header::decode(bytes)?;
        let payload = bytes.get(Header::SIZE..).unwrap_or_default();
        let mut quirks = header_quirks(&header, payload.len());
        let (body, trailing) = Body::decode(&header, payload, &mut quirks)?;
        quirks.insert_if(!trailing.is_empty(), Quirk::TrailingBytes);
        Ok(Self {
            header,
            body,
            trailing,
            quirks,
        })
    }

    /// Appends the bytes of the datagram to `out`.
    #[inline]
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.header.encode());
        self.body.encode(out);
        out.extend_from_slice(self.trailing);
    }
}

impl fmt::Display for Datagram<'_> {
    /// One line: `MXTP02 char 0 sample 6681 time 27.837s 0x80 23 segments, pelvis (0.069, ...)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.header, self.body)?;
        if !self.quirks.is_empty() {
            write!(f, " [{}]", self.quirks)?;
        }
        Ok(())
    }
}

#[inline]
fn header_quirks(header: &Header, payload_size: usize) -> Quirks {
    let mut quirks = Quirks::NONE;
    let stated = usize::from(header.payload_size);
    let old = header.revision() == Revision::J;
    quirks.insert_if(!old && stated != payload_size, Quirk::PayloadSize);
    quirks.insert_if(header.reserved != [0; 2], Quirk::ReservedBytes);
    quirks
}
