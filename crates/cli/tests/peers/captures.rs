//! Captures that scapy has written are read, and scapy reads ours.

use crate::python::{Failure, Python};
use posewire::capture::{Capture, CaptureOptions, PcapWriter};
use posewire::{Datagram, Wire};
use posewire_motion::Stamp;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Runs the script, unless scapy is not here.
fn scapy(action: &str, file: &Path) -> Option<Vec<Value>> {
    let file = file.to_str().unwrap();
    let report = Python::with("scapy").and_then(|python| python.run("captures/scapy_packets.py", &[action, file]));
    match report {
        Ok(report) => Some(report["datagrams"].as_array().unwrap().clone()),
        Err(Failure::Absent(reason)) => {
            println!("skipped: {reason}");
            None
        }
        Err(Failure::Broken(problem)) => panic!("{problem}"),
    }
}

/// The digests of payloads, computed by the system's own program.
fn sha256(folder: &Path, payloads: &[&[u8]]) -> Vec<String> {
    let digest = |(number, payload): (usize, &&[u8])| {
        let path = folder.join(format!("payload-{number}"));
        std::fs::write(&path, payload).unwrap();
        let output = std::process::Command::new("sha256sum").arg(&path).output().unwrap();
        String::from_utf8(output.stdout).unwrap()[..64].to_owned()
    };
    payloads.iter().enumerate().map(digest).collect()
}

#[test]
fn what_scapy_writes_gives_the_same_datagrams() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scapy.pcapng");
    let Some(written) = scapy("write", &file) else { return };
    let mut capture = Capture::open(&file, &CaptureOptions::default()).unwrap();
    let read: Vec<_> = capture.by_ref().map(|captured| captured.unwrap().datagram).collect();
    assert_eq!((capture.damage(), capture.counts().lost()), (None, 0));
    assert_eq!(capture.counts().skipped_bytes, 0);
    // That a piece of another protocol and an ARP packet are there is known too.
    assert_eq!(capture.counts().other, 2);
    let payloads: Vec<_> = read.iter().map(|datagram| &*datagram.bytes).collect();
    let digests = sha256(folder.path(), &payloads);
    assert_eq!(read.len(), written.len());
    for ((datagram, digest), expected) in read.iter().zip(digests).zip(&written) {
        assert_eq!(expected["sha256"], *digest);
        assert_eq!(expected["from"], datagram.from.to_string());
        assert_eq!(expected["to"], datagram.to.to_string());
    }
}

#[test]
fn scapy_reads_what_we_write() {
    let folder = tempfile::tempdir().unwrap();
    let sent: Vec<_> = (0..10u8).map(datagram).collect();
    for name in ["ours.pcapng", "ours.pcap"] {
        let file = folder.path().join(name);
        let mut writer = PcapWriter::create(&file, false).unwrap();
        for datagram in &sent {
            writer.write(datagram).unwrap();
        }
        writer.finish().unwrap();
        let Some(read) = scapy("read", &file) else { return };
        let payloads: Vec<_> = sent.iter().map(|datagram| &*datagram.bytes).collect();
        let digests = sha256(folder.path(), &payloads);
        assert_eq!(read.len(), sent.len());
        for ((datagram, digest), read) in sent.iter().zip(digests).zip(&read) {
            let expected: BTreeMap<&str, Value> = BTreeMap::from([
                ("sha256", digest.into()),
                ("from", datagram.from.to_string().into()),
                ("to", datagram.to.to_string().into()),
                ("time_ns", datagram.received.nanoseconds().into()),
                ("checksums", true.into()),
            ]);
            for (key, value) in expected {
                assert_eq!(read[key], value, "{key} in {name}");
            }
        }
    }
}

/// Datagrams of each wire and of very different lengths.
fn datagram(number: u8) -> Datagram {
    let wire = Wire::ALL[usize::from(number) % Wire::ALL.len()];
    Datagram {
        wire,
        from: ([192, 168, 1, 20], 50_000 + u16::from(wire == Wire::MxtpTcp)).into(),
        to: ([239, 255, 42, 99], 1511).into(),
        received: Stamp(1_700_000_000_123_456_789 + i64::from(number) * 4_166_667),
        bytes: vec![number; 1 + usize::from(number) * 7000].into(),
    }
}
