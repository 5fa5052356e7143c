//! Any bytes at all.

use super::bytes::{Packet, ipv6, pcap, pcap_of, pcapng};
use super::*;
use proptest::prelude::*;

fn read_whatever(file: &[u8]) {
    let mut on_disk = tempfile::NamedTempFile::new().unwrap();
    on_disk.write_all(file).unwrap();
    if let Ok(capture) = Capture::open(on_disk.path(), &CaptureOptions::default()) {
        let lengths = capture.map(|one| one.map_or(0, |one| one.datagram.bytes.len()));
        assert!(lengths.sum::<usize>() <= file.len() * 2);
    }
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
    ]
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400), kind in 0usize..4) {
        let beginning = &files()[kind][..24];
        read_whatever(&bytes);
        read_whatever(&[beginning, &bytes].concat());
    }

    #[test]
    fn any_packet_of_any_link_is_read(bytes in prop::collection::vec(any::<u8>(), 0..200), link in 0u32..300) {
        read_whatever(&pcap_of(link, false, false, &[(0, bytes)]));
    }

    #[test]
    fn any_flipped_bit_is_survived(kind in 0usize..4, place in any::<prop::sample::Index>(), bit in 0u8..8) {
        let mut file = files()[kind].clone();
        let place = place.index(file.len());
        file[place] ^= 1u8 << bit;
        read_whatever(&file);
    }
}
