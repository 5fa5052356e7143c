//! Captures whose every byte is written here, and what comes out of them.

mod any;
mod bytes;
mod links;
mod pieces;
mod written;

use super::*;
use bytes::{Packet, pcap, pcapng};
use posewire_motion::Stamp;
use std::io::Write;

/// What a capture of these bytes gives, and what it says of the rest.
fn read_with(file: &[u8], options: &CaptureOptions) -> (Vec<Captured>, Capture) {
    let mut on_disk = tempfile::NamedTempFile::new().unwrap();
    on_disk.write_all(file).unwrap();
    let mut capture = Capture::open(on_disk.path(), options).unwrap();
    let captured = capture.by_ref().collect::<Result<_>>().unwrap();
    (captured, capture)
}

fn read(file: &[u8]) -> (Vec<Captured>, Capture) {
    read_with(file, &CaptureOptions::default())
}

/// The payloads in order.
fn payloads(file: &[u8]) -> Vec<Vec<u8>> {
    let (captured, _) = read(file);
    captured.into_iter().map(|one| one.datagram.bytes.into_vec()).collect()
}

/// A datagram that says where it ends, of a given length.
fn mxtp(number: u32, length: usize) -> Vec<u8> {
    let mut bytes = b"MXTP11".to_vec();
    bytes.extend(number.to_be_bytes());
    bytes.extend([0x80, 1]);
    bytes.extend([0; 10]);
    bytes.extend(((length - 24) as u16).to_be_bytes());
    bytes.resize(length, number as u8);
    bytes
}

#[test]
fn either_kind_of_file_gives_the_same_in_either_order_of_bytes() {
    let packets: Vec<_> = (0..5).map(|number| Packet::udp(number, &mxtp(number, 40))).collect();
    let expected: Vec<_> = (0..5).map(|number| mxtp(number, 40)).collect();
    for big in [false, true] {
        for nanoseconds in [false, true] {
            let (captured, capture) = read(&pcap(1, big, nanoseconds, &packets));
            assert_eq!(capture.damage(), None);
            for (number, one) in captured.iter().enumerate() {
                let fraction = if nanoseconds { 7 } else { 7000 };
                assert_eq!(one.datagram.received, Stamp::from_parts(1000 + number as i64, fraction));
                assert_eq!(&*one.datagram.bytes, expected[number]);
            }
            assert_eq!(captured.len(), 5);
        }
        let (captured, capture) = read(&pcapng(1, big, 9, &packets));
        assert_eq!(capture.damage(), None);
        let times: Vec<_> = captured.iter().map(|one| one.datagram.received).collect();
        let expected: Vec<_> = (0..5).map(|number| Stamp::from_parts(1000 + number, 7)).collect();
        assert_eq!(times, expected);
    }
}

#[test]
fn each_clock_of_a_pcapng_file_is_read() {
    let packets = [Packet::udp(0, &mxtp(0, 40))];
    for (resolution, nanoseconds) in [(6, 7000), (9, 7), (3, 7_000_000), (0x8a, 7 * 1_000_000_000 / 1024)] {
        let (captured, _) = read(&pcapng(1, false, resolution, &packets));
        let expected = Stamp::from_parts(1000, nanoseconds);
        assert_eq!(captured[0].datagram.received, expected, "{resolution}");
    }
}

#[test]
fn sources_are_told_apart_by_where_they_go() {
    let mut packets = vec![Packet::udp(0, &mxtp(0, 40)), Packet::udp(1, &mxtp(1, 40))];
    packets[1].to = ([239, 1, 2, 3], 9763);
    let natnet = b"\x07\0\x04\0\0\0\0\0";
    packets.push(Packet {
        from: ([10, 0, 0, 7], 1510),
        to: ([10, 0, 0, 2], 50_000),
        ..Packet::udp(2, natnet)
    });
    packets.push(Packet {
        from: ([10, 0, 0, 2], 50_000),
        to: ([10, 0, 0, 7], 1510),
        ..Packet::udp(3, b"\x0a\0\0\0")
    });
    packets.push(Packet::udp(4, b"something else"));
    let (captured, capture) = read(&pcap(1, false, false, &packets));
    let sources: Vec<_> = captured.iter().map(|one| one.source).collect();
    assert_eq!(sources, [0, 1, 2, 2]);
    assert_eq!(
        capture.sources(),
        ["mxtp://10.0.0.2:9763", "mxtp://239.1.2.3:9763", "natnet://10.0.0.7"]
    );
    assert_eq!((capture.counts().packets, capture.counts().other), (5, 1));
    assert_eq!(capture.counts().lost(), 0);
}

#[test]
fn a_protocol_can_be_forced() {
    let file = pcap(1, false, false, &[Packet::udp(0, b"something else")]);
    assert!(payloads(&file).is_empty());
    let forced = CaptureOptions {
        protocol: Some(Protocol::Mxtp),
    };
    let (captured, _) = read_with(&file, &forced);
    assert_eq!(&*captured[0].datagram.bytes, b"something else");
}

#[test]
fn a_file_that_was_cut_off_gives_what_is_whole() {
    let packets: Vec<_> = (0..3).map(|number| Packet::udp(number, &mxtp(number, 40))).collect();
    for file in [pcap(1, false, false, &packets), pcapng(1, true, 6, &packets)] {
        let cut = &file[..file.len() - 10];
        let (captured, capture) = read(cut);
        assert_eq!(captured.len(), 2);
        assert!(capture.damage().unwrap().starts_with("the file ends in the middle of"));
    }
}

#[test]
fn another_file_is_refused_with_its_first_bytes() {
    for content in [
        &b""[..],
        b"<mvnx",
        b"\xd4\xc3\xb2\xa1\x02",
        b"MXTP02xxxxxxxxxxxxxxxxxxxxxxx",
    ] {
        let mut on_disk = tempfile::NamedTempFile::new().unwrap();
        on_disk.write_all(content).unwrap();
        let error = Capture::open(on_disk.path(), &CaptureOptions::default()).unwrap_err();
        let expected = Error::NotACapture {
            path: on_disk.path().to_owned(),
            found: content.iter().take(8).copied().collect(),
        };
        assert_eq!(error, expected);
    }
}
