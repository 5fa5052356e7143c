//! Reading MVNX in memory, beside counting the newlines of the same bytes.

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use posewire_mvnx::Reader;
use std::fmt::Write;
use std::path::Path;

fn main() {
    divan::main();
}

/// Every frame to canonical values.
#[divan::bench]
fn frames(bencher: Bencher<'_, '_>) {
    let text = take();
    bencher.counter(BytesCount::of_slice(&text)).bench(|| {
        let reader = Reader::new(black_box(text.as_slice())).expect("a valid head");
        reader
            .map(|frame| frame.expect("a valid frame").position.len())
            .sum::<usize>()
    });
}

/// The least that anything can do with the bytes.
#[divan::bench]
fn newlines(bencher: Bencher<'_, '_>) {
    let text = take();
    let counter = BytesCount::of_slice(&text);
    bencher
        .counter(counter)
        .bench(|| memchr::memchr_iter(b'\n', black_box(&text)).count());
}

/// The reference take with its frames repeated to about 30 MB, or a made-up take of that size.
fn take() -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mvnx/test_mocap.mvnx");
    let text = std::fs::read_to_string(path).unwrap_or_else(|_| made_up());
    let begin = text.find("<frame time=\"0\" index=\"0\"").expect("a first frame");
    let end = text.rfind("</frames>").expect("an end of frames");
    let times = (30 << 20) / (end - begin);
    let frames = text[begin..end].repeat(times);
    [&text[..begin], &frames, &text[end..]].concat().into_bytes()
}

/// A take of 23 segments with made-up numbers.
fn made_up() -> String {
    let segments: String = (0..23).fold(String::new(), |mut text, number| {
        let _ = write!(text, "<segment label=\"S{number}\"/>");
        text
    });
    let (mut quaternions, mut vectors) = (String::new(), String::new());
    for number in 0..23 {
        let _ = write!(quaternions, "0.5{number:05} -0.500000 0.500000 -0.500000 ");
        let _ = write!(vectors, "0.1{number:05} -1.234567 0.950000 ");
    }
    let sections = [
        "position",
        "velocity",
        "acceleration",
        "angularVelocity",
        "angularAcceleration",
    ];
    let vectors = sections.map(|name| format!("<{name}>{vectors}</{name}>\n")).concat();
    format!(
        "<mvnx version=\"4\">\n<subject label=\"S\" frameRate=\"60\">\n<segments>{segments}</segments>\n<frames>\n\
         <frame time=\"0\" index=\"0\" type=\"normal\">\n<orientation>{quaternions}</orientation>\n{vectors}</frame>\n\
         </frames>\n</subject>\n</mvnx>\n"
    )
}
