//! `posewire view`, and `--view` of other verbs.
#![cfg(feature = "viewer")]

use crate::program::posewire;
use crate::record::Recorder;
use crate::refusals::assert_refused;
use crate::running::Running;
use crate::takes::small_take;
use std::fs;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;

/// The program, serving its page.
struct Viewed {
    /// Where, as `127.0.0.1:9780`.
    address: String,
    #[cfg_attr(not(unix), expect(dead_code, reason = "it is there to end with the test"))]
    running: Running,
}

impl Viewed {
    /// Starts it with these arguments and waits until it says where the page is.
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut running = Running::start(folder, arguments);
        let said = running.read_until(|line| line.starts_with("open http://"));
        let line = said.lines().last().unwrap_or_default();
        let address = line.trim_start_matches("open http://").trim_end_matches('/');
        Self {
            address: address.to_owned(),
            running,
        }
    }

    /// The body of an answer.
    fn ask(&self, path: &str) -> Vec<u8> {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        let request = format!(
            "GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
            self.address
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        assert!(answer.starts_with(b"HTTP/1.1 200"), "{path}");
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        answer.split_off(end + 4)
    }

    /// The scene, once it has somebody.
    fn scene(&self) -> serde_json::Value {
        loop {
            let scene: serde_json::Value = serde_json::from_slice(&self.ask("/api/scene")).unwrap();
            if !scene["subjects"].as_array().unwrap().is_empty() {
                return scene;
            }
        }
    }
}

#[test]
fn what_is_live_is_shown_live() {
    let viewed = Viewed::start(
        Path::new("."),
        &["view", "synthetic:walk?people=2", "--listen", "127.0.0.1:0"],
    );
    let scene = viewed.scene();
    assert_eq!((&scene["mode"], &scene["recorder"]), (&"live".into(), &false.into()));
    assert!(
        scene["source"][0]
            .as_str()
            .unwrap()
            .starts_with("synthetic:walk?people=2")
    );
    assert!(viewed.ask("/").starts_with(b"<!doctype html>"));
    assert_eq!(viewed.ask("/healthz"), b"ok");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_well() {
    let viewed = Viewed::start(Path::new("."), &["view", "synthetic:walk", "--listen", "127.0.0.1:0"]);
    viewed.running.interrupt();
    assert_eq!(viewed.running.end().code, Some(0));
}

#[test]
fn files_are_takes_that_the_page_plays() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.mvnx"), small_take(30)).unwrap();
    let viewed = Viewed::start(folder.path(), &["view", "take.mvnx", "--listen", "127.0.0.1:0"]);
    let scene = viewed.scene();
    assert_eq!(
        (&scene["mode"], &scene["subjects"][0]["name"]),
        (&"takes".into(), &"Bea".into())
    );
    let take = &scene["takes"][0];
    assert_eq!(
        (&take["file"], &take["frames"], &take["rate_hz"]),
        (&"take.mvnx".into(), &30.into(), &60.0.into())
    );
    assert_eq!(
        viewed.ask("/api/takes/0/frames?from=0&count=30").len(),
        30 * (40 + 4 * (7 * 2 + 3))
    );
}

#[cfg(unix)]
#[test]
fn a_recording_has_a_take_for_each_performer() {
    let folder = tempfile::tempdir().unwrap();
    let recorder = Recorder::start(folder.path(), "two.mcap", &[]);
    let url = format!("mxtp://127.0.0.1:{}", recorder.port);
    let stream = ["stream", "synthetic:walk?people=2", "--to", &url, "--duration", "0.5"];
    assert_eq!(posewire(folder.path(), &stream, b"").code, Some(0));
    recorder.running.interrupt();
    assert_eq!(recorder.running.end().code, Some(0));

    let viewed = Viewed::start(folder.path(), &["view", "two.mcap", "--listen", "127.0.0.1:0"]);
    let scene = viewed.scene();
    let names: Vec<_> = scene["subjects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|subject| &subject["name"])
        .collect();
    assert_eq!(names, ["Ada", "Bram"]);
    let starts: Vec<_> = scene["takes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|take| take["start_s"].as_f64().unwrap())
        .collect();
    assert!(starts.iter().all(|start| (0.0..0.1).contains(start)), "{starts:?}");
}

#[test]
fn other_verbs_show_what_they_do() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        ["record", "synthetic:walk", "-o", "walk.mcap", "--view=127.0.0.1:0"].as_slice(),
        &[
            "stream",
            "synthetic:walk",
            "--to",
            "mxtp://127.0.0.1:9",
            "--view=127.0.0.1:0",
        ],
        &["demo", "--people", "3", "--json", "--view=127.0.0.1:0"],
    ] {
        let viewed = Viewed::start(folder.path(), arguments);
        let scene = viewed.scene();
        assert_eq!(
            (&scene["mode"], &scene["subjects"][0]["name"]),
            (&"live".into(), &"Ada".into()),
            "{arguments:?}"
        );
    }
}

#[test]
fn what_cannot_be_shown_is_refused_with_help() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.mvnx"), small_take(3)).unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    let beside = format!("--view={taken}");
    for (arguments, code, error, help) in [
        (
            ["view", "take.mvnx", "mxtp://127.0.0.1:0"].as_slice(),
            2,
            "found both",
            "view take.mvnx by itself",
        ),
        (
            &["view", "take.mvnx", "--record-dir", "."],
            2,
            "--record-dir is for live streams",
            "leave --record-dir out",
        ),
        (
            &["view", "synthetic:walk", "--record-dir", "no"],
            2,
            "expected a folder",
            "make the folder first",
        ),
        (&["view", "no.mvnx"], 1, "cannot read no.mvnx", "check the path"),
        (&["view", "take.bvh"], 2, "can be written, not read", "help: "),
        (
            &["view", "synthetic:walk", "--listen", &taken],
            1,
            "cannot serve the page on",
            "--listen 127.0.0.1:",
        ),
        (
            &["stream", "synthetic:walk", "--to", "mxtp://127.0.0.1", &beside],
            1,
            "cannot serve the page on",
            "as in --view=127.0.0.1:",
        ),
    ] {
        assert_refused(folder.path(), arguments, code, error, help);
    }
}
