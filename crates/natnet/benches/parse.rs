//! Time and allocations of reading and writing frames.

use std::fs;
use std::path::Path;

use divan::counter::ItemsCount;
use divan::{AllocProfiler, Bencher, black_box};
use posewire_natnet::frame::{BodyParams, Frame, LabeledMarker, MarkerParams, MarkerSet, RigidBody};
use posewire_natnet::{MessageId, Packet, Version};

#[global_allocator]
static ALLOCATIONS: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

/// One body and six labeled markers of 3.0: a captured frame where there is one.
#[divan::bench]
fn read_small_frame(bencher: Bencher<'_, '_>) {
    read(bencher, Version::new(3, 0), &small());
}

/// 200 labeled markers in 3.0, nearly 8 kB.
#[divan::bench]
fn read_large_frame(bencher: Bencher<'_, '_>) {
    let version = Version::new(3, 0);
    read(bencher, version, &packet(&large(), version));
}

/// The same in 4.1, whose sections state their sizes.
#[divan::bench]
fn read_large_frame_4_1(bencher: Bencher<'_, '_>) {
    let version = Version::new(4, 1);
    read(bencher, version, &packet(&large(), version));
}

/// The small frame into a buffer that is used again.
#[divan::bench]
fn write_small_frame(bencher: Bencher<'_, '_>) {
    let bytes = small();
    let version = Version::new(3, 0);
    let payload = Packet::decode(&bytes).unwrap().payload;
    write(bencher, version, &Frame::decode(version, payload).unwrap().0);
}

/// The large frame into a buffer that is used again.
#[divan::bench]
fn write_large_frame(bencher: Bencher<'_, '_>) {
    write(bencher, Version::new(3, 0), &large());
}

fn read(bencher: Bencher<'_, '_>, version: Version, bytes: &[u8]) {
    let mut frame = Frame::default();
    bencher.counter(ItemsCount::new(1_u32)).bench_local(|| {
        let packet = Packet::decode(black_box(bytes)).unwrap();
        let quirks = frame.decode_into(version, packet.payload).unwrap();
        assert!(quirks.is_empty() && packet.quirks.is_empty());
        black_box(&frame);
    });
}

fn write(bencher: Bencher<'_, '_>, version: Version, frame: &Frame) {
    let mut out = Vec::with_capacity(Packet::MAX_PAYLOAD + Packet::HEADER_SIZE);
    bencher.counter(ItemsCount::new(1_u32)).bench_local(|| {
        out.clear();
        Packet::encode(MessageId::FRAME, &mut out, |out| black_box(frame).encode(version, out)).unwrap();
        black_box(&out);
    });
}

fn small() -> Vec<u8> {
    let captured = "../../../shared/data/natnet/mocapframe_packet_v3.bin";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(captured);
    fs::read(path).unwrap_or_else(|_| packet(&frame(5, 1, 6), Version::new(3, 0)))
}

fn large() -> Frame {
    let mut frame = frame(0, 1, 200);
    let markers: Vec<_> = frame.labeled_markers.iter().map(|marker| marker.position).collect();
    let name = "all".into();
    frame.marker_sets = vec![MarkerSet { name, markers }];
    frame
}

fn frame(others: i32, bodies: i32, labeled: i32) -> Frame {
    Frame {
        other_markers: (0..others).map(position).collect(),
        rigid_bodies: (0..bodies).map(body).collect(),
        labeled_markers: (0..labeled).map(marker).collect(),
        ..Frame::default()
    }
}

fn position(n: i32) -> [f32; 3] {
    [n as f32, 0.5, 1.0]
}

fn body(id: i32) -> RigidBody {
    RigidBody {
        id,
        position: position(id),
        orientation: [0.0, 0.0, 0.0, 1.0],
        params: Some(BodyParams::TRACKED),
        ..RigidBody::default()
    }
}

fn marker(id: i32) -> LabeledMarker {
    LabeledMarker {
        id,
        position: position(id),
        size: 0.014,
        params: Some(MarkerParams::POINT_CLOUD_SOLVED),
        residual: Some(0.0002),
    }
}

fn packet(frame: &Frame, version: Version) -> Vec<u8> {
    let mut bytes = Vec::new();
    Packet::encode(MessageId::FRAME, &mut bytes, |out| frame.encode(version, out)).unwrap();
    bytes
}
