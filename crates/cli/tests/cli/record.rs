//! `posewire record`, and `posewire inspect` of what it wrote.

use crate::program::{assert_documented, assert_fits, objects, posewire};
use crate::refusals::assert_refused;
use crate::running::{Running, port};
use posewire::recording::Survey;
use std::fs;
use std::net::UdpSocket;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};
#[cfg(unix)]
use std::{process::Command, sync::mpsc};

/// `posewire record`, recording.
pub(crate) struct Recorder {
    pub(crate) port: u16,
    pub(crate) running: Running,
}

impl Recorder {
    /// Records whatever comes to a port of its own into a file.
    pub(crate) fn start(folder: &Path, file: &str, options: &[&str]) -> Self {
        let record = ["record", "mxtp://127.0.0.1:0", "-o", file];
        Self::of(Running::start(folder, &[&record, options].concat()), file)
    }

    /// Waits until it says where it listens and into which file it records.
    fn of(mut running: Running, file: &str) -> Self {
        let port = port(&running.line());
        assert_eq!(running.line(), format!("  into {file}\n"));
        Self { port, running }
    }
}

/// Sends numbers until something is true; gives when each was sent.
pub(crate) fn send_until(port: u16, length: usize, mut enough: impl FnMut(usize) -> bool) -> Vec<Instant> {
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    let begun = Instant::now();
    let mut sent = Vec::new();
    while !enough(sent.len()) {
        // A pace that a real stream has: to absolute deadlines.
        let due = begun + sent.len() as u32 * Duration::from_micros(500);
        thread::sleep(due.saturating_duration_since(Instant::now()));
        let mut bytes = (sent.len() as u64).to_le_bytes().to_vec();
        bytes.resize(length, 0);
        sent.push(Instant::now());
        // Nobody is there any more when the recorder has been killed.
        let _ = sender.send_to(&bytes, ("127.0.0.1", port));
    }
    sent
}

#[cfg(unix)]
#[test]
fn ctrl_c_finishes_a_recording_and_json_tells_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let recorder = Recorder::start(folder.path(), "take.mcap", &["--json"]);
    let begun = Instant::now();
    send_until(recorder.port, 100, |_| begun.elapsed() > Duration::from_millis(1300));
    recorder.running.interrupt();
    let ended = recorder.running.end();
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let told = objects(&ended.out, "recording");
    assert!(told.len() >= 2, "{}", ended.out);
    for object in &told {
        assert_documented(object, "recording", &[]);
    }
    let last = told.last().unwrap();
    assert_eq!((&last["ended"], &last["lost"]), (&true.into(), &0.into()));

    let seen = posewire(folder.path(), &["inspect", "take.mcap", "--json"], b"");
    let object = objects(&seen.out, "mcap").remove(0);
    assert_documented(&object, "mcap", &[]);
    assert_eq!(object["complete"], true);
    assert_eq!(object["sources"][0]["senders"][0]["datagrams"], last["datagrams"]);
    let text = posewire(folder.path(), &["inspect", "take.mcap"], b"");
    assert_fits(&text.out);
    assert!(text.out.contains("mxtp/udp"), "{}", text.out);
}

#[test]
fn a_recorder_that_is_killed_loses_no_more_than_a_quarter_of_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let mut latest = Duration::ZERO;
    for round in 0..20_u64 {
        // From a tenth to three quarters of a second, differently each time.
        let life = Duration::from_millis(100 + round * 7919 % 650);
        latest = latest.max(lost_when_killed(folder.path(), &round.to_string(), life));
    }
    assert!(latest <= A_QUARTER, "{latest:?} were lost");
    println!("at most {latest:?} were lost");
}

/// How much before it is killed the first datagram was sent that a recorder loses.
fn lost_when_killed(folder: &Path, name: &str, life: Duration) -> Duration {
    let (cut, whole) = (format!("cut-{name}.mcap"), format!("whole-{name}.mcap"));
    let recorder = Recorder::start(folder, &cut, &[]);
    let begun = Instant::now();
    let sent = send_until(recorder.port, 1200, |_| begun.elapsed() >= life);
    let killed = Instant::now();
    recorder.running.kill();

    let recovering = ["inspect", &cut, "--recover", "-o", &whole, "--json"];
    let seen = posewire(folder, &recovering, b"");
    assert_eq!(seen.code, Some(0), "{}", seen.err);
    assert!(Survey::of(&folder.join(&whole)).unwrap().complete);
    let object = objects(&seen.out, "mcap").remove(0);
    let found = object["sources"][0]["senders"][0]["datagrams"].as_u64().unwrap_or(0);
    let first_lost = sent.get(found as usize).copied().unwrap_or(killed);
    killed.saturating_duration_since(first_lost)
}

