//! Writing MVNX to memory, beside formatting the same numbers with the standard library.

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use posewire_motion::kinematics::complete;
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
use posewire_mvnx::{Document, Reader, Remainder, Version, Writer, rewrite};
use std::io::Write;
use std::sync::Arc;

fn main() {
    divan::main();
}

/// Frames with attributes that follow from their times.
#[divan::bench]
fn frames(bencher: Bencher<'_, '_>) {
    let take = Take::new();
    let frames = || take.frames.iter().map(|(frame, _)| frame);
    bencher.counter(BytesCount::new(take.bytes)).bench(|| {
        let mut writer = Writer::new(Vec::with_capacity(2 * take.bytes), &take.document, Version::V4).expect("memory");
        for frame in frames() {
            writer.write(black_box(frame)).expect("memory");
        }
        writer.finish(&take.document).expect("memory").0.len()
    });
}

/// Frames with their attributes and order as they were read.
#[divan::bench]
fn whole_frames(bencher: Bencher<'_, '_>) {
    let take = Take::new();
    bencher.counter(BytesCount::new(take.bytes)).bench(|| {
        let mut writer = Writer::new(Vec::with_capacity(2 * take.bytes), &take.document, Version::V4).expect("memory");
        for (frame, remainder) in &take.frames {
            writer.write_whole(black_box(frame), remainder).expect("memory");
        }
        writer.finish(&take.document).expect("memory").0.len()
    });
}

/// From file to file: reading and writing.
#[divan::bench]
fn read_and_write(bencher: Bencher<'_, '_>) {
    let take = Take::new();
    let text = take.text();
    bencher.counter(BytesCount::of_slice(&text)).bench(|| {
        let mut reader = Reader::new(black_box(text.as_slice())).expect("a valid head");
        let mut to = Vec::with_capacity(2 * text.len());
        rewrite(&mut reader, Version::V4, &mut to).expect("memory");
        to.len()
    });
}

/// As many numbers with six decimals as the frames hold, by `write!`.
#[divan::bench]
fn standard_library(bencher: Bencher<'_, '_>) {
    let text = String::from_utf8(Take::new().text()).expect("text");
    let lines = text
        .lines()
        .filter(|line| line.contains(' ') && line.ends_with('>') && !line.contains('='));
    let words = lines.flat_map(|line| line.split(['>', '<', ' ']));
    let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
    let mut to = Vec::with_capacity(text.len());
    let mut write = || {
        to.clear();
        for number in black_box(&numbers) {
            write!(to, "{number:.6} ").expect("memory");
        }
        to.len()
    };
    let bytes = write();
    bencher.counter(BytesCount::new(bytes)).bench_local(write);
}

/// Frames that were read, and how many bytes they are.
struct Take {
    document: Document,
    frames: Vec<(Frame, Remainder)>,
    bytes: usize,
}

impl Take {
    /// A made-up take of 1,000 frames with everything that follows from poses.
    fn new() -> Self {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let document = Document::describe(&subject, 240.0, Version::V4).expect("a skeleton");
        let mut writer = Writer::new(Vec::new(), &document, Version::V4).expect("memory");
        for sample in 0..1000 {
            writer.write(&frame(&subject, sample)).expect("memory");
        }
        let (text, _) = writer.finish(&document).expect("memory");
        let mut reader = Reader::new(text.as_slice()).expect("a valid head");
        let mut frames = Vec::new();
        let mut remainder = Remainder::default();
        while let Some(frame) = reader.read_whole(&mut remainder) {
            frames.push((frame.expect("a valid frame"), remainder.clone()));
        }
        Self {
            document: reader.document(),
            frames,
            bytes: text.len(),
        }
    }

    fn text(&self) -> Vec<u8> {
        let mut writer = Writer::new(Vec::new(), &self.document, Version::V4).expect("memory");
        for (frame, remainder) in &self.frames {
            writer.write_whole(frame, remainder).expect("memory");
        }
        writer.finish(&self.document).expect("memory").0
    }
}

/// A subject who turns and waves.
fn frame(subject: &Arc<Subject>, sample: u32) -> Frame {
    let mut frame = Frame::new(Arc::clone(subject));
    frame.sample = sample;
    let angle = f64::from(sample) / 100.0;
    for (segment, part) in subject.skeleton.segments.iter().zip(0_u32..) {
        let lean = 0.1 * (angle + f64::from(part)).sin();
        let turn = DQuat::from_rotation_z(angle) * DQuat::from_rotation_x(lean);
        let origin = segment.origin.unwrap_or_default();
        frame.orientation.push(Some(turn));
        frame.position.push(Some(turn * origin));
        frame.velocity.push(Some(DVec3::new(lean, 0.3 * angle.cos(), 0.0)));
        frame
            .acceleration
            .push(Some(DVec3::new(-lean, 0.3 * angle.sin(), 0.01 * lean)));
        frame.angular_velocity.push(Some(DVec3::new(lean, lean, 0.5)));
    }
    complete(&mut frame);
    frame
}
