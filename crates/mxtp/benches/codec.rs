//! Time and allocations of decoding and encoding a 760-byte pose.

use divan::counter::ItemsCount;
use divan::{AllocProfiler, Bencher, black_box};
use posewire_mxtp::body::{Body, QuaternionSegment};
use posewire_mxtp::ids::{SegmentCounts, SegmentId};
use posewire_mxtp::{Datagram, Framer, Header, MessageType};

#[global_allocator]
static ALLOCATIONS: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

/// Checked typed records with the sum of all 23 x 7 floats.
#[divan::bench]
fn decode_quaternion_pose(bencher: Bencher<'_, '_>) {
    let bytes = pose();
    bencher.counter(ItemsCount::new(1_u32)).bench(|| {
        let datagram = Datagram::decode(black_box(&bytes)).unwrap();
        assert!(datagram.quirks.is_empty());
        black_box(sum(&datagram))
    });
}

/// Checked typed records without reading them.
#[divan::bench]
fn check_quaternion_pose(bencher: Bencher<'_, '_>) {
    let bytes = pose();
    bencher
        .counter(ItemsCount::new(1_u32))
        .bench(|| black_box(Datagram::decode(black_box(&bytes)).is_ok()));
}

/// 23 records from 23 x 7 floats, then the datagram into a buffer that is used again.
#[divan::bench]
fn encode_quaternion_pose(bencher: Bencher<'_, '_>) {
    let values: Vec<([f32; 3], [f32; 4])> = (0..23).map(|n| ([n as f32, 0.5, 1.0], [1.0, 0.0, 0.0, 0.0])).collect();
    let mut segments = [QuaternionSegment::new(SegmentId(0), [0.0; 3], [0.0; 4]); 23];
    let mut out = Vec::with_capacity(Datagram::MAX_SIZE);
    bencher.counter(ItemsCount::new(1_u32)).bench_local(|| {
        for (n, (segment, (position, orientation))) in segments.iter_mut().zip(black_box(&values)).enumerate() {
            *segment = QuaternionSegment::new(SegmentId(n as u32 + 1), *position, *orientation);
        }
        out.clear();
        encode(&segments, &mut out);
        black_box(&out);
    });
}

/// The datagram from records that are there already.
#[divan::bench]
fn encode_quaternion_records(bencher: Bencher<'_, '_>) {
    let bytes = pose();
    let Body::Quaternion(segments) = Datagram::decode(&bytes).unwrap().body else {
        unreachable!("a type 02 datagram")
    };
    let mut out = Vec::with_capacity(Datagram::MAX_SIZE);
    bencher.counter(ItemsCount::new(1_u32)).bench_local(|| {
        out.clear();
        encode(black_box(segments), &mut out);
        black_box(&out);
    });
}

/// One datagram through the TCP framer.
#[divan::bench]
fn frame_quaternion_pose(bencher: Bencher<'_, '_>) {
    let bytes = pose();
    let mut framer = Framer::new();
    bencher.counter(ItemsCount::new(1_u32)).bench_local(|| {
        framer.push(black_box(&bytes));
        black_box(framer.next_datagram().map(<[u8]>::len))
    });
}

fn pose() -> Vec<u8> {
    let segments: Vec<_> = (1..=23)
        .map(|id| {
            let position = [id as f32 / 16.0, 0.25, 1.0];
            QuaternionSegment::new(SegmentId(id), position, [1.0, 0.0, 0.0, 0.0])
        })
        .collect();
    let mut bytes = Vec::new();
    encode(&segments, &mut bytes);
    assert_eq!(bytes.len(), 760);
    bytes
}

fn encode(segments: &[QuaternionSegment], out: &mut Vec<u8>) {
    let header = Header::rev_n(MessageType::QUATERNION, 6681, 27_837, SegmentCounts::BODY);
    Datagram::new(header, Body::Quaternion(segments)).unwrap().encode(out);
}

/// Sum of every value, one column each, so that the additions do not wait for each other.
fn sum(datagram: &Datagram<'_>) -> f32 {
    let Body::Quaternion(segments) = datagram.body else {
        return 0.0;
    };
    let mut columns = [0.0_f32; 7];
    for segment in segments {
        let [x, y, z] = segment.position();
        let [w, i, j, k] = segment.orientation();
        for (column, value) in columns.iter_mut().zip([x, y, z, w, i, j, k]) {
            *column += value;
        }
    }
    columns.iter().sum()
}