fn grouped(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", grouped(number / 1000), number % 1000),
    }
}

const A_QUARTER: Duration = Duration::from_millis(250);

/// A file size limit stands for a full disk: the system refuses to write beyond it.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_the_recording_loudly_and_what_was_written_stays() {
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_posewire");
    let limited = format!("trap '' XFSZ; ulimit -f 2000; exec '{program}' record mxtp://127.0.0.1:0 -o take.mcap");
    let running = Running::run(folder.path(), Command::new("sh").args(["-c", &limited]), b"");
    let mut recorder = Recorder::of(running, "take.mcap");
    let begun = Instant::now();
    send_until(recorder.port, 1200, |_| {
        assert!(begun.elapsed() < Duration::from_mins(1), "it goes on recording");
        recorder.running.has_ended()
    });
    let ended = recorder.running.end();
    assert_eq!(ended.code, Some(3), "{}", ended.err);
    assert!(ended.err.contains("could not be written"), "{}", ended.err);
    assert!(ended.err.contains("error: cannot write to take.mcap"), "{}", ended.err);

    let seen = posewire(folder.path(), &["inspect", "take.mcap", "--recover", "--json"], b"");
    assert_eq!(seen.code, Some(0), "{}", seen.err);
    let object = objects(&seen.out, "mcap").remove(0);
    let found = object["sources"][0]["senders"][0]["datagrams"].as_u64().unwrap();
    assert!(found > 50);
    let said = format!("recorded {} datagrams", grouped(found));
    assert!(ended.err.contains(&said), "{said}: {}", ended.err);
}

/// A pipe that nobody reads stands for a disk that is stuck.
#[cfg(unix)]
#[test]
fn a_slow_disk_makes_the_recorder_drop_loudly_and_what_was_written_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let (pipe, path) = (folder.path().join("pipe"), folder.path().join("take.mcap"));
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let (go_on, waiting) = mpsc::channel::<()>();
    let disk = thread::spawn({
        let path = path.clone();
        move || {
            let mut from = fs::File::open(pipe).unwrap();
            // Until the other end has gone.
            let _ = waiting.recv();
            std::io::copy(&mut from, &mut fs::File::create(path).unwrap()).unwrap()
        }
    });
    let mut recorder = Recorder::start(folder.path(), "pipe", &["--overwrite"]);
    let begun = Instant::now();
    send_until(recorder.port, 60_000, |_| {
        assert!(begun.elapsed() < Duration::from_mins(1), "it has not shouted");
        recorder.running.has_said("found no room in the queue")
    });
    recorder.running.interrupt();
    drop(go_on);
    let ended = recorder.running.end();
    assert_eq!(ended.code, Some(3));
    assert!(
        ended.err.lines().any(|line| line.starts_with("LOST")),
        "not said in the summary"
    );
    disk.join().unwrap();
    let survey = Survey::of(&path).unwrap();
    assert!(survey.complete);
    assert!(survey.datagrams() > 1000 && survey.lost.unwrap() > 0, "{survey:?}");
}

#[test]
fn what_cannot_be_recorded_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("there.mcap"), "precious").unwrap();
    for (arguments, code, error, help) in [
        (
            &["record", "mxtp://127.0.0.1:0", "-o", "there.mcap"][..],
            2,
            "there.mcap is there already",
            "--overwrite",
        ),
        (
            &["record", "take.mvnx", "-o", "new.mcap"],
            2,
            "expected a live stream to record",
            "posewire inspect take.mvnx",
        ),
        (
            &["record", "mxtp://127.0.0.1:0", "-o", "no/where.mcap"],
            1,
            "no/where.mcap",
            "help",
        ),
        (
            &["record", "mxtp://127.0.0.1:0", "-o", "new.pcapng"],
            2,
            "record writes MCAP files",
            "posewire convert new.mcap new.pcapng",
        ),
        (
            &["record", "mxtp://127.0.0.1:0", "-o", "there.mcap", "--remote", "0"],
            2,
            "expected a folder for the takes, found there.mcap",
            "each take is a file in it",
        ),
        (
            &["inspect", "there.mcap", "--recover"],
            2,
            "--recover is for recordings",
            "give a file that posewire record has written",
        ),
    ] {
        assert_refused(folder.path(), arguments, code, error, help);
    }
    assert_eq!(fs::read(folder.path().join("there.mcap")).unwrap(), b"precious");
}
