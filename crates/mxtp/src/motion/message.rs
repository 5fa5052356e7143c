//! Writing one message as one datagram or as several.

use super::Datagrams;
use crate::body::Body;
use crate::{Datagram, DatagramCounter, Header, Revision};
use zerocopy::{Immutable, IntoBytes};

/// The most bytes that a UDP datagram can carry over IPv4.
pub(super) const MAX_DATAGRAM: usize = 65_507;

/// Appends records as one message. A part ends when the next record would make the datagram longer than `limit` bytes
/// or its item count larger than 255; but there are never more than 128 parts, as the counter has seven bits.
///
/// `most` is the largest number of records that can come. What 128 parts of 255 records cannot hold is left out.
#[inline]
pub(super) fn write_records<T>(
    out: &mut Datagrams,
    header: Header,
    limit: usize,
    most: usize,
    records: impl Iterator<Item = T>,
) where
    T: IntoBytes + Immutable,
{
    let fitting = limit.min(MAX_DATAGRAM).saturating_sub(Header::SIZE) / size_of::<T>();
    let per_part = fitting.max(most.div_ceil(MAX_PARTS)).clamp(1, MAX_ITEMS);
    out.bytes
        .reserve(most * size_of::<T>() + most.div_ceil(per_part).max(1) * Header::SIZE);
    let mut part = Part::begin(out, 0);
    for record in records {
        if part.items == per_part {
            part = match part.index + 1 {
                MAX_PARTS => break,
                next => {
                    part.end(out, header, false);
                    Part::begin(out, next)
                }
            };
        }
        out.bytes.extend_from_slice(record.as_bytes());
        part.items += 1;
    }
    part.end(out, header, true);
}

/// Appends a message of one datagram; nothing when its body is too large for one.
pub(super) fn write_body(out: &mut Datagrams, header: Header, body: Body<'_>) {
    let datagram = Datagram::new(header, body).ok();
    if let Some(datagram) = datagram.filter(|datagram| datagram.body.size() <= MAX_DATAGRAM - Header::SIZE) {
        datagram.encode(&mut out.bytes);
        out.ends.push(out.bytes.len());
    }
}

const MAX_PARTS: usize = 128;
const MAX_ITEMS: usize = 255;

/// A datagram that is being written; its header is filled in at the end.
struct Part {
    start: usize,
    index: usize,
    items: usize,
}

impl Part {
    #[inline]
    fn begin(out: &mut Datagrams, index: usize) -> Self {
        let start = out.bytes.len();
        out.bytes.extend_from_slice(&[0; Header::SIZE]);
        Self { start, index, items: 0 }
    }

    #[inline]
    fn end(self, out: &mut Datagrams, header: Header, last: bool) {
        let payload = out.bytes.len() - self.start - Header::SIZE;
        let payload_size = match header.revision() {
            Revision::J => 0,
            Revision::N => payload as u16,
        };
        let header = Header {
            counter: DatagramCounter::part(self.index as u8, last),
            items: self.items as u8,
            payload_size,
            ..header
        };
        out.bytes[self.start..self.start + Header::SIZE].copy_from_slice(&header.encode());
        out.ends.push(out.bytes.len());
    }
}
