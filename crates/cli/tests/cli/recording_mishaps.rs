//! What can happen to a recording: its file is gone, taken or cut off, and nobody sends, or two send at once.

use crate::program::{objects, posewire};
use crate::record::{Recorder, send_until};
use crate::refusals::assert_refused;
use crate::replay::write_capture;
use posewire::recording::Survey;
use std::fs;
use std::net::UdpSocket;
use std::path::Path;
use std::time::{Duration, Instant};

/// Sends some datagrams.
fn send(port: u16) {
    send_until(port, 1000, |sent| sent >= 200);
}

/// Waits until a file has something in it.
fn wait_for(mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_mins(1));
        std::thread::yield_now();
    }
}

fn datagrams(path: &Path) -> u64 {
    Survey::of(path).map_or(0, |survey| survey.datagrams())
}

#[test]
fn a_file_that_is_being_recorded_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let recorder = Recorder::start(folder.path(), "take.mcap", &[]);
    send(recorder.port);
    wait_for(|| datagrams(&path) == 200);

    let seen = posewire(folder.path(), &["inspect", "take.mcap"], b"");
    assert!(seen.out.contains("no, it is being recorded"), "{}", seen.out);
    let refused: [&[&str]; 2] = [
        &["inspect", "take.mcap", "--recover"],
        &[
            "record",
            "mxtp://127.0.0.1:0",
            "-o",
            "take.mcap",
            "--overwrite",
            "--duration",
            "0.1",
        ],
    ];
    for arguments in refused {
        let ended = posewire(folder.path(), arguments, b"");
        assert_eq!(ended.code, Some(1), "{arguments:?}: {}", ended.err);
        assert!(
            ended.err.contains("error: take.mcap is being recorded"),
            "{}",
            ended.err
        );
    }
    let copied = posewire(
        folder.path(),
        &["inspect", "take.mcap", "--recover", "-o", "so-far.mcap"],
        b"",
    );
    assert_eq!(copied.code, Some(0), "{}", copied.err);

    send(recorder.port);
    recorder.running.interrupt();
    assert_eq!(recorder.running.end().code, Some(0));
    assert_eq!(datagrams(&path), 400);
}

#[test]
fn a_file_that_is_removed_while_it_is_recorded_is_shouted_about() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let recorder = Recorder::start(folder.path(), "take.mcap", &["--json"]);
    send(recorder.port);
    wait_for(|| datagrams(&path) == 200);
    fs::remove_file(&path).unwrap();
    let ended = recorder.running.end();
    assert_eq!(ended.code, Some(3), "{}", ended.err);
    assert!(
        ended
            .err
            .contains("error: take.mcap was removed or replaced while it was recorded"),
        "{}",
        ended.err
    );
    let last = objects(&ended.out, "recording").pop().unwrap();
    assert_eq!((&last["datagrams"], &last["unwritten"]), (&0.into(), &200.into()));
}

#[test]
fn a_file_that_is_moved_while_it_is_recorded_has_everything_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let (path, moved) = (folder.path().join("take.mcap"), folder.path().join("moved.mcap"));
    let recorder = Recorder::start(folder.path(), "take.mcap", &[]);
    send(recorder.port);
    wait_for(|| datagrams(&path) == 200);
    fs::rename(&path, &moved).unwrap();
    send(recorder.port);
    recorder.running.interrupt();
    let ended = recorder.running.end();
    assert_eq!(ended.code, Some(3), "{}", ended.err);
    assert!(
        ended.err.contains("take.mcap was MOVED while it was recorded"),
        "{}",
        ended.err
    );
    assert_eq!(datagrams(&moved), 400);
}

#[test]
fn who_sends_nothing_and_who_sends_the_same_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let silent = posewire(
        folder.path(),
        &["record", "mxtp://127.0.0.1:0", "-o", "none.mcap", "--duration", "0.2"],
        b"",
    );
    assert_eq!(silent.code, Some(0), "{}", silent.err);
    assert!(
        silent.err.contains("NOTHING CAME from mxtp://127.0.0.1:"),
        "{}",
        silent.err
    );

    let recorder = Recorder::start(folder.path(), "two.mcap", &["--json"]);
    let senders = [(); 2].map(|()| UdpSocket::bind("127.0.0.1:0").unwrap());
    let mut datagram = b"MXTP02\0\0\0\x01\x80\x17\0\0\0\0\x05\x17\0\0\0\0\0\0".to_vec();
    for sample in 0..6 {
        datagram[9] = sample;
        let sender = &senders[usize::from(sample % 2)];
        sender.send_to(&datagram, ("127.0.0.1", recorder.port)).unwrap();
    }
    wait_for(|| datagrams(&folder.path().join("two.mcap")) == 6);
    recorder.running.interrupt();
    let ended = recorder.running.end();
    let last = objects(&ended.out, "recording").pop().unwrap();
    let said = last["sources"][0]["two_senders"][0].as_str().unwrap();
    assert!(said.ends_with(" send character 5 at the same time."), "{said}");
}

