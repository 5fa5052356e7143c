//! Each kind of link.

use super::bytes::{Packet, ipv6, pcap, pcap_of, udp};
use super::{mxtp, payloads, read};

#[test]
fn vlan_tags_are_passed_over() {
    let ip = Packet::udp(0, &mxtp(0, 60)).ip();
    let tags: [&[u8]; 3] = [
        &[0x81, 0, 0, 5, 8, 0],
        &[0x88, 0xa8, 0, 9, 0x81, 0, 0, 5, 8, 0],
        &[0x91, 0, 0, 9, 0x81, 0, 0, 5, 8, 0],
    ];
    for tag in tags {
        let frame = [tag, &ip].concat();
        let file = pcap(1, false, false, &[Packet::frame(0, &frame)]);
        assert_eq!(payloads(&file), [mxtp(0, 60)], "{tag:x?}");
    }
}

#[test]
fn every_link_leads_to_the_same_datagram() {
    let ip = Packet::udp(0, &mxtp(0, 60)).ip();
    let links: [(u32, Vec<u8>); 9] = [
        (0, vec![2, 0, 0, 0]),
        (0, vec![0, 0, 0, 2]),
        (108, vec![0, 0, 0, 2]),
        (12, vec![]),
        (14, vec![]),
        (101, vec![]),
        (228, vec![]),
        (113, [vec![0; 14], vec![8, 0]].concat()),
        (276, [vec![8, 0], vec![0; 18]].concat()),
    ];
    for (link, header) in links {
        let file = pcap_of(link, false, false, &[(0, [header, ip.clone()].concat())]);
        assert_eq!(payloads(&file), [mxtp(0, 60)], "link {link}");
    }
}

#[test]
fn ipv6_leads_to_the_same_datagram() {
    let ports = [[0xc3, 0x51], 9763u16.to_be_bytes()].concat();
    let ip = ipv6(17, None, &udp(&ports, &mxtp(0, 60)));
    for (link, header) in [
        (229, vec![]),
        (101, vec![]),
        (0, vec![30, 0, 0, 0]),
        (276, [vec![0x86, 0xdd], vec![0; 18]].concat()),
    ] {
        let file = pcap_of(link, false, false, &[(0, [header, ip.clone()].concat())]);
        assert_eq!(payloads(&file), [mxtp(0, 60)], "link {link}");
    }
}

#[test]
fn padding_behind_a_short_packet_is_no_part_of_it() {
    let mut frame = Packet::udp(0, b"MXTP02").ethernet();
    frame.resize(60, 0xee);
    assert_eq!(payloads(&pcap_of(1, false, false, &[(0, frame)])), [b"MXTP02"]);
}

#[test]
fn what_is_not_understood_is_counted() {
    let whole = Packet::udp(0, &mxtp(0, 60)).ethernet();
    let arp = [&[0xff; 6][..], &[2, 0, 0, 0, 0, 1], &[8, 6], &[0; 28]].concat();
    let mut wrong_header = whole.clone();
    wrong_header[14] = 0x41;
    let (captured, capture) = read(&pcap_of(
        1,
        false,
        false,
        &[
            (0, whole[..70].to_vec()),
            (0, arp),
            (0, wrong_header),
            (0, whole[..10].to_vec()),
        ],
    ));
    let counts = capture.counts();
    assert!(captured.is_empty());
    assert_eq!((counts.cut, counts.other, counts.malformed), (1, 1, 2));
    let (_, capture) = read(&pcap_of(147, false, false, &[(0, whole)]));
    assert_eq!(capture.counts().unknown_link, 1);
}
