//! Time and allocations between datagrams and canonical frames.

use divan::counter::ItemsCount;
use divan::{AllocProfiler, Bencher, black_box};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions, Filler, MessageTypes};
use posewire_mxtp::{Datagram, MessageType};
use std::sync::Arc;

#[global_allocator]
static ALLOCATIONS: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

/// The pose types, by their number.
const POSE_TYPES: [u8; 5] = [2, 1, 5, 21, 22];

/// A 23-segment datagram to a frame that is used again.
#[divan::bench(args = POSE_TYPES)]
fn datagram_to_frame(bencher: Bencher<'_, '_>, number: u8) {
    let sent = frame();
    let datagrams = encode(&sent, number);
    let bytes = datagrams.as_bytes();
    let mut received = Frame::new(sent.subject.clone());
    let mut receive = || {
        let datagram = Datagram::decode(black_box(bytes)).unwrap();
        received.clear();
        let quirks = Filler::new().fill(&mut received, &datagram.header, &datagram.body);
        assert!(quirks.is_empty());
        black_box(&received);
    };
    receive();
    bencher.counter(ItemsCount::new(1_u32)).bench_local(receive);
}

/// A frame to a 23-segment datagram in a buffer that is used again.
#[divan::bench(args = POSE_TYPES)]
fn frame_to_datagram(bencher: Bencher<'_, '_>, number: u8) {
    let (sent, mut encoder) = (frame(), Encoder::new(options(number)));
    let mut out = Datagrams::new();
    let mut send = || {
        out.clear();
        encoder.encode_frame(black_box(&sent), &mut out);
        black_box(&out);
    };
    send();
    bencher.counter(ItemsCount::new(1_u32)).bench_local(send);
}

fn options(number: u8) -> EncoderOptions {
    EncoderOptions {
        types: MessageType::new(number).into_iter().collect::<MessageTypes>(),
        ..EncoderOptions::default()
    }
}

fn encode(frame: &Frame, number: u8) -> Datagrams {
    let mut out = Datagrams::new();
    Encoder::new(options(number)).encode_frame(frame, &mut out);
    out
}

fn frame() -> Frame {
    let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
    let vector = |place: usize| Some(DVec3::new(place as f64, 0.5, 1.0));
    let vectors: Vec<_> = (0..23).map(vector).collect();
    frame.position.clone_from(&vectors);
    frame.velocity.clone_from(&vectors);
    frame.acceleration.clone_from(&vectors);
    frame.angular_velocity.clone_from(&vectors);
    frame.angular_acceleration = vectors;
    frame.orientation = vec![Some(DQuat::from_rotation_z(0.5)); 23];
    frame
}
