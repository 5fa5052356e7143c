//! Captured datagrams of a live MVN, where they are at hand.

use std::fs;
use std::path::Path;

use posewire_mxtp::body::Body;
use posewire_mxtp::{Datagram, DatagramCounter, Quirks, Revision};

fn captured(name: &str) -> Option<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mxtp");
    let bytes = fs::read(path.join(name)).ok();
    if bytes.is_none() {
        println!("skipped: reference data not here");
    }
    bytes
}

fn encoded(datagram: &Datagram<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    datagram.encode(&mut bytes);
    bytes
}

#[test]
fn a_captured_pose_decodes_and_encodes_back() {
    let Some(bytes) = captured("mxtp02.bin") else {
        return;
    };
    let datagram = Datagram::decode(&bytes).unwrap();
    let header = datagram.header;
    assert_eq!((header.sample, header.time_ms), (6681, 27_837));
    assert_eq!((header.items, header.payload_size), (23, 736));
    assert_eq!((header.character, header.body_segments), (0, 23));
    assert_eq!(header.counter, DatagramCounter::SINGLE);
    assert_eq!(header.revision(), Revision::N);
    assert_eq!(datagram.quirks, Quirks::NONE);
    let Body::Quaternion(segments) = datagram.body else {
        panic!("not a quaternion pose: {datagram}");
    };
    for segment in segments {
        let norm: f32 = segment.orientation().iter().map(|q| q * q).sum();
        assert!((norm - 1.0).abs() < 1e-6, "segment {}", segment.id());
    }
    assert_eq!(encoded(&datagram), bytes);
    let rebuilt = Datagram::new(header, datagram.body).unwrap();
    assert_eq!(encoded(&rebuilt), bytes);
}

#[test]
fn captured_meta_data_decodes_and_encodes_back() {
    let Some(bytes) = captured("mxtp12.bin") else {
        return;
    };
    let datagram = Datagram::decode(&bytes).unwrap();
    assert_eq!((datagram.header.sample, datagram.header.time_ms), (0, 0));
    assert_eq!(datagram.quirks, Quirks::NONE);
    let Body::Meta(meta) = datagram.body else {
        panic!("not meta data: {datagram}");
    };
    assert_eq!(meta.tags().count(), 4);
    assert_eq!(meta.color(), Some([0xE9, 0x64, 0x17]));
    assert_eq!(meta.count(), Some(1));
    assert_eq!(meta.name().unwrap(), "Factory");
    assert_eq!(meta.time_offset_ms(), Some(-3_600_000));
    assert_eq!(encoded(&datagram), bytes);
}
