//! Datagrams that come in pieces: IP fragments and TCP segments.

use super::bytes::{Packet, ipv4, ipv6, pcap, pcap_of, udp};
use super::{mxtp, payloads, read};

/// The frames of the fragments of a datagram of IPv4.
fn fragments(payload: &[u8], number: u16, size: usize) -> Vec<Vec<u8>> {
    let packet = Packet::udp(0, payload);
    let (protocol, content) = packet.transport();
    let count = content.chunks(size).count();
    let piece = |(place, piece): (usize, &[u8])| {
        let more = if place + 1 < count { 0x2000 } else { 0 };
        let field = (place * size / 8) as u16 | more;
        ipv4(packet.from.0, packet.to.0, protocol, number, field, piece)
    };
    content.chunks(size).enumerate().map(piece).collect()
}

fn raw(packets: impl IntoIterator<Item = Vec<u8>>) -> Vec<u8> {
    let frames: Vec<_> = packets.into_iter().map(|packet| (0, packet)).collect();
    pcap_of(101, false, false, &frames)
}

#[test]
fn fragments_come_in_any_order_twice_and_mixed_with_others() {
    let (one, other) = (mxtp(1, 4000), mxtp(2, 3000));
    let mut packets = [fragments(&one, 1, 1480), fragments(&other, 2, 1480)].concat();
    packets.swap(0, 4);
    packets.push(packets[1].clone());
    let (captured, capture) = read(&raw(packets.clone()));
    let mut payloads: Vec<_> = captured.iter().map(|one| one.datagram.bytes.to_vec()).collect();
    payloads.sort_by_key(Vec::len);
    assert_eq!(payloads, [other, one]);
    // The piece that comes again behind its packet waits for no other.
    assert_eq!(capture.counts().incomplete, 0);

    packets.remove(0);
    assert_eq!(read(&raw(packets)).0.len(), 1);
}

#[test]
fn fragments_of_ipv6_are_put_together() {
    let ports = [[0xc3, 0x51], 9763u16.to_be_bytes()].concat();
    let content = udp(&ports, &mxtp(1, 2000));
    let pieces = [
        ipv6(17, Some(1), &content[..1200]),
        ipv6(17, Some(1200), &content[1200..]),
    ];
    assert_eq!(payloads(&raw(pieces.clone())), [mxtp(1, 2000)]);
    let [first, last] = pieces;
    assert_eq!(payloads(&raw([last, first])), [mxtp(1, 2000)]);
}

const SYN: u8 = 2;
const ACK: u8 = 16;
const FIN: u8 = 1;

/// The segments of a stream of ten datagrams that begins shortly before the numbers of its bytes start again.
fn stream() -> (Vec<Vec<u8>>, Vec<Packet>) {
    let sent: Vec<_> = (0..10).map(|number| mxtp(number, 100 + number as usize)).collect();
    let bytes = sent.concat();
    let first = 0u32.wrapping_sub(300);
    let mut packets = vec![Packet::tcp(first.wrapping_sub(1), SYN, b"")];
    for (place, segment) in bytes.chunks(64).enumerate() {
        packets.push(Packet::tcp(first.wrapping_add(place as u32 * 64), ACK, segment));
    }
    packets.push(Packet::tcp(first.wrapping_add(bytes.len() as u32), ACK | FIN, b""));
    (sent, packets)
}

fn ethernet(packets: &[Packet]) -> Vec<u8> {
    pcap(1, false, false, packets)
}

#[test]
fn a_stream_is_cut_into_its_datagrams() {
    let (sent, packets) = stream();
    let (captured, capture) = read(&ethernet(&packets));
    let payloads: Vec<_> = captured.iter().map(|one| one.datagram.bytes.to_vec()).collect();
    assert_eq!(payloads, sent);
    assert_eq!(capture.sources(), ["mxtp+tcp://10.0.0.2:9763"]);
    assert_eq!((capture.counts().skipped_bytes, capture.counts().gaps), (0, 0));
}

#[test]
fn segments_sent_again_and_out_of_order_change_nothing() {
    let (sent, mut packets) = stream();
    packets.swap(3, 6);
    packets.swap(9, 10);
    packets.insert(8, packets[2].clone());
    packets.insert(12, packets[11].clone());
    // The end of one and the beginning of the next in a single segment.
    let bytes = sent.concat();
    let number = 0u32.wrapping_sub(300).wrapping_add(100);
    packets.insert(14, Packet::tcp(number, ACK, &bytes[100..180]));
    packets.push(packets[5].clone());
    assert_eq!(payloads(&ethernet(&packets)), sent);
}

#[test]
fn a_segment_that_was_not_captured_costs_only_its_datagrams() {
    let (sent, mut packets) = stream();
    packets.remove(4);
    let (captured, capture) = read(&ethernet(&packets));
    let payloads: Vec<_> = captured.iter().map(|one| one.datagram.bytes.to_vec()).collect();
    // Bytes 192 to 255 are missing: the end of the second datagram and the beginning of the third.
    let expected: Vec<_> = [0, 3, 4, 5, 6, 7, 8, 9].map(|number| sent[number].clone()).into();
    assert_eq!(payloads[..1], expected[..1]);
    assert_eq!(payloads[payloads.len() - 7..], expected[1..]);
    assert_eq!(capture.counts().gaps, 1);
}

#[test]
fn a_stream_that_was_joined_in_the_middle_begins_with_its_next_datagram() {
    let (sent, packets) = stream();
    assert_eq!(payloads(&ethernet(&packets[3..])), sent[2..]);
}

#[test]
fn a_new_connection_between_the_same_ports_is_another_stream() {
    let (sent, packets) = stream();
    let mut again: Vec<_> = packets.clone();
    for packet in &mut again {
        if let super::bytes::Content::Tcp(sequence, ..) = &mut packet.content {
            *sequence = sequence.wrapping_add(1_000_000);
        }
    }
    let both = [packets, again].concat();
    assert_eq!(payloads(&ethernet(&both)), [sent.clone(), sent].concat());
}

#[test]
fn a_stream_of_another_protocol_is_no_loss() {
    let packets = [
        Packet::tcp(1, ACK, b"GET / HTTP/1.1\r\n\r\n"),
        Packet::tcp(900, ACK, b"more"),
    ];
    let (captured, capture) = read(&ethernet(&packets));
    assert!(captured.is_empty());
    assert_eq!(capture.counts().lost() + capture.counts().skipped_bytes, 0);
}
