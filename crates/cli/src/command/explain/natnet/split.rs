//! Cuts a file into packets by the sizes that they state: NatNet frames nothing, a datagram is a packet.

use crate::command::explain::part::Part;
use posewire_natnet::Packet;

/// The parts of an input, which together are all of it.
#[derive(Clone)]
pub(in crate::command::explain) struct Parts<'a> {
    bytes: &'a [u8],
    /// Where the next part begins.
    at: usize,
    /// Whether all of it is one packet, whatever size that states.
    one: bool,
}

impl<'a> Parts<'a> {
    /// The parts of a file: packets back to back, when a second one begins where the first one ends, else one.
    pub(in crate::command::explain) fn of(bytes: &'a [u8]) -> Self {
        let second = stated_length(bytes).and_then(|length| bytes.get(length..));
        let several = second.is_some_and(begins_packet);
        Self {
            bytes,
            at: 0,
            one: !several && bytes.len() <= MAX_SIZE,
        }
    }

    /// The bytes of the next packet, and whether they are one.
    fn next_length(&self, left: &[u8]) -> (usize, bool) {
        match stated_length(left) {
            _ if self.one => (left.len(), true),
            Some(length) if length <= left.len() && (length == left.len() || is_known(left)) => (length, true),
            Some(_) if is_known(left) => (left.len().min(MAX_SIZE), true),
            _ => (left.len(), false),
        }
    }
}

impl<'a> Iterator for Parts<'a> {
    type Item = Part<'a>;

    fn next(&mut self) -> Option<Part<'a>> {
        let offset = self.at;
        let left = self.bytes.get(offset..).filter(|left| !left.is_empty())?;
        let (length, packet) = self.next_length(left);
        self.at += length;
        let bytes = &left[..length];
        Some(if packet {
            Part::Datagram { offset, bytes }
        } else {
            Part::Skipped { offset, bytes }
        })
    }
}

/// Whether it begins with a packet of a known kind that is all there.
pub(in crate::command::explain) fn begins_packet(bytes: &[u8]) -> bool {
    is_known(bytes) && stated_length(bytes).is_some_and(|length| length <= bytes.len())
}

fn is_known(bytes: &[u8]) -> bool {
    Packet::decode(bytes).is_ok_and(|packet| packet.id.name() != "unknown")
}

fn stated_length(bytes: &[u8]) -> Option<usize> {
    let packet = Packet::decode(bytes).ok()?;
    Some(Packet::HEADER_SIZE + usize::from(packet.stated_size))
}

const MAX_SIZE: usize = Packet::HEADER_SIZE + Packet::MAX_PAYLOAD;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::explain::part;

    fn lengths(bytes: &[u8]) -> Vec<isize> {
        part::lengths(Parts::of(bytes), bytes.len())
    }

    #[test]
    fn a_single_packet_may_state_any_size() {
        for bytes in [
            &b"\x0a\0\0\0"[..],
            b"\x0a\0\0\0\0",
            b"\x0a\0\x09\0a",
            b"\x0a\0",
            b"\x4d\0\x01\0a",
        ] {
            assert_eq!(lengths(bytes), [bytes.len() as isize]);
        }
        assert_eq!(lengths(b""), [0; 0]);
    }

    #[test]
    fn packets_back_to_back_are_split_by_their_sizes() {
        let request = b"\x02\0\x02\0a\0";
        assert_eq!(lengths(&request.repeat(3)), [6, 6, 6]);
        assert_eq!(lengths(&[&request[..], b"\x0a\0\0\0", request].concat()), [6, 4, 6]);
    }

    #[test]
    fn what_follows_the_packets_is_cut_or_skipped() {
        let two = b"\x02\0\x02\0a\0".repeat(2);
        assert_eq!(lengths(&[&two[..], b"\x07\0\x20\0abc"].concat()), [6, 6, 7]);
        assert_eq!(lengths(&[&two[..], b"noise"].concat()), [6, 6, -5]);
        let large = vec![0xff; MAX_SIZE + 1];
        assert_eq!(lengths(&large), [-(MAX_SIZE as isize + 1)]);
    }
}
