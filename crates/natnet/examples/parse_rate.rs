//! How many frames a second one core reads, and what it read. The script `bench/natnet` runs it.
//!
//! ```text
//! parse_rate write VERSION FILE             writes a frame of 200 labeled markers
//! parse_rate reuse VERSION FILE SECONDS     reads FILE again and again over one frame
//! parse_rate fresh VERSION FILE SECONDS     reads FILE again and again, a new frame each time
//! ```
//!
//! The last two print one JSON object: `frames_per_second`, and what the frame holds in the order of
//! the packet, positions in metres as on the wire, `timestamp` in seconds.

use std::env;
use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::time::{Duration, Instant};

use posewire_natnet::frame::{BodyParams, Frame, FrameParams, LabeledMarker, MarkerParams, MarkerSet, RigidBody};
use posewire_natnet::{Message, Packet, Version};
use serde_json::{Value, json};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["write", version, file] => write(version.parse()?, file),
        [how @ ("reuse" | "fresh"), version, file, seconds] => {
            let (version, bytes) = (version.parse()?, fs::read(file)?);
            let duration = Duration::try_from_secs_f64(seconds.parse()?)?;
            let mut report = content(&read(version, &bytes)?);
            report["frames_per_second"] = match how {
                "reuse" => reuse(version, &bytes, duration)?.into(),
                _ => fresh(version, &bytes, duration)?.into(),
            };
            println!("{report}");
            Ok(())
        }
        _ => Err("expected: write VERSION FILE, or reuse|fresh VERSION FILE SECONDS".into()),
    }
}

fn write(version: Version, file: &str) -> Result<()> {
    let mut bytes = Vec::new();
    Message::Frame(large().into()).encode(version, &mut bytes)?;
    Ok(fs::write(file, bytes)?)
}

fn read(version: Version, bytes: &[u8]) -> Result<Frame> {
    match Message::decode(version, bytes)? {
        (Message::Frame(frame), quirks) if quirks.is_empty() => Ok(*frame),
        (message, _) => Err(format!("expected a usual frame, found {message}").into()),
    }
}

fn content(frame: &Frame) -> Value {
    let sets = frame.marker_sets.iter();
    let bodies = frame.rigid_bodies.iter();
    let labeled = frame.labeled_markers.iter();
    json!({
        "number": frame.number,
        "marker_sets": sets.map(|set| json!([set.name.to_string(), set.markers])).collect::<Vec<_>>(),
        "other_markers": frame.other_markers,
        "rigid_bodies": bodies.map(|body| json!([body.id, body.position, body.orientation])).collect::<Vec<_>>(),
        "labeled_markers": labeled.map(|marker| json!([marker.id, marker.position])).collect::<Vec<_>>(),
        "timestamp": frame.timestamp,
    })
}

fn reuse(version: Version, bytes: &[u8], duration: Duration) -> Result<f64> {
    let mut frame = Frame::default();
    rate(duration, || {
        let packet = Packet::decode(black_box(bytes))?;
        frame.decode_into(version, packet.payload)?;
        black_box(&frame);
        Ok(())
    })
}

fn fresh(version: Version, bytes: &[u8], duration: Duration) -> Result<f64> {
    rate(duration, || {
        let packet = Packet::decode(black_box(bytes))?;
        black_box(Frame::decode(version, packet.payload)?);
        Ok(())
    })
}

/// Frames a second, after a tenth of the time that does not count.
fn rate(duration: Duration, mut one: impl FnMut() -> Result<()>) -> Result<f64> {
    repeat(duration / 10, &mut one)?;
    repeat(duration, &mut one)
}

fn repeat(duration: Duration, one: &mut impl FnMut() -> Result<()>) -> Result<f64> {
    let start = Instant::now();
    let mut frames = 0_u64;
    loop {
        for _ in 0..BATCH {
            one()?;
        }
        frames += BATCH;
        let elapsed = start.elapsed();
        if elapsed >= duration {
            return Ok(frames as f64 / elapsed.as_secs_f64());
        }
    }
}

/// Reads between two looks at the clock.
const BATCH: u64 = 64;

/// One body and 200 labeled markers, which the set `all` has too, as Motive does: nearly 8 kB.
fn large() -> Frame {
    let labeled_markers: Vec<_> = (0..200).map(marker).collect();
    let markers = labeled_markers.iter().map(|marker| marker.position).collect();
    Frame {
        number: 4242,
        marker_sets: vec![MarkerSet {
            name: "all".into(),
            markers,
        }],
        rigid_bodies: vec![body()],
        labeled_markers,
        timestamp: Some(775.25),
        params: Some(FrameParams::default()),
        ..Frame::default()
    }
}

fn body() -> RigidBody {
    RigidBody {
        id: 1,
        position: [0.1, 1.5, -0.25],
        orientation: [0.5, 0.5, -0.5, 0.5],
        mean_error: Some(0.0002),
        params: Some(BodyParams::TRACKED),
        ..RigidBody::default()
    }
}

fn marker(n: i32) -> LabeledMarker {
    LabeledMarker {
        id: (1 << 16) | n,
        position: [n as f32 * 0.01, 1.0 + n as f32 * 0.003, -0.7],
        size: 0.014,
        params: Some(MarkerParams::POINT_CLOUD_SOLVED),
        residual: Some(0.0002),
    }
}
