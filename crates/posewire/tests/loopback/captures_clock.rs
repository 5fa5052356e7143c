//! Captures whose clock was set, or whose stamps are damaged.

use crate::captures::{play, record_natnet, record_walk};
use crate::harness::PATIENCE;
use posewire::Datagram;
use posewire::capture::PcapWriter;
use posewire::source::PlaybackOptions;
use posewire_motion::{Frame, Stamp};
use std::path::Path;
use std::time::{Duration, Instant};

/// What a capture of these datagrams gives, read at once: subjects, samples, and what these have.
fn read_with_stamps(path: &Path, datagrams: &[Datagram], stamp: fn(usize, Stamp) -> Stamp) -> Vec<String> {
    let mut writer = PcapWriter::create(path, true).unwrap();
    for (place, datagram) in datagrams.iter().enumerate() {
        let received = stamp(place, datagram.received);
        let stamped = Datagram {
            received,
            ..datagram.clone()
        };
        writer.write(&stamped).unwrap();
    }
    writer.finish().unwrap();
    let options = PlaybackOptions {
        speed: PlaybackOptions::AT_ONCE,
        ..PlaybackOptions::default()
    };
    let played = play(path, &options);
    let frames = played.frames.iter();
    let mut frames: Vec<_> = frames
        .map(|frame| {
            let Frame {
                subject,
                sample,
                timecode,
                orientation,
                ..
            } = &**frame;
            format!("{} {sample:04} {timecode:?} {orientation:?}", subject.id)
        })
        .collect();
    frames.sort_unstable();
    frames
}

#[test]
fn what_the_clock_of_a_capture_does_takes_no_time_and_no_sample() {
    let folder = tempfile::tempdir().unwrap();
    let [walk, other] = ["walk.mcap", "other.pcapng"].map(|name| folder.path().join(name));
    let sent = [
        record_walk("mxtp://127.0.0.1:0", &walk),
        record_natnet(&folder.path().join("natnet.mcap"), 60),
    ];
    for datagrams in sent {
        let began = Instant::now();
        let read = |stamp: fn(usize, Stamp) -> Stamp| read_with_stamps(&other, &datagrams, stamp);
        let whole = read(|_, at| at);
        // That of a board without a battery is set when it finds a network.
        assert_eq!(
            read(|place, at| if place < 30 {
                Stamp(at.0 % 1_000_000_000_000)
            } else {
                at
            }),
            whole
        );
        // A bit has flipped in one stamp.
        assert_eq!(
            read(|place, at| if place == 20 { at.after(DAY * 4096) } else { at }),
            whole
        );
        assert!(began.elapsed() < PATIENCE);
    }
}

const DAY: Duration = Duration::from_hours(24);
