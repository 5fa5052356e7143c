//! How fast datagrams become frames, sample after sample.

use divan::Bencher;
use divan::counter::ItemsCount;
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Stamp, Subject};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
use posewire_mxtp::{Assembler, Event, Sequence};
use std::sync::Arc;

#[global_allocator]
static ALLOCATOR: divan::AllocProfiler = divan::AllocProfiler::system();

fn main() {
    divan::main();
}

/// Samples of one body, handled and polled for, the frames let go at once.
#[divan::bench(args = ["02", "02,20", "01,02,20"])]
fn datagrams(bencher: Bencher, types: &str) {
    stream(bencher, types, None);
}

/// The same with messages in parts of 300 bytes at most.
#[divan::bench]
fn datagrams_split(bencher: Bencher) {
    stream(bencher, "02", Some(300));
}

/// Sample numbers of an undisturbed stream.
#[divan::bench]
fn sequence(bencher: Bencher) {
    let mut sequence = Sequence::new();
    let mut sample = 0_u32;
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        for _ in 0..SAMPLES {
            sample = sample.wrapping_add(1);
            sequence.observe(sample, Stamp(i64::from(sample) * PERIOD));
        }
    });
}

fn stream(bencher: Bencher, types: &str, split: Option<usize>) {
    let mut sample: Vec<_> = encode(types, split).iter().map(<[u8]>::to_vec).collect();
    let mut assembler = Assembler::new();
    let mut number = 0_u32;
    let datagrams = SAMPLES * sample.len();
    bencher.counter(ItemsCount::new(datagrams)).bench_local(|| {
        let mut frames = 0;
        for _ in 0..SAMPLES {
            number = number.wrapping_add(1);
            for bytes in &mut sample {
                bytes[6..10].copy_from_slice(&number.to_be_bytes());
                assembler.handle(Stamp(i64::from(number) * PERIOD), bytes);
            }
            while let Some(event) = assembler.poll() {
                frames += usize::from(matches!(event, Event::Frame(_)));
            }
        }
        frames
    });
}

fn encode(types: &str, split: Option<usize>) -> Datagrams {
    let skeleton = Skeleton::standard(0, false);
    let mut frame = Frame::new(Arc::new(Subject::new("Ada", skeleton)));
    frame.position = vec![Some(DVec3::new(0.25, 0.5, 1.0)); 23];
    frame.orientation = vec![Some(DQuat::IDENTITY); 23];
    frame.joint_angles = vec![Some(DVec3::ZERO); 22];
    frame.ergonomic_angles = vec![Some(DVec3::ZERO); 6];
    let types = types.parse().unwrap_or_default();
    let options = EncoderOptions {
        types,
        split,
        ..EncoderOptions::default()
    };
    let mut datagrams = Datagrams::new();
    Encoder::new(options).encode_frame(&frame, &mut datagrams);
    datagrams
}

const SAMPLES: usize = 1000;
const PERIOD: i64 = 4_166_667;
