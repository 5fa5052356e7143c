//! `posewire stream` to NatNet clients, and from a NatNet server to MXTP.

use crate::program::{Monitor, Relay, assert_documented, objects, posewire};
use posewire_natnet::{MessageId, Packet};
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::net::{Ipv4Addr, UdpSocket};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;

/// `posewire stream` to NatNet clients, waiting for one.
struct Server {
    endpoint: String,
    child: Child,
    err: BufReader<ChildStderr>,
}

impl Server {
    /// Starts it on ports of the system's choice, with these arguments more.
    fn start(source: &str, arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_posewire"))
            .args(["stream", source, "--to", "natnet://127.0.0.1:0?data-port=0"])
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut server = Self {
            endpoint: String::new(),
            err: BufReader::new(child.stderr.take().unwrap()),
            child,
        };
        let said = server.read_until("  to ");
        let line = said.lines().last().unwrap_or_default();
        server.endpoint.push_str(line.trim_start_matches("  to "));
        server
    }

    /// The place of the command port.
    fn place(&self) -> &str {
        let rest = self.endpoint.trim_start_matches("natnet://");
        rest.split('?').next().unwrap_or_default()
    }

    /// Reads what it says until a line that begins with this.
    fn read_until(&mut self, beginning: &str) -> String {
        let mut said = String::new();
        loop {
            let start = said.len();
            assert!(self.err.read_line(&mut said).unwrap() > 0, "{said}");
            if said[start..].starts_with(beginning) {
                return said;
            }
        }
    }

    /// Waits until it has ended: its exit code, what it printed and what it said since the last reading.
    fn end(mut self) -> (Option<i32>, String, String) {
        let (mut out, mut err) = (String::new(), String::new());
        self.err.read_to_string(&mut err).unwrap();
        self.child.stdout.take().unwrap().read_to_string(&mut out).unwrap();
        (self.child.wait().unwrap().code(), out, err)
    }
}

/// The length of the next datagram. A signal, as of a machine that is suspended, ends waiting with a time limit early.
fn receive(client: &UdpSocket, buffer: &mut [u8]) -> usize {
    loop {
        match client.recv(buffer) {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            received => return received.unwrap(),
        }
    }
}

#[test]
fn a_stream_begins_when_a_client_connects_and_tells_of_it() {
    let mut server = Server::start("synthetic:walk?rate=60", &["--duration", "0.5", "--json"]);
    server.read_until("waiting for somebody to connect");
    let client = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    client.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    client.send_to(&[0, 0, 0, 0], server.place()).unwrap();
    let mut buffer = vec![0; 65_535];
    let mut kinds = Vec::new();
    while kinds.last() != Some(&MessageId::DISCONNECT) {
        let length = receive(&client, &mut buffer);
        kinds.push(Packet::decode(&buffer[..length]).unwrap().id);
    }
    assert_eq!(kinds[0], MessageId::SERVER_INFO);
    assert_eq!(kinds.iter().filter(|kind| **kind == MessageId::FRAME).count(), 30);

    let address = client.local_addr().unwrap().to_string();
    let endpoint = server.endpoint.clone();
    let (code, out, err) = server.end();
    assert_eq!(code, Some(0), "{err}");
    assert!(
        err.contains(&format!("{endpoint}: {address} connected, gets NatNet 4.1")),
        "{err}"
    );
    assert!(
        err.contains("joint angles") && err.contains("NatNet has no place for it"),
        "{err}"
    );
    let summary = &objects(&out, "stream")[0];
    assert_documented(summary, "stream", &[]);
    assert_eq!((&summary["frames"], &summary["lost"]), (&30.into(), &0.into()));
    let served = &summary["targets"][0]["clients"][0];
    assert_eq!(served["address"], address.as_str());
    assert_eq!(
        (&served["version"], &served["state"], &served["frames"]),
        (&"4.1".into(), &"connected".into(), &30.into())
    );
}

