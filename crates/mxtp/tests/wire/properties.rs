//! What holds for any bytes and any chunks.

use posewire_mxtp::body::{Body, QuaternionSegment, ScaleBuffer, ScalePoint, Tracker};
use posewire_mxtp::ids::SegmentId;
use posewire_mxtp::{Datagram, DatagramCounter, Framer, Header, MessageType, explain};
use proptest::prelude::*;
use proptest::sample::{Index, select};

use crate::samples;

/// Decodes, and when that works encodes, reads and prints everything.
fn exercise(bytes: &[u8]) {
    let explanation = explain(bytes);
    let Ok(datagram) = Datagram::decode(bytes) else {
        assert!(explanation.error.is_some());
        return;
    };
    let mut out = Vec::new();
    datagram.encode(&mut out);
    assert_eq!(out, bytes);
    assert_eq!(
        datagram.body.size() + datagram.trailing.len() + Header::SIZE,
        bytes.len()
    );
    match datagram.body {
        Body::Scale(scale) => {
            assert_eq!(scale.segments().count(), scale.segment_count());
            assert_eq!(scale.points().count(), scale.point_count());
        }
        Body::Meta(meta) => assert!(meta.tags().count() <= bytes.len()),
        _ => {}
    }
    assert!(!datagram.to_string().is_empty());
}

/// All datagrams of a stream cut into chunks, and the bytes skipped.
fn framed(stream: &[u8], chunks: &[usize]) -> (Vec<Vec<u8>>, u64) {
    let mut framer = Framer::new();
    let mut found = Vec::new();
    let mut left = stream;
    let mut sizes = chunks.iter().copied().cycle();
    while !left.is_empty() {
        let (chunk, rest) = left.split_at(sizes.next().unwrap_or(1).clamp(1, left.len()));
        left = rest;
        framer.push(chunk);
        while let Some(bytes) = framer.next_datagram() {
            found.push(bytes.to_vec());
        }
        assert!(framer.buffered() <= Datagram::MAX_SIZE + 6);
    }
    framer.finish();
    while let Some(bytes) = framer.next_datagram() {
        found.push(bytes.to_vec());
    }
    (found, framer.skipped())
}

fn any_sample() -> impl Strategy<Value = Vec<u8>> {
    let samples: Vec<_> = samples::all().into_iter().map(|(_, bytes)| bytes).collect();
    select(samples)
}

