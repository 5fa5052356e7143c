//! Files that we write.

use super::*;
use crate::Wire;
use crate::capture::{PcapWriter, convert};
use crate::stop::Stop;
use proptest::prelude::*;

fn datagram(wire: Wire, received: i64, bytes: Vec<u8>) -> Datagram {
    Datagram {
        wire,
        from: ([192, 168, 1, 20], 50_123).into(),
        to: ([239, 255, 42, 99], 1511).into(),
        received: Stamp(received),
        bytes: bytes.into(),
    }
}

fn write(path: &Path, datagrams: &[Datagram]) {
    let mut writer = PcapWriter::create(path, true).unwrap();
    for datagram in datagrams {
        writer.write(datagram).unwrap();
    }
    writer.finish().unwrap();
}

fn read_file(path: &Path) -> Vec<Datagram> {
    let capture = Capture::open(path, &CaptureOptions::default()).unwrap();
    capture.map(|captured| captured.unwrap().datagram).collect()
}

#[test]
fn a_file_that_is_there_is_not_overwritten_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.pcapng");
    write(&path, &[]);
    assert!(matches!(PcapWriter::create(&path, false), Err(Error::Exists { .. })));
}

#[test]
fn a_capture_is_not_converted_onto_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.pcapng");
    write(&path, &[datagram(Wire::MxtpUdp, 1_000_000_000, mxtp(1, 100))]);
    let links = folder.path().join("links");
    std::fs::create_dir(&links).unwrap();
    let second_name = links.join("take.pcapng");
    std::fs::hard_link(&path, &second_name).unwrap();
    for to in [path.clone(), second_name, links.join("../take.pcapng")] {
        for overwrite in [false, true] {
            let options = ConvertOptions {
                overwrite,
                ..ConvertOptions::default()
            };
            let refused = convert(&path, &to, &options, &Stop::new());
            assert_eq!(refused, Err(Error::OntoItself { path: to.clone() }));
        }
    }
    assert_eq!(read_file(&path).len(), 1);
}

#[test]
fn a_stream_over_tcp_comes_back_with_its_times() {
    let folder = tempfile::tempdir().unwrap();
    let sent: Vec<_> = (0..20)
        .map(|number| datagram(Wire::MxtpTcp, 1_000_000_000 + i64::from(number), mxtp(number, 60_000)))
        .collect();
    for name in ["take.pcapng", "take.pcap"] {
        let path = folder.path().join(name);
        write(&path, &sent);
        assert_eq!(read_file(&path), sent);
    }
}

#[test]
fn from_pcapng_to_pcap_and_back_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second, third] = ["a.pcapng", "b.pcap", "c.pcapng"].map(|name| folder.path().join(name));
    let sent: Vec<_> = (0..50)
        .map(|number| datagram(Wire::MxtpUdp, i64::from(number) * 4_166_667, mxtp(number, 65_507)))
        .collect();
    write(&first, &sent);
    assert_eq!(
        convert(&first, &second, &ConvertOptions::default(), &Stop::new())
            .unwrap()
            .datagrams,
        50
    );
    assert_eq!(
        convert(&second, &third, &ConvertOptions::default(), &Stop::new())
            .unwrap()
            .damage,
        None
    );
    assert_eq!(read_file(&third), sent);
}

fn any_datagram() -> impl Strategy<Value = Datagram> {
    let wire = prop::sample::select(vec![Wire::MxtpUdp, Wire::NatNetCommand, Wire::NatNetData]);
    let place = prop_oneof![
        any::<([u8; 4], u16)>().prop_map(std::net::SocketAddr::from),
        any::<([u8; 16], u16)>().prop_map(std::net::SocketAddr::from),
    ];
    let bytes = prop::collection::vec(any::<u8>(), 0..2000);
    (wire, place, any::<u16>(), 0..i64::MAX, bytes).prop_map(|(wire, from, port, received, bytes)| Datagram {
        wire,
        from,
        to: std::net::SocketAddr::new(from.ip(), port),
        received: Stamp(received),
        bytes: bytes.into(),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whatever_is_written_as_pcapng_comes_back(sent in prop::collection::vec(any_datagram(), 0..8)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("take.pcapng");
        write(&path, &sent);
        prop_assert_eq!(read_file(&path), sent);
    }
}
