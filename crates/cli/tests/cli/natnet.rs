//! `posewire stream` to NatNet clients, and from a NatNet server to MXTP.

use crate::program::{Ended, Monitor, Relay, assert_documented, objects, posewire};
use crate::running::Running;
use posewire_natnet::{MessageId, Packet};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, UdpSocket};
use std::path::Path;
use std::time::Duration;

/// `posewire stream` to NatNet clients, waiting for one.
struct Server {
    endpoint: String,
    running: Running,
}

impl Server {
    /// Starts it on ports of the system's choice, with these arguments more.
    fn start(source: &str, arguments: &[&str]) -> Self {
        let stream = ["stream", source, "--to", "natnet://127.0.0.1:0?data-port=0"];
        let mut running = Running::start(Path::new("."), &[&stream, arguments].concat());
        let said = running.read_until(|line| line.starts_with("  to "));
        let line = said.lines().last().unwrap_or_default();
        Self {
            endpoint: line.trim_start_matches("  to ").to_owned(),
            running,
        }
    }

    /// The place of the command port.
    fn place(&self) -> &str {
        let rest = self.endpoint.trim_start_matches("natnet://");
        rest.split('?').next().unwrap_or_default()
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
    server
        .running
        .read_until(|line| line.starts_with("waiting for somebody to connect"));
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
    let Ended { code, out, err } = server.running.end();
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
    let server = Server::start("synthetic:walk?rate=60", &["--duration", "30", "--silence", "0.3"]);
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
}

#[test]
fn a_skeleton_is_passed_on_from_natnet_to_mxtp() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--frames", "--count", "20"]);
    let server = Server::start("synthetic:walk?rate=60&props=1&fingers=true", &["--duration", "20"]);
    let source = format!("natnet://{}", server.place());
    let mut bridge = Relay::start(&[&source, "--to", &monitor.endpoint, "--duration", "20"]);
    assert_eq!(bridge.types, "02,12,13,20,25", "no centre of mass comes over NatNet");
    let told = bridge.running.read_until(|line| line.contains("left out"));
    assert!(told.contains("left out: datagram type 24 (centre of mass)"), "{told}");
    let frames = objects(&monitor.running.end().out, "frame");
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
    let Ended { code, out, err } = server.running.end();
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
    assert_eq!(objects(&monitor.running.end().out, "frame").len(), 30);
}

#[test]
fn without_waiting_a_stream_begins_at_once() {
    let server = Server::start(
        "synthetic:walk?rate=60",
        &["--duration", "0.2", "--no-wait", "--name", "Cleo"],
    );
    let Ended { code, err, .. } = server.running.end();
    assert_eq!(code, Some(0), "{err}");
    assert!(!err.contains("waiting") && err.contains("sent 12 samples"), "{err}");
}
