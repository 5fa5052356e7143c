//! A recording, read by the Python packages of MCAP and of ROS 2: every payload as it was sent, and poses without a plugin.

use crate::python::{Failure, Python};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Command, Stdio};

#[test]
fn python_reads_every_payload_and_the_poses() {
    for package in ["mcap", "mcap-ros2-support"] {
        if let Err(Failure::Absent(reason)) = Python::with(package) {
            return println!("skipped: {reason}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let sent = record(folder.path());
    let (take, sent_file) = (folder.path().join("take.mcap"), folder.path().join("sent"));
    fs::write(&sent_file, &sent).unwrap();
    let python = Python::with("mcap").unwrap();
    let arguments = [take.to_string_lossy(), sent_file.to_string_lossy()];
    let report = python
        .run("recording/read.py", &[&arguments[0], &arguments[1]])
        .unwrap();

    let source = &report["sources"]["0"];
    assert_eq!((&source["count"], &source["whole"]), (&SENT.into(), &Value::Bool(true)));
    assert_eq!(source["sha256"], report["sent"]);
    assert_eq!(report["sources"]["1"]["whole"], true);
    let ada = &report["subjects"]["/1/Ada/tf"];
    assert_eq!(
        ada["transforms"].as_u64(),
        ada["samples"].as_u64().map(|samples| samples * 23),
        "{ada}"
    );
    let pelvis = &ada["first"];
    assert_eq!(
        (&pelvis["parent"], &pelvis["child"]),
        (&"world".into(), &"Ada/Pelvis".into())
    );
    assert_eq!(pelvis["stamped"], true);
    let height = pelvis["translation"][2].as_f64().unwrap();
    assert!((0.7..1.2).contains(&height), "Z is up, in metres: {height}");
    let metadata = report["metadata"].as_array().unwrap();
    for name in [
        "posewire.recording",
        "posewire.source",
        "posewire.subject",
        "posewire.end",
    ] {
        assert!(metadata.contains(&name.into()), "{name}");
    }
}

/// Records numbers at one source and a walker at another; gives the numbers, each datagram behind its length.
fn record(folder: &Path) -> Vec<u8> {
    let mut recorder = Command::new(env!("CARGO_BIN_EXE_posewire"))
        .args(["record", "mxtp://127.0.0.1:0", "mxtp://127.0.0.1:0", "-o", "take.mcap"])
        .current_dir(folder)
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(recorder.stderr.take().unwrap()).lines();
    let mut lines = lines.map_while(Result::ok);
    let ports = [(); 2].map(|()| lines.next().unwrap().rsplit_once(':').unwrap().1.to_owned());
    lines.next();
    let sent = send(ports[0].parse().unwrap());
    let walking = Command::new(env!("CARGO_BIN_EXE_posewire"))
        .args(["stream", "synthetic:walk?people=1", "--duration", "0.3", "--to"])
        .arg(format!("mxtp://127.0.0.1:{}", ports[1]))
        .stderr(Stdio::null())
        .status();
    assert!(walking.unwrap().success());
    let process = recorder.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &process])
            .status()
            .unwrap()
            .success()
    );
    let said: Vec<_> = lines.collect();
    assert_eq!(recorder.wait().unwrap().code(), Some(0), "{said:?}");
    sent
}

/// Sends datagrams of every length up to the longest.
fn send(port: u16) -> Vec<u8> {
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut all = Vec::new();
    for number in 0..SENT {
        let length = if number == SENT - 1 { 65_507 } else { number * 3 };
        let datagram = vec![number as u8; length];
        sender.send_to(&datagram, ("127.0.0.1", port)).unwrap();
        all.extend_from_slice(&(length as u64).to_le_bytes());
        all.extend_from_slice(&datagram);
    }
    all
}

const SENT: usize = 500;