#[test]
fn each_file_of_a_split_recording_that_was_killed_is_completed() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let recorder = Recorder::start(folder.path(), "take.mcap", &["--split-size", "1"]);
    send_until(recorder.port, 10_000, |_| datagrams(&at("take-003.mcap")) > 0);
    recorder.running.kill();

    let seen = posewire(folder.path(), &["inspect", "take.mcap"], b"");
    assert!(seen.out.contains("goes on in   take-002.mcap"), "{}", seen.out);
    let copied = posewire(
        folder.path(),
        &["inspect", "take.mcap", "--recover", "-o", "whole.mcap"],
        b"",
    );
    assert_eq!(copied.code, Some(0), "{}", copied.err);
    let seen = posewire(folder.path(), &["inspect", "take.mcap", "--recover", "--json"], b"");
    assert_eq!(seen.code, Some(0), "{}", seen.err);
    let object = objects(&seen.out, "mcap").remove(0);
    let later = object["later"].as_array().unwrap();
    assert!(
        later.len() >= 2 && later.iter().all(|file| file["complete"] == true),
        "{}",
        seen.out
    );
    for name in ["", "-002", "-003"] {
        let [taken, whole] = ["take", "whole"].map(|stem| at(&format!("{stem}{name}.mcap")));
        assert!(Survey::of(&taken).unwrap().complete && Survey::of(&whole).unwrap().complete);
        assert_eq!(datagrams(&taken), datagrams(&whole));
    }
}

#[test]
fn a_recording_is_not_recorded_onto_itself_and_damage_in_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.mcap");
    let recorder = Recorder::start(folder.path(), "take.mcap", &[]);
    send(recorder.port);
    wait_for(|| datagrams(&path) == 200);
    let length = fs::metadata(&path).unwrap().len();
    send(recorder.port);
    recorder.running.interrupt();
    assert_eq!(recorder.running.end().code, Some(0));

    let before = fs::read(&path).unwrap();
    let again = posewire(
        folder.path(),
        &["record", "take.mcap", "-o", "take.mcap", "--overwrite"],
        b"",
    );
    assert_eq!(again.code, Some(2), "{}", again.err);
    assert_eq!(fs::read(&path).unwrap(), before);
    fs::write(&path, &before[..length as usize]).unwrap();
    let damaged = posewire(folder.path(), &["record", "take.mcap", "-o", "again.mcap"], b"");
    assert_eq!(damaged.code, Some(3), "{}", damaged.err);
}

#[test]
fn the_folder_for_takes_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "record",
        "mxtp://127.0.0.1:0",
        "-o",
        "new/takes",
        "--remote",
        "0",
        "--duration",
        "0.1",
    ];
    let ended = posewire(folder.path(), &arguments, b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(folder.path().join("new/takes").is_dir());
}

#[test]
fn a_recording_of_poses_alone_is_converted_and_streamed() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| posewire(folder.path(), arguments, b"");
    let record = ["record", "synthetic:walk", "-o", "walk.mcap", "--duration", "0.3"];
    assert_eq!(run(&record).code, Some(0));

    let converted = run(&["convert", "walk.mcap", "walk.mvnx"]);
    assert_eq!(converted.code, Some(0), "{}", converted.err);
    assert!(
        converted.err.contains("playing the poses of walk.mcap"),
        "{}",
        converted.err
    );
    let target = UdpSocket::bind("127.0.0.1:0").unwrap();
    let url = format!("mxtp://{}", target.local_addr().unwrap());
    let streamed = run(&["stream", "walk.mcap", "--to", &url]);
    assert_eq!(streamed.code, Some(0), "{}", streamed.err);
    let mut datagram = [0; 2048];
    assert!(target.recv(&mut datagram).unwrap() > 24 && datagram.starts_with(b"MXTP"));

    let (error, help) = (
        "walk.mcap: expected datagrams, found poses alone",
        "posewire stream walk.mcap",
    );
    for arguments in [
        &["replay", "walk.mcap", "--to", &url][..],
        &["monitor", "walk.mcap"],
        &["doctor", "walk.mcap"],
        &["convert", "walk.mcap", "walk.pcapng"],
        &["convert", "walk.mcap", "other.mcap"],
    ] {
        assert_refused(folder.path(), arguments, 1, error, help);
    }
}

#[test]
fn a_recording_that_was_cut_off_becomes_takes_that_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let run = |arguments: &[&str]| posewire(folder.path(), arguments, b"");
    let record = ["record", "synthetic:walk", "-o", "poses.mcap", "--duration", "0.5"];
    assert_eq!(run(&record).code, Some(0));
    write_capture(&at("take.pcapng"), 400, 1);
    for (whole, cut) in [("poses.mcap", "cut.mcap"), ("take.pcapng", "cut.pcapng")] {
        let bytes = fs::read(at(whole)).unwrap();
        fs::write(at(cut), &bytes[..bytes.len() * 3 / 4]).unwrap();
        let told = run(&["convert", cut, "take.csv"]);
        assert_eq!(told.code, Some(3), "{}", told.err);
        assert!(
            told.err.contains(&format!("{cut}: the file is damaged: ")),
            "{}",
            told.err
        );
        assert!(told.err.contains("\n  damaged   "), "{}", told.err);
        let told = run(&["convert", cut, "take.csv", "--overwrite", "--json"]);
        assert_eq!(told.code, Some(3), "{}", told.err);
        let damage = &objects(&told.out, "converted")[0]["damage"];
        assert!(
            damage.as_str().is_some_and(|damage| told.err.contains(damage)),
            "{}",
            told.out
        );
        fs::remove_file(at("take.csv")).unwrap();
    }
}
