//! Any bytes at all.

use super::bytes::{Packet, ipv6, pcap, pcap_of, pcapng};
use super::*;
use crate::recording::{Writer, WriterOptions};
use crate::{SourceId, Wire};
use proptest::prelude::*;
use std::sync::Arc;

fn read_whatever(file: &[u8]) {
    let mut on_disk = tempfile::NamedTempFile::new().unwrap();
    on_disk.write_all(file).unwrap();
    if let Ok(capture) = Capture::open(on_disk.path(), &CaptureOptions::default()) {
        let lengths = capture.map(|one| one.map_or(0, |one| one.datagram.bytes.len()));
        assert!(lengths.sum::<usize>() <= file.len() * 2);
    }
}

/// A recording of two sources.
fn recording() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let names = ["mxtp://0.0.0.0:9763", "natnet://10.0.0.7:1510"].map(ToOwned::to_owned);
    let mut writer = Writer::create(&path, &names, WriterOptions::default()).unwrap();
    for number in 0..6 {
        let is_natnet = number % 2 == 1;
        let datagram = Datagram {
            wire: if is_natnet { Wire::NatNetCommand } else { Wire::MxtpUdp },
            from: ([10, 0, 0, 7], 1510).into(),
            to: ([0, 0, 0, 0], 9763).into(),
            received: posewire_motion::Stamp(i64::from(number)),
            bytes: mxtp(number, 40).into(),
        };
        let source = SourceId(u16::from(is_natnet));
        writer.datagram(source, &Arc::new(datagram)).unwrap();
        if number % 2 == 1 {
            writer.flush().unwrap();
        }
    }
    writer.finish().unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn a_recording_gives_its_sources_also_when_it_was_cut_off() {
    let file = recording();
    let (captured, capture) = read(&file);
    assert_eq!(capture.sources(), ["mxtp://0.0.0.0:9763", "natnet://10.0.0.7:1510"]);
    assert_eq!(capture.damage(), None);
    let sources: Vec<_> = captured.iter().map(|one| one.source).collect();
    assert_eq!(sources, [0, 1, 0, 1, 0, 1]);
    // Up to the middle of the last message's payload: of a chunk that is torn nothing can be relied on.
    let last = file.windows(16).rposition(|window| window == [5; 16]).unwrap();
    let (captured, capture) = read(&file[..last]);
    assert_eq!(captured.len(), 4);
    assert_eq!(capture.damage(), Some("the recording was cut off"));
}

fn files() -> Vec<Vec<u8>> {
    let udp: Vec<_> = (0..3).map(|number| Packet::udp(number, &mxtp(number, 40))).collect();
    let tcp: Vec<_> = (0..3)
        .map(|number| Packet::tcp(number * 40, 16, &mxtp(number, 40)))
        .collect();
    let six = ipv6(17, Some(1), &[7; 32]);
    vec![
        pcap(1, false, false, &udp),
        pcap(1, true, true, &tcp),
        pcapng(1, false, 9, &tcp),
        pcap_of(101, false, false, &[(0, six)]),
        recording(),
    ]
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400), kind in 0usize..5) {
        let beginning = &files()[kind][..24];
        read_whatever(&bytes);
        read_whatever(&[beginning, &bytes].concat());
    }

    #[test]
    fn any_packet_of_any_link_is_read(bytes in prop::collection::vec(any::<u8>(), 0..200), link in 0u32..300) {
        read_whatever(&pcap_of(link, false, false, &[(0, bytes)]));
    }

    #[test]
    fn any_flipped_bit_is_survived(kind in 0usize..5, place in any::<prop::sample::Index>(), bit in 0u8..8) {
        let mut file = files()[kind].clone();
        let place = place.index(file.len());
        file[place] ^= 1u8 << bit;
        read_whatever(&file);
    }
}
