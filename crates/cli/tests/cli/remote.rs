//! `posewire stream` and `posewire record` that other programs control.

use crate::program::{assert_documented, objects, posewire};
use crate::running::{Running, port};
use crate::takes::small_take;
use std::fs;
use std::net::UdpSocket;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// The program, controlled over a port of its own.
struct Controlled {
    /// What it said until it said where it is controlled.
    announced: String,
    port: u16,
    running: Running,
}

impl Controlled {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut running = Running::start(folder, &[arguments, &["--remote", "0"]].concat());
        let announced = running.read_until(|line| line.starts_with("remote control on udp 127.0.0.1:"));
        Self {
            port: port(&announced),
            announced,
            running,
        }
    }

    /// The port that the first line of the announcement ends in.
    fn source(&self) -> u16 {
        port(self.announced.lines().next().unwrap())
    }

    fn ask(&self, message: &str) -> String {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
        socket.send_to(message.as_bytes(), ("127.0.0.1", self.port)).unwrap();
        let mut buffer = [0; 8192];
        let length = socket.recv(&mut buffer).unwrap();
        String::from_utf8(buffer[..length].to_vec()).unwrap()
    }
}

/// The first block of this kind on the page about remote control.
fn block(kind: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/remote.md");
    let page = fs::read_to_string(page).unwrap().replace("\r\n", "\n");
    let (_, rest) = page.split_once(&format!("```{kind}\n")).unwrap();
    rest.split_once("```").unwrap().0.to_owned()
}

#[test]
fn the_client_of_the_documentation_controls_a_stream() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.mvnx"), small_take(6000)).unwrap();
    let target = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("mxtp://{}", target.local_addr().unwrap());
    let mut stream = Controlled::start(folder.path(), &["stream", "take.mvnx", "--types", "02,12", "--to", &to]);
    let client = Command::new("python3")
        .args(["-c", &block("python"), &stream.port.to_string()])
        .output();
    let Ok(client) = client else {
        println!("skipped: python3 is not here");
        return;
    };
    let said = String::from_utf8(client.stdout).unwrap().replace("\r\n", "\n");
    assert_eq!(said, block("xml"), "{}", String::from_utf8_lossy(&client.stderr));
    let told = stream.running.read_until(|line| line.contains("goes to sample 240"));
    assert!(told.contains(": paused\n"), "{told}");
}

#[cfg(unix)]
#[test]
fn a_stream_that_is_controlled_goes_on_until_it_is_stopped_and_tells_of_every_target() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.mvnx"), small_take(6)).unwrap();
    let [target, guest] = [(); 2].map(|()| UdpSocket::bind("127.0.0.1:0").unwrap());
    let to = format!("mxtp://{}", target.local_addr().unwrap());
    let stream = Controlled::start(
        folder.path(),
        &["stream", "take.mvnx", "--types", "02,12", "--to", &to, "--json"],
    );
    while !stream.ask("<SessionStatusReq/>").contains("isPaused=\"TRUE\"") {}
    let port = guest.local_addr().unwrap().port();
    let change =
        |verb: &str| format!("<{verb}NetworkStreamingTargetReq IpAddress=\"127.0.0.1\" PortNumber=\"{port}\"/>");
    assert!(stream.ask(&change("Add")).contains("TRUE"));
    assert!(stream.ask("<NavigateToStartReq/>").contains("TRUE"));
    guest.recv(&mut [0; 8192]).unwrap();
    assert!(stream.ask(&change("Remove")).contains("TRUE"));
    stream.running.interrupt();
    let ended = stream.running.end();
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let end = objects(&ended.out, "stream").remove(0);
    let targets = end["targets"].as_array().unwrap();
    assert_eq!(targets.len(), 2);
    assert_eq!(targets[1]["endpoint"], format!("mxtp://127.0.0.1:{port}"));
    assert!(targets[1]["datagrams"].as_u64() > Some(0) && targets[1]["peers"] == 0);
}

#[cfg(unix)]
#[test]
fn takes_are_recorded_by_command_and_ctrl_c_ends_the_last() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["record", "mxtp://127.0.0.1:0", "-o", ".", "--json"];
    let recorder = Controlled::start(folder.path(), &arguments);
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    let send = || sender.send_to(b"anything", ("127.0.0.1", recorder.source())).unwrap();
    for _ in 0..2 {
        let begun = recorder.ask("<StartRecordingReq SessionName=\"walk\"/>");
        assert_eq!(begun, "<StartRecordingAck Result=\"TRUE\"/>");
        send();
        assert!(recorder.ask("<StopRecordingReq/>").contains("TRUE"));
    }
    let refused = recorder.ask("<StartRecordingReq SessionName=\"..\\walk\"/>");
    assert!(refused.contains("FALSE"), "{refused}");
    assert!(recorder.ask("<CaptureStart/>").contains("TRUE"));
    recorder.running.interrupt();
    let ended = recorder.running.end();
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.err.ends_with("3 takes in all\n"), "{}", ended.err);
    let told = objects(&ended.out, "recording");
    let takes: Vec<_> = told.iter().filter(|object| object["ended"] == true).collect();
    let files: Vec<_> = takes.iter().map(|take| take["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["./walk.mcap", "./walk_2.mcap", "./take.mcap"]);
    for take in takes {
        assert_documented(take, "recording", &[]);
    }
    let seen = posewire(folder.path(), &["inspect", "take.mcap", "--json"], b"");
    assert_eq!(objects(&seen.out, "mcap")[0]["complete"], true);
}

#[test]
fn takes_need_a_folder_and_replace_nothing() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("take.mcap"), "").unwrap();
    let refused = |arguments: &[&str]| {
        let record = ["record", "mxtp://127.0.0.1:0", "--remote", "0"];
        let ended = posewire(folder.path(), &[&record, arguments].concat(), b"");
        assert_eq!(ended.code, Some(2), "{}", ended.err);
        ended.err
    };
    let told = refused(&["-o", "take.mcap"]);
    assert!(
        told.starts_with("error: expected a folder for the takes, found take.mcap\nhelp: "),
        "{told}"
    );
    assert!(refused(&["-o", ".", "--overwrite"]).contains("--overwrite and --remote"));
    let wrong = posewire(folder.path(), &["stream", "synthetic:walk", "--remote", "stage"], b"");
    assert!(
        wrong.code == Some(2) && wrong.err.contains("expected a port, as in 6004"),
        "{}",
        wrong.err
    );
}
