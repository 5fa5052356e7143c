//! `posewire doctor`.

use crate::program::{Ended, assert_documented, objects, posewire};
use crate::running::Running;
use posewire::capture::PcapWriter;
use posewire::{Datagram, Wire};
use posewire_motion::Stamp;
use posewire_mxtp::body::{Body, TimeCode};
use posewire_mxtp::{Header, MessageType};
use std::net::UdpSocket;
use std::path::Path;

/// Examines a port of its own, to which `send` sends as soon as it listens.
fn examine(arguments: &[&str], send: impl Fn(&UdpSocket, u16)) -> Ended {
    let doctor = ["doctor", "mxtp://127.0.0.1:0", "--duration", "1"];
    let mut running = Running::start(Path::new("."), &[&doctor, arguments].concat());
    let line = running.line();
    let port = line.split([':', ' ']).find_map(|part| part.parse::<u16>().ok());
    send(
        &UdpSocket::bind("127.0.0.1:0").unwrap(),
        port.unwrap_or_else(|| panic!("{line}")),
    );
    let ended = running.end();
    Ended {
        err: line + &ended.err,
        ..ended
    }
}

fn assert_fits_80_columns(text: &str) {
    for line in text.lines() {
        assert!(line.chars().count() <= 80, "{line}");
        assert_eq!(line, line.trim_end());
    }
}

#[test]
fn the_machine_alone_is_examined_without_a_url() {
    let ended = posewire(Path::new("."), &["doctor"], b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("nothing broken, "), "{}", ended.out);
    assert_fits_80_columns(&ended.out);

    let ended = posewire(Path::new("."), &["doctor", "--json"], b"");
    let findings = objects(&ended.out, "finding");
    assert!(!findings.is_empty());
    for finding in &findings {
        assert_documented(finding, "finding", &[]);
    }
    let all = objects(&ended.out, "doctor").remove(0);
    assert_documented(&all, "doctor", &[]);
    assert_eq!(
        (&all["broken"], &all["endpoint"]),
        (&0.into(), &serde_json::Value::Null)
    );
}

#[test]
fn silence_is_broken_and_says_what_is_excluded() {
    let ended = examine(&[], |_, _| {});
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    assert!(ended.out.starts_with("broken   nothing-arrives\n"), "{}", ended.out);
    assert!(
        ended.out.contains("    why") && ended.out.contains("    do"),
        "{}",
        ended.out
    );
    assert_fits_80_columns(&ended.out);
}

#[test]
fn natnet_on_the_port_of_mxtp_is_found() {
    let ended = examine(&["--json"], |sender, port| {
        sender.send_to(b"\x07\0\x04\0\0\0\0\0", ("127.0.0.1", port)).unwrap();
    });
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    let finding = objects(&ended.out, "finding").remove(0);
    assert_eq!(
        (&finding["name"], &finding["severity"]),
        (&"wrong-protocol".into(), &"broken".into())
    );
    assert_eq!(objects(&ended.out, "doctor")[0]["datagrams"], 1);
}

#[test]
fn a_taken_port_is_a_finding_and_no_error() {
    let holder = UdpSocket::bind("127.0.0.1:0").unwrap();
    let url = format!("mxtp://{}", holder.local_addr().unwrap());
    let ended = posewire(Path::new("."), &["doctor", &url], b"");
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    assert!(ended.out.starts_with("broken   port-taken\n"), "{}", ended.out);
    if cfg!(target_os = "linux") {
        let process = format!("(process {})", std::process::id());
        let words = ended.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&process), "{words}");
    }
}

/// A capture of a character without a pose that is sent from two addresses, to so many others in turn.
fn write_capture(path: &Path, receivers: u32) {
    let mut writer = PcapWriter::create(path, false).unwrap();
    for number in 0..600 {
        let header = Header::rev_j(MessageType::TIME_CODE, number / 2, number * 2);
        let body = Body::TimeCode(TimeCode::from_millis_of_day(number * 2));
        let mut bytes = Vec::new();
        posewire_mxtp::Datagram::new(header, body).unwrap().encode(&mut bytes);
        let datagram = Datagram {
            wire: Wire::MxtpUdp,
            from: ([10, 0, 0, 1 + (number % 2) as u8], 50_000).into(),
            to: ([10, 0, 0, 9 + (number / 2 % receivers) as u8], 9763).into(),
            received: Stamp(1_700_000_000_000_000_000 + i64::from(number) * 2_000_000),
            bytes: bytes.into(),
        };
        writer.write(&datagram).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn a_capture_is_examined_as_a_stream_is() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 1);
    let ended = posewire(folder.path(), &["doctor", "take.pcapng", "--json"], b"");
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    let names: Vec<_> = objects(&ended.out, "finding")
        .iter()
        .map(|finding| finding["name"].clone())
        .collect();
    assert_eq!(names[..2], ["two-senders", "no-pose"], "{}", ended.out);
    assert_eq!(objects(&ended.out, "doctor")[0]["datagrams"], 600);
}

#[test]
fn each_source_of_a_capture_is_examined_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 2);
    let places = |arguments: &[&str]| {
        let ended = posewire(
            folder.path(),
            &[&["doctor", "take.pcapng", "--json"], arguments].concat(),
            b"",
        );
        let findings = objects(&ended.out, "finding").into_iter();
        let senders = findings.filter(|finding| finding["name"] == "two-senders");
        senders
            .map(|finding| finding["place"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    let all = [
        "mxtp://10.0.0.9:9763, character 0",
        "mxtp://10.0.0.10:9763, character 0",
    ];
    assert_eq!(places(&[]), all);
    assert_eq!(places(&["--only", "1"]), ["character 0"]);
}

#[test]
fn what_has_no_stream_is_refused() {
    for arguments in [["doctor", "take.mvnx"], ["doctor", "synthetic:walk"]] {
        let ended = posewire(Path::new("."), &arguments, b"");
        assert_eq!(ended.code, Some(2), "{}", ended.err);
        assert!(
            ended.err.contains("expected a live stream or a capture"),
            "{}",
            ended.err
        );
    }
    let ended = posewire(Path::new("."), &["doctor", "mxtp://127.0.0.1:0", "--only", "0"], b"");
    assert_eq!(ended.code, Some(2), "{}", ended.err);
}
