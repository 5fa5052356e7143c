//! Packets captured from MVN, where they are at hand.

use crate::frames::{encode, options, receive, subject};
use posewire_motion::{Skeleton, Subject};
use posewire_mxtp::body::Body;
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use posewire_mxtp::{Datagram, MessageType, Quirks};
use std::path::Path;

fn reference(name: &str) -> Option<Vec<u8>> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mxtp");
    let bytes = std::fs::read(data.join(name)).ok();
    if bytes.is_none() {
        println!("skipped: reference data not here");
    }
    bytes
}

#[test]
fn a_captured_pose_is_encoded_to_its_own_bytes() {
    let Some(bytes) = reference("mxtp02.bin") else {
        return;
    };
    let (frame, quirks) = receive(&subject(0, false), [&bytes[..]]);
    assert_eq!(quirks, Quirks::NONE);
    assert_eq!((frame.sample, frame.time.as_millis()), (6681, 27_837));
    for orientation in frame.orientation.iter().flatten() {
        assert!((orientation.length() - 1.0).abs() < 1e-7);
    }
    let datagrams = encode(options(&[MessageType::QUATERNION]), &frame);
    assert!(datagrams.iter().eq([&bytes[..]]));
}

#[test]
fn captured_meta_data_is_encoded_to_its_own_bytes() {
    let Some(bytes) = reference("mxtp12.bin") else {
        return;
    };
    let Body::Meta(meta) = Datagram::decode(&bytes).unwrap().body else {
        panic!("not meta data")
    };
    let mut captured = Subject::new(meta.name().unwrap().to_string(), Skeleton::standard(0, false));
    captured.color = meta.color().map(posewire_motion::Color);
    let options = EncoderOptions {
        characters: meta.count().unwrap(),
        time_offset_ms: meta.time_offset_ms().unwrap() as i32,
        ..options(&[MessageType::META])
    };
    let mut datagrams = Datagrams::new();
    Encoder::new(options).encode_subject(&captured, &mut datagrams);
    assert!(datagrams.iter().eq([&bytes[..]]));
}