#[test]
fn a_silent_client_is_dropped_after_the_time_that_was_set() {
    let mut server = Server::start("synthetic:walk?rate=60", &["--duration", "30", "--silence", "0.3"]);
    let client = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    client.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    client.send_to(&[0, 0, 0, 0], server.place()).unwrap();
    let mut buffer = vec![0; 65_535];
    loop {
        let length = receive(&client, &mut buffer);
        if Packet::decode(&buffer[..length]).unwrap().id == MessageId::DISCONNECT_BY_TIMEOUT {
            break;
        }
    }
    server.child.kill().unwrap();
    server.child.wait().unwrap();
}

#[test]
fn a_skeleton_is_passed_on_from_natnet_to_mxtp() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--frames", "--count", "20"]);
    let mut server = Server::start("synthetic:walk?rate=60&props=1&fingers=true", &["--duration", "20"]);
    let source = format!("natnet://{}", server.place());
    let mut bridge = Relay::start(&[&source, "--to", &monitor.endpoint, "--duration", "20"]);
    assert_eq!(bridge.types, "02,12,13,20,25", "no centre of mass comes over NatNet");
    let told = bridge.read_until("left out");
    assert!(told.contains("left out: datagram type 24 (centre of mass)"), "{told}");
    let frames = objects(&monitor.end().out, "frame");
    drop(bridge);
    server.child.kill().unwrap();
    server.child.wait().unwrap();
    let last = frames.last().unwrap();
    assert_eq!((&last["character"], &last["name"]), (&0.into(), &"Ada".into()));
    let segments = last["segments"].as_array().unwrap();
    assert_eq!((segments.len(), &segments[22]["name"]), (64, &"LeftToe".into()));
    assert!(segments.iter().all(|segment| segment["position"].is_array()));
    assert_eq!(last["joint_angles"][21]["name"], "jLeftBallFoot");
    let height = segments[0]["position"][2].as_f64().unwrap();
    assert!(
        (0.7..1.2).contains(&height),
        "the pelvis is {height} m above the ground"
    );
}

#[test]
fn a_type_that_natnet_cannot_give_is_refused_when_asked_for() {
    let arguments = [
        "stream",
        "natnet://127.0.0.1:9",
        "--to",
        "mxtp://127.0.0.1:9",
        "--types",
        "02,24",
    ];
    let ended = posewire(Path::new("."), &arguments, b"");
    assert_eq!(ended.code, Some(2));
    assert!(ended.err.contains("cannot send type 24"), "{}", ended.err);
}

#[test]
fn a_take_goes_to_both_protocols_at_once() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--frames", "--count", "30"]);
    let to_monitor = ["--to", &monitor.endpoint, "--duration", "0.5", "--json"];
    // With a target that nobody has to connect to the take begins at once.
    let server = Server::start("synthetic:walk?rate=60", &to_monitor);
    let (code, out, err) = server.end();
    assert_eq!(code, Some(0), "{err}");
    let summary = &objects(&out, "stream")[0];
    let targets = summary["targets"].as_array().unwrap();
    assert_eq!(targets[0]["endpoint"], monitor.endpoint.as_str());
    assert!(
        targets[1]["endpoint"]
            .as_str()
            .unwrap()
            .starts_with("natnet://127.0.0.1:")
    );
    assert_eq!((&summary["frames"], &targets[1]["datagrams"]), (&30.into(), &0.into()));
    assert_eq!(objects(&monitor.end().out, "frame").len(), 30);
}

#[test]
fn without_waiting_a_stream_begins_at_once() {
    let server = Server::start(
        "synthetic:walk?rate=60",
        &["--duration", "0.2", "--no-wait", "--name", "Cleo"],
    );
    let (code, _, err) = server.end();
    assert_eq!(code, Some(0), "{err}");
    assert!(!err.contains("waiting") && err.contains("sent 12 samples"), "{err}");
}
