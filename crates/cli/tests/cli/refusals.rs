//! What cannot be done is said in one `error:` line and one `help:` line.

use crate::program::posewire;
use crate::takes::small_take;
use std::fs;
use std::net::{TcpListener, UdpSocket};
use std::path::Path;

/// Asserts that it failed with this code, printed nothing, and said these words in its one error and its one help.
pub(crate) fn assert_refused(folder: &Path, arguments: &[&str], code: i32, error: &str, help: &str) {
    let ended = posewire(folder, arguments, b"");
    assert_eq!(ended.code, Some(code), "{arguments:?}: {}", ended.err);
    assert_eq!(ended.out, "", "{arguments:?}");
    let lines: Vec<_> = ended
        .err
        .lines()
        .filter(|line| line.starts_with("error: ") || line.starts_with("help: "))
        .collect();
    let &[first, second] = lines.as_slice() else {
        panic!("{arguments:?}: {}", ended.err)
    };
    assert!(first.contains(error), "{arguments:?}: {first}");
    assert!(second.contains(help), "{arguments:?}: {second}");
}

#[test]
fn wrong_arguments_end_with_2() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.mvn"), [0, 1, 2]).unwrap();
    let walk = "synthetic:walk?people=1";
    for (arguments, error, help) in [
        (&["monitor", "nowhere://x"][..], "unknown scheme \"nowhere\"", "mxtp"),
        (
            &["stream"],
            "required arguments were not provided",
            "--help after a verb",
        ),
        (&["stream", walk, "--split", "5"], "100..=65507", "--help"),
        (&["monitor", "--count", "0"], "--count", "--help"),
        (&["monitor", "mxtp://127.0.0.1:99999"], "99999", "HOST:PORT"),
        (&["stream", "take.mvn"], "proprietary", "export it as MVNX"),
        (&["inspect", "take.mvn"], "proprietary", "export it as MVNX"),
        (&["stream", "synthetic:walk?people=65"], "from 1 to 64", "people"),
        (&["stream", walk, "--rate", "500"], "at most 240 Hz", "--rate"),
        (&["stream", walk, "--speed", "0"], "above 0", "real time"),
        (&["stream", walk, "--speed", "-1"], "above 0", "real time"),
        (
            &["stream", "synthetic:walk?people=3", "--character", "254"],
            "from 0 to 255, found 256",
            "--character",
        ),
        (&["monitor", walk], "expected a live stream", "posewire demo"),
        (
            &["monitor", "take.mvnx"],
            "expected a live stream",
            "posewire inspect take.mvnx",
        ),
        (&["stream", "mxtp://127.0.0.1:9763"], "would be sent to itself", "--to"),
        (
            &["stream", "mxtp://127.0.0.1:0", "--rate", "60"],
            "--rate is for takes",
            "leave --rate out",
        ),
        (
            &["stream", "mxtp+tcp://127.0.0.1:0", "--loop"],
            "--loop is for takes",
            "leave --loop out",
        ),
        (&["stream", walk, "--types", "02,99"], "\"02,99\"", "01,02,03"),
        (
            &["stream", "natnet://127.0.0.1:1", "--to", "natnet://127.0.0.1:1"],
            "would be sent to itself",
            "--to",
        ),
        (
            &["stream", walk, "--to", "natnet://127.0.0.1?ttl=2"],
            "unknown option \"ttl\"",
            "data-port",
        ),
        (
            &["stream", walk, "--to", "natnet://127.0.0.1?version=9.0"],
            "\"9.0\"",
            "version",
        ),
        (
            &["stream", walk, "--to", "natnet://127.0.0.1:0", "--split", "1400"],
            "--split is for MXTP targets",
            "leave --split out",
        ),
        (
            &["stream", walk, "--to", "natnet://127.0.0.1:0", "--types", "all"],
            "--types is for MXTP targets",
            "leave --types out",
        ),
        (
            &[
                "stream",
                walk,
                "--to",
                "natnet://127.0.0.1:0?mode=multicast",
                "--silence",
                "5",
            ],
            "--silence is for unicast NatNet targets",
            "leave --silence out",
        ),
        (
            &["stream", walk, "--to", "other.mvnx"],
            "motion cannot be sent there",
            "--to mxtp://",
        ),
    ] {
        assert_refused(folder.path(), arguments, 2, error, help);
    }
}

#[test]
fn a_take_without_frames_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("empty.mvnx"), small_take(0)).unwrap();
    assert_refused(
        folder.path(),
        &["stream", "empty.mvnx"],
        1,
        "empty.mvnx: expected frames, found none",
        "inspect",
    );
}

#[test]
fn a_missing_file_ends_with_1() {
    let folder = tempfile::tempdir().unwrap();
    for verb in ["stream", "inspect", "explain"] {
        assert_refused(
            folder.path(),
            &[verb, "none.mvnx"],
            1,
            "cannot read none.mvnx: no such file",
            "path",
        );
    }
}

#[test]
fn a_port_in_use_is_named() {
    let (udp, tcp) = (
        UdpSocket::bind("127.0.0.1:0").unwrap(),
        TcpListener::bind("127.0.0.1:0").unwrap(),
    );
    for (scheme, address) in [
        ("mxtp", udp.local_addr().unwrap()),
        ("mxtp+tcp", tcp.local_addr().unwrap()),
    ] {
        let url = format!("{scheme}://{address}");
        assert_refused(
            Path::new("."),
            &["monitor", &url],
            1,
            &address.to_string(),
            "another program listens",
        );
    }
}

#[test]
fn a_natnet_port_in_use_is_named_with_the_way_to_another() {
    let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    for (url, help) in [
        (format!("natnet://127.0.0.1:{port}?data-port=0"), "natnet://HOST:1520"),
        (format!("natnet://127.0.0.1:0?data-port={port}"), "data-port=1521"),
    ] {
        let arguments = ["stream", "synthetic:walk", "--to", &url];
        assert_refused(Path::new("."), &arguments, 1, &port.to_string(), help);
    }
}

#[test]
fn a_peer_that_is_not_there_is_named() {
    let free = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let url = format!("mxtp+tcp://{free}");
    assert_refused(
        Path::new("."),
        &["stream", "synthetic:walk", "--to", &url],
        1,
        &free.to_string(),
        "nothing listens",
    );
}

#[test]
fn what_is_no_recording_is_not_recovered_and_what_is_wrong_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("empty.mcap"), "").unwrap();
    fs::write(path("garbage.mcap"), "not at all").unwrap();
    fs::write(path("take.mvnx"), small_take(2)).unwrap();
    for (file, code, error, help) in [
        ("nope.mcap", 1, "cannot read nope.mcap: no such file", "check the path"),
        ("empty.mcap", 2, "empty.mcap is empty", "posewire record"),
        ("garbage.mcap", 2, "it begins with \"not at a\"", "posewire record"),
        ("take.mvnx", 2, "--recover is for recordings", "--salvage"),
    ] {
        assert_refused(folder.path(), &["inspect", file, "--recover"], code, error, help);
    }
    let options = posewire::recording::WriterOptions::default();
    let names = ["mxtp://0.0.0.0:9763".to_owned()];
    let writer = posewire::recording::Writer::create(&path("take.mcap"), &names, options).unwrap();
    writer.finish().unwrap();
    let arguments = ["inspect", "take.mcap", "--recover", "-o", "garbage.mcap"];
    let help = "choose another name; without -o";
    assert_refused(folder.path(), &arguments, 2, "garbage.mcap is there already", help);
}
