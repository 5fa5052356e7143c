//! The classic capture file of libpcap, in microseconds or nanoseconds and either order of bytes.

use super::input::{Filled, Input, Order};
use super::packet::{Head, MAX_PACKET, Next};
use posewire_motion::Stamp;
use std::io;

/// A pcap file behind its header.
///
/// | bytes of a record | field |
/// |---|---|
/// | 0-3 | seconds since 1970, UTC |
/// | 4-7 | microseconds or nanoseconds of the second, as the file's magic says |
/// | 8-11 | bytes of the packet that are in the file |
/// | 12-15 | bytes that it had on the wire |
#[derive(Debug)]
pub(super) struct Pcap {
    order: Order,
    nanoseconds_per_tick: i64,
    link: u32,
}

impl Pcap {
    /// Reads the rest of the header behind the magic; `None` when it is not a pcap file's.
    pub(super) fn open(magic: [u8; 4], input: &mut Input) -> io::Result<Option<Self>> {
        let Some((order, nanoseconds_per_tick)) = kind(magic) else {
            return Ok(None);
        };
        let Ok(header) = input.array::<20>()? else {
            return Ok(None);
        };
        // The upper bits say how long the check sequence of a frame is.
        let link = order.u32(&header, 16).unwrap_or_default() & 0x0fff_ffff;
        Ok(Some(Self {
            order,
            nanoseconds_per_tick,
            link,
        }))
    }

    /// The next packet's bytes into `bytes`.
    pub(super) fn next(&self, input: &mut Input, bytes: &mut Vec<u8>) -> io::Result<Next> {
        let header = match input.array::<16>()? {
            Ok(header) => header,
            Err(Filled::Nothing) => return Ok(Next::End),
            Err(_) => return Ok(Next::Damaged("the file ends in the middle of a record")),
        };
        let number = |at| self.order.u32(&header, at).unwrap_or_default();
        let (length, on_wire) = (number(8), number(12));
        if length as usize > MAX_PACKET {
            return Ok(Next::Damaged("a packet states an impossible length"));
        }
        if input.fill(length as usize, bytes)? != Filled::All && length > 0 {
            return Ok(Next::Damaged("the file ends in the middle of a packet"));
        }
        let fraction = i64::from(number(4)).saturating_mul(self.nanoseconds_per_tick);
        Ok(Next::Packet(Head {
            time: Stamp::from_parts(number(0).into(), fraction),
            link: self.link,
            is_cut: length < on_wire,
            wire: None,
        }))
    }
}

fn kind(magic: [u8; 4]) -> Option<(Order, i64)> {
    match magic {
        [0xd4, 0xc3, 0xb2, 0xa1] => Some((Order::Little, 1000)),
        [0xa1, 0xb2, 0xc3, 0xd4] => Some((Order::Big, 1000)),
        [0x4d, 0x3c, 0xb2, 0xa1] => Some((Order::Little, 1)),
        [0xa1, 0xb2, 0x3c, 0x4d] => Some((Order::Big, 1)),
        _ => None,
    }
}