/// A header with random fields and a type that is known more often than not.
fn any_header() -> impl Strategy<Value = Header> {
    (any::<[u8; 18]>(), 0..30_u8).prop_map(|(fields, number)| {
        let digits = MessageType::new(number).unwrap().to_string();
        let bytes = [b"MXTP", digits.as_bytes(), &fields].concat();
        Header::decode(&bytes).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_decode_or_fail(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        exercise(&bytes);
    }

    #[test]
    fn any_payload_decodes_or_fails(
        header in any_header(),
        payload in proptest::collection::vec(prop_oneof![Just(0), any::<u8>()], 0..1500),
    ) {
        exercise(&[&header.encode()[..], &payload].concat());
    }

    #[test]
    fn a_flipped_bit_decodes_or_fails(mut bytes in any_sample(), at: Index, bit in 0..8_u8) {
        let at = at.index(bytes.len());
        bytes[at] ^= 1 << bit;
        exercise(&bytes);
    }

    #[test]
    fn a_cut_datagram_decodes_or_fails(bytes in any_sample(), at: Index) {
        exercise(&bytes[..at.index(bytes.len())]);
    }

    #[test]
    fn headers_come_back(header in any_header()) {
        prop_assert_eq!(Header::decode(&header.encode()), Ok(header));
    }

    #[test]
    fn poses_come_back(
        header in any_header(),
        values in proptest::collection::vec(any::<(u32, [f32; 3], [f32; 4])>(), 0..=255),
    ) {
        let segments: Vec<_> = values
            .iter()
            .map(|(id, position, q)| QuaternionSegment::new(SegmentId(*id), *position, *q))
            .collect();
        let sent = Datagram::new(header, Body::Quaternion(&segments)).unwrap();
        let mut bytes = Vec::new();
        sent.encode(&mut bytes);
        let received = Datagram::decode(&bytes).unwrap();
        prop_assert_eq!((received.header, received.body), (sent.header, sent.body));
        for (segment, (id, position, q)) in segments.iter().zip(&values) {
            prop_assert_eq!(segment.id(), SegmentId(*id));
            prop_assert_eq!(segment.position().map(f32::to_bits), position.map(f32::to_bits));
            prop_assert_eq!(segment.orientation().map(f32::to_bits), q.map(f32::to_bits));
        }
    }

    #[test]
    fn trackers_come_back(count in 0..=255_usize, ids: [u32; 8], counter: u8) {
        let trackers: Vec<_> = (0..count)
            .map(|n| Tracker::new(SegmentId(ids[n % 8]), [1.0, 0.0, 0.0, 0.0]))
            .collect();
        let header = samples::old_header().with_counter(DatagramCounter(counter));
        let sent = Datagram::new(header, Body::Trackers(&trackers)).unwrap();
        let mut bytes = Vec::new();
        sent.encode(&mut bytes);
        prop_assert_eq!(Datagram::decode(&bytes).unwrap().body, sent.body);
    }

    #[test]
    fn scales_come_back(
        segments in proptest::collection::vec(("[ -~é]{0,12}", any::<[f32; 3]>()), 0..30),
        points in proptest::collection::vec((any::<u16>(), any::<u16>(), "[a-zé]{0,8}", any::<u32>()), 0..30),
    ) {
        let mut scale = ScaleBuffer::new();
        for (name, origin) in &segments {
            scale.push_segment(name, *origin);
        }
        for (segment, local, name, flags) in &points {
            scale.push_point(&ScalePoint {
                segment: *segment,
                local: *local,
                name: name.as_str().into(),
                flags: *flags,
                position: [0.0; 3],
            });
        }
        let sent = Datagram::new(samples::old_header(), Body::Scale(scale.as_scale())).unwrap();
        let mut bytes = Vec::new();
        sent.encode(&mut bytes);
        let received = Datagram::decode(&bytes).unwrap();
        prop_assert_eq!(received.body, sent.body);
        let Body::Scale(read) = received.body else { unreachable!("a scale datagram") };
        for (read, (name, origin)) in read.segments().zip(&segments) {
            prop_assert_eq!(read.name, name.as_str());
            prop_assert_eq!(read.origin.map(f32::to_bits), origin.map(f32::to_bits));
        }
        for (read, (segment, local, name, flags)) in read.points().zip(&points) {
            prop_assert_eq!((read.segment, read.local), (*segment, *local));
            prop_assert_eq!(read.name, name.as_str());
            prop_assert_eq!(read.flags, *flags);
        }
    }

    #[test]
    fn chunks_make_no_difference(
        parts in proptest::collection::vec(
            prop_oneof![
                4 => any_sample(),
                1 => proptest::collection::vec(any::<u8>(), 0..40),
                1 => Just(b"MXTP".to_vec()),
                1 => any_header().prop_map(|header| header.encode().to_vec()),
            ],
            0..12,
        ),
        chunks in proptest::collection::vec(1..900_usize, 1..20),
    ) {
        let stream = parts.concat();
        let whole = framed(&stream, &[stream.len()]);
        prop_assert_eq!(&framed(&stream, &chunks), &whole);
        prop_assert_eq!(&framed(&stream, &[1]), &whole);
        let held: usize = whole.0.iter().map(Vec::len).sum();
        prop_assert_eq!(held as u64 + whole.1, stream.len() as u64);
    }

    #[test]
    fn regular_streams_come_apart_into_their_datagrams(
        sent in proptest::collection::vec(any_sample().prop_filter("regular", |bytes| {
            Datagram::decode(bytes).is_ok_and(|d| usize::from(d.header.payload_size) == bytes.len() - 24)
        }), 0..12),
        chunks in proptest::collection::vec(1..900_usize, 1..20),
    ) {
        prop_assert_eq!(framed(&sent.concat(), &chunks), (sent, 0));
    }

    #[test]
    fn old_streams_come_apart_into_their_datagrams(
        sent in proptest::collection::vec(select(old_samples()), 0..12),
        chunks in proptest::collection::vec(1..900_usize, 1..20),
    ) {
        prop_assert_eq!(framed(&sent.concat(), &chunks), (sent, 0));
    }
}

/// Every Rev J sample but the trackers of 44 bytes, which Rev J does not have.
fn old_samples() -> Vec<Vec<u8>> {
    samples::all()
        .into_iter()
        .filter(|(name, _)| name.ends_with("_rev_j") && !name.contains("trackers_short"))
        .map(|(_, bytes)| bytes)
        .collect()
}
