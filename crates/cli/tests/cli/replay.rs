//! `posewire replay`, and captures as sources of the other verbs.

use crate::program::{assert_documented, objects, posewire};
use posewire::capture::{Capture, CaptureOptions, Captured, PcapWriter};
use posewire::recording::{Writer, WriterOptions};
use posewire::{Datagram, SourceId, Wire};
use posewire_motion::Stamp;
use posewire_mxtp::body::{Body, TimeCode};
use posewire_mxtp::{Header, MessageType};
use serde_json::Value;
use std::collections::BTreeSet;
use std::net::UdpSocket;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// A capture of timecodes of one sample each, in turn to so many addresses.
pub(crate) fn write_capture(path: &Path, count: u32, receivers: u32) -> Vec<Vec<u8>> {
    let mut writer = PcapWriter::create(path, false).unwrap();
    let mut written = Vec::new();
    for number in 0..count {
        let datagram = timecode(number, receivers);
        writer.write(&datagram).unwrap();
        written.push(datagram.bytes.into_vec());
    }
    writer.finish().unwrap();
    written
}

/// Four milliseconds after the one before.
fn timecode(number: u32, receivers: u32) -> Datagram {
    let header = Header::rev_j(MessageType::TIME_CODE, number, number * 4);
    let body = Body::TimeCode(TimeCode::from_millis_of_day(number * 4));
    let mut bytes = Vec::new();
    let datagram = posewire_mxtp::Datagram::new(header, body).unwrap();
    datagram.encode(&mut bytes);
    Datagram {
        wire: Wire::MxtpUdp,
        from: ([10, 0, 0, 1], 50_000).into(),
        to: ([10, 0, 0, 2 + (number % receivers) as u8], 9763).into(),
        received: Stamp(1_700_000_000_000_000_000 + i64::from(number) * 4_000_000),
        bytes: bytes.into(),
    }
}

/// A recording of so many files, with ten timecodes each.
fn write_recording(path: &Path, files: u32) {
    let options = WriterOptions {
        split: Some(1),
        ..WriterOptions::default()
    };
    let mut writer = Writer::create(path, &["mxtp://0.0.0.0:9763".to_owned()], options).unwrap();
    for number in 0..files * 10 {
        if number > 0 && number % 10 == 0 {
            writer.flush().unwrap();
        }
        let datagram = Arc::new(timecode(number, 1));
        writer.datagram(SourceId(0), &datagram).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn every_datagram_arrives_as_it_was_captured() {
    let folder = tempfile::tempdir().unwrap();
    let written = write_capture(&folder.path().join("take.pcapng"), 50, 2);
    let receiver = UdpSocket::bind("127.0.0.1:0").unwrap();
    receiver.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
    let to = format!("mxtp://{}", receiver.local_addr().unwrap());
    let ended = posewire(folder.path(), &["replay", "take.pcapng", "--to", &to, "--json"], b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let mut buffer = [0; 1000];
    for expected in &written {
        let length = receiver.recv(&mut buffer).unwrap();
        assert_eq!(&buffer[..length], expected);
    }
    let report = &objects(&ended.out, "replay")[0];
    assert_documented(report, "replay", &[]);
    assert_eq!((&report["datagrams"], &report["rounds"]), (&50.into(), &1.into()));
    assert!(
        ended.err.contains("0 mxtp://10.0.0.2:9763: 25 datagrams in 0.192 s"),
        "{}",
        ended.err
    );
}

#[test]
fn a_capture_is_explained_datagram_by_datagram() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 3, 1);
    let ended = posewire(folder.path(), &["explain", "take.pcapng", "--json"], b"");
    let datagrams = objects(&ended.out, "datagram");
    assert_eq!(datagrams.len(), 3);
    assert_documented(&datagrams[0], "datagram", &[]);
    let captured = &datagrams[2]["captured"];
    assert_eq!(captured["from"], "10.0.0.1:50000");
    assert_eq!(captured["received_ns"], 1_700_000_000_008_000_000_i64);
    let ended = posewire(folder.path(), &["explain", "take.pcapng", "--summary"], b"");
    let lines: Vec<_> = ended.out.lines().collect();
    assert!(
        lines[1].starts_with("    0.004000  10.0.0.1:50000 > 10.0.0.2:9763  MXTP25"),
        "{}",
        lines[1]
    );
    let ended = posewire(folder.path(), &["explain", "take.pcapng"], b"");
    assert!(
        ended.out.starts_with("+0.000000 s, at 1700000000.000000000, "),
        "{}",
        ended.out
    );
}

#[test]
fn a_capture_is_monitored_as_if_it_came_now() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 100, 1);
    let arguments = ["monitor", "take.pcapng", "--json", "--speed", "10"];
    let ended = posewire(folder.path(), &arguments, b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let last = objects(&ended.out, "statistics").pop().unwrap();
    assert_eq!((&last["received"], &last["missing"]), (&100.into(), &0.into()));
    assert_eq!(last["rate_hz"], 250.0);
}

#[test]
fn a_split_recording_is_used_as_one() {
    let folder = tempfile::tempdir().unwrap();
    write_recording(&folder.path().join("take.mcap"), 3);
    let verbs = [
        &[
            "replay",
            "take.mcap",
            "--to",
            "mxtp://127.0.0.1:9",
            "--speed",
            "9",
            "--json",
        ][..],
        &["monitor", "take.mcap", "--speed", "9", "--json"],
        &["convert", "take.mcap", "all.pcapng", "--json"],
    ];
    let [replayed, monitored, converted] = verbs.map(|arguments| posewire(folder.path(), arguments, b""));
    assert_eq!(objects(&replayed.out, "replay")[0]["datagrams"], 30, "{}", replayed.err);
    let said = "replaying take.mcap and 2 files after it";
    assert!(replayed.err.starts_with(said), "{}", replayed.err);
    let last = objects(&monitored.out, "statistics").pop().unwrap();
    assert_eq!((&last["received"], &last["missing"]), (&30.into(), &0.into()));
    assert_eq!(
        objects(&converted.out, "capture")[0]["datagrams"],
        30,
        "{}",
        converted.err
    );

    std::fs::remove_file(folder.path().join("all.pcapng")).unwrap();
    let last = std::fs::read(folder.path().join("take-003.mcap")).unwrap();
    std::fs::remove_file(folder.path().join("take-003.mcap")).unwrap();
    for arguments in verbs {
        let ended = posewire(folder.path(), arguments, b"");
        assert_eq!(ended.code, Some(3), "{}", ended.err);
        let problem = "take-002.mcap: the recording goes on in part 3, which is missing";
        assert!(ended.err.contains(problem), "{}", ended.err);
    }
    let ended = posewire(folder.path(), &["inspect", "take.mcap"], b"");
    assert!(
        ended.out.contains("  part         1, another follows\n"),
        "{}",
        ended.out
    );

    std::fs::write(folder.path().join("take-003.mcap"), last).unwrap();
    std::fs::remove_file(folder.path().join("all.pcapng")).unwrap();
    std::fs::remove_file(folder.path().join("take-002.mcap")).unwrap();
    for arguments in verbs {
        let ended = posewire(folder.path(), arguments, b"");
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        let problem = "error: take.mcap: part 2 of the recording is missing, expected before take-003.mcap";
        assert!(ended.err.contains(problem), "{}", ended.err);
    }
    let alone = ["monitor", "take-003.mcap", "--speed", "9", "--json"];
    let ended = posewire(folder.path(), &alone, b"");
    assert_eq!(objects(&ended.out, "statistics").pop().unwrap()["received"], 10);
}

#[test]
fn a_capture_is_inspected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.pcapng");
    write_capture(&path, 40, 2);
    let ended = posewire(folder.path(), &["inspect", "take.pcapng", "--json"], b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let object = objects(&ended.out, "packets").remove(0);
    assert_documented(&object, "packets", &[]);
    assert_eq!((&object["packets"], &object["datagrams"]), (&40.into(), &40.into()));
    assert_eq!(
        (&object["format"], &object["duration_s"]),
        (&"pcapng".into(), &0.156.into())
    );
    assert_eq!(object["first_ns"], 1_700_000_000_000_000_000_i64);
    let second = &object["sources"][1];
    assert_eq!(
        (&second["endpoint"], &second["protocol"]),
        (&"mxtp://10.0.0.3:9763".into(), &"mxtp".into())
    );
    let ended = posewire(folder.path(), &["inspect", "take.pcapng"], b"");
    let expected =
        "  source 1     mxtp://10.0.0.3:9763\n               mxtp: 20 datagrams, 0.0 MB, from 0.004 s on for 0.152 s\n";
    assert!(ended.out.contains(expected), "{}", ended.out);

    // Cut off, and with nothing that posewire speaks.
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 10]).unwrap();
    let ended = posewire(folder.path(), &["inspect", "take.pcapng"], b"");
    assert!(ended.out.contains("  ends with    "), "{}", ended.out);
    write_capture(&folder.path().join("take.pcap"), 1, 1);
    let ended = posewire(folder.path(), &["inspect", "take.pcap", "--protocol", "natnet"], b"");
    assert!(ended.out.contains("natnet: "), "{}", ended.out);
    let ended = posewire(folder.path(), &["inspect", "take.pcapng", "--verify"], b"");
    assert_eq!(ended.code, Some(2), "{}", ended.err);
    assert!(ended.err.contains("--verify is for takes"), "{}", ended.err);
}

#[test]
fn all_sources_are_monitored_and_one_when_it_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 4, 2);
    let received = |only: &[&str]| -> Vec<(Value, Value)> {
        let arguments = [&["monitor", "take.pcapng", "--json"], only].concat();
        let ended = posewire(folder.path(), &arguments, b"");
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        let last = objects(&ended.out, "statistics").into_iter();
        let mut last: Vec<_> = last.filter(|object| object["ended"] == true).collect();
        last.sort_by_key(|object| object["source"].as_u64());
        let pair = |object: &Value| (object["source"].clone(), object["received"].clone());
        last.iter().map(pair).collect()
    };
    assert_eq!(received(&[]), [0, 1].map(|source| (source.into(), 2.into())));
    assert_eq!(received(&["--only", "1"]), [(Value::Null, 2.into())]);

    let ended = posewire(folder.path(), &["monitor", "take.pcapng", "--plain"], b"");
    for heading in ["source 0 mxtp://10.0.0.2:9763\n", "source 1 mxtp://10.0.0.3:9763\n"] {
        assert!(ended.out.contains(heading), "{}", ended.out);
    }
    let ended = posewire(folder.path(), &["monitor", "take.pcapng", "--only", "10.0.0"], b"");
    assert_eq!(ended.code, Some(2));
    let found = "found 0 mxtp://10.0.0.2:9763, 1 mxtp://10.0.0.3:9763";
    assert!(
        ended.err.contains(found) && ended.err.contains("help: choose one"),
        "{}",
        ended.err
    );
}

#[test]
fn all_sources_are_streamed_to_mxtp_and_natnet_takes_one() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 40, 2);
    let to = ["--to", "natnet://127.0.0.1:0?data-port=0", "--no-wait"];
    let ended = posewire(folder.path(), &[&["stream", "take.pcapng"], &to[..]].concat(), b"");
    assert_eq!(ended.code, Some(2), "{}", ended.err);
    assert!(
        ended.err.contains("a natnet:// target takes one source"),
        "{}",
        ended.err
    );

    let receiver = UdpSocket::bind("127.0.0.1:0").unwrap();
    receiver.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
    let to = format!("mxtp://{}", receiver.local_addr().unwrap());
    let arguments = [
        "stream",
        "take.pcapng",
        "--to",
        &to,
        "--types",
        "25",
        "--speed",
        "4",
        "--json",
    ];
    let ended = posewire(folder.path(), &arguments, b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let sent = &objects(&ended.out, "stream")[0]["targets"][0]["datagrams"];
    let mut characters = BTreeSet::new();
    for _ in 0..sent.as_u64().unwrap() {
        let mut buffer = [0; 1000];
        receiver.recv(&mut buffer).unwrap();
        characters.insert(buffer[16]);
    }
    assert_eq!(characters, BTreeSet::from([0, 1]));
}

#[test]
fn one_source_of_a_capture_is_converted_when_it_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 20, 2);
    let convert = |to: &str, only: &str| posewire(folder.path(), &["convert", "take.pcapng", to, "--only", only], b"");
    let ended = convert("one.mcap", "10.0.0.3");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let capture = Capture::open(&folder.path().join("one.mcap"), &CaptureOptions::default()).unwrap();
    let of_one = capture.filter(|captured| captured.as_ref().unwrap().datagram.to.ip().to_string() == "10.0.0.3");
    assert_eq!(of_one.count(), 10);
    for (to, only, words) in [
        ("two.mcap", "0,1", "--only names several sources"),
        ("two.mcap", "position", "datagrams are converted whole"),
        (
            "two.bvh",
            "10.0.0.9",
            "found 0 mxtp://10.0.0.2:9763, 1 mxtp://10.0.0.3:9763",
        ),
    ] {
        let ended = convert(to, only);
        assert_eq!(ended.code, Some(2), "{}", ended.err);
        assert!(ended.err.contains(words), "{}", ended.err);
    }
}

#[test]
fn what_is_no_capture_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("take.pcapng"), "not at all").unwrap();
    let arguments = ["replay", "take.pcapng", "--to", "mxtp://127.0.0.1"];
    let ended = posewire(folder.path(), &arguments, b"");
    assert_eq!(ended.code, Some(1));
    assert!(
        ended
            .err
            .contains("expected a pcap, pcapng or MCAP file, found \"not at a\""),
        "{}",
        ended.err
    );
    let arguments = ["monitor", "mxtp://127.0.0.1:0", "--only", "0"];
    let ended = posewire(folder.path(), &arguments, b"");
    assert_eq!(ended.code, Some(2));
    assert!(
        ended.err.contains("--only is for recordings and captures"),
        "{}",
        ended.err
    );
}

#[test]
fn a_capture_becomes_a_recording_and_a_capture_again_with_every_datagram() {
    let folder = tempfile::tempdir().unwrap();
    let written = write_capture(&folder.path().join("take.pcapng"), 20, 1);
    for [from, to] in [["take.pcapng", "take.mcap"], ["take.mcap", "again.pcapng"]] {
        let ended = posewire(folder.path(), &["convert", from, to, "--json"], b"");
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        let report = &objects(&ended.out, "capture")[0];
        assert_documented(report, "capture", &[]);
        assert_eq!(report["datagrams"], 20);
    }
    let again = Capture::open(&folder.path().join("again.pcapng"), &CaptureOptions::default()).unwrap();
    let again: Vec<_> = again.map(|captured| captured.unwrap().datagram).collect();
    assert!(
        again
            .iter()
            .map(|datagram| &*datagram.bytes)
            .eq(written.iter().map(Vec::as_slice))
    );
    let times = again.iter().map(|datagram| datagram.received.nanoseconds());
    assert!(times.eq((0..20).map(|number| 1_700_000_000_000_000_000 + number * 4_000_000)));

    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = |name: &str| folder.path().join(name).metadata().unwrap().permissions().mode();
        assert_eq!(mode("again.pcapng"), mode("take.pcapng"));
    }
    let refused = posewire(folder.path(), &["convert", "take.mcap", "again.pcapng"], b"");
    assert_eq!(refused.code, Some(2), "{}", refused.err);
}

#[test]
fn what_no_target_takes_is_refused_in_the_words_that_were_typed() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 4, 1);
    let frame = |number: u8| Datagram {
        wire: Wire::NatNetData,
        bytes: [&[7, 0, 4, 0][..], &[number, 0, 0, 0]].concat().into(),
        ..timecode(number.into(), 1)
    };
    let mut writer = PcapWriter::create(&folder.path().join("motive.pcapng"), false).unwrap();
    (0..4).for_each(|number| writer.write(&frame(number)).unwrap());
    writer.finish().unwrap();
    for (file, to, problem) in [
        (
            "take.pcapng",
            "natnet://127.0.0.1:0?data-port=0",
            "take.pcapng: expected NatNet for natnet://127.0.0.1:0?mode=unicast&data-port=0, found 0 mxtp://10.0.0.2:9763",
        ),
        (
            "motive.pcapng",
            "mxtp://127.0.0.1",
            "motive.pcapng: expected MXTP for mxtp://127.0.0.1:9763, found 0 natnet://10.0.0.1",
        ),
    ] {
        let ended = posewire(folder.path(), &["replay", file, "--to", to], b"");
        assert_eq!(ended.code, Some(2), "{}", ended.err);
        assert!(ended.err.contains(problem), "{}", ended.err);
        let help = format!("help: posewire stream {file} --to ");
        assert!(ended.err.contains(&help), "{}", ended.err);
    }
}

#[test]
fn a_part_in_which_nothing_came_is_answered_with_how_long_the_file_is() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 4, 1);
    for verb in [
        &["replay", "take.pcapng", "--to", "mxtp://127.0.0.1:9"][..],
        &["monitor", "take.pcapng", "--json"],
        &["stream", "take.pcapng", "--to", "mxtp://127.0.0.1:9", "--types", "25"],
    ] {
        for (part, problem) in [
            (
                ["--from", "3", "--until", "2"],
                "error: --until 2 is not behind --from 3",
            ),
            (
                ["--from", "100", "--speed", "1"],
                "error: take.pcapng: expected datagrams in that time, found none: it lasts 0.012 s",
            ),
        ] {
            let ended = posewire(folder.path(), &[verb, &part[..]].concat(), b"");
            assert_eq!(ended.code, Some(2), "{}", ended.err);
            assert!(ended.err.contains(problem), "{}", ended.err);
        }
    }
}

#[test]
fn a_part_of_a_capture_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 10, 2);
    let explained = |part: &[&str]| posewire(folder.path(), &[&["explain", "take.pcapng"], part].concat(), b"");
    let part = ["--only", "10.0.0.3", "--from", "0.004", "--until", "0.02", "--summary"];
    let ended = explained(&part);
    let lines: Vec<_> = ended.out.lines().collect();
    assert_eq!((ended.code, lines.len()), (Some(0), 4), "{}", ended.out);
    assert!(lines[0].starts_with("    0.004000  10.0.0.1:50000 > 10.0.0.3:9763"));
    assert!(lines[1].starts_with("    0.012000  "));
    for (part, words) in [
        (["--only", "7"], "expected one source \"7\""),
        (["--from", "9"], "expected datagrams in that time, found none"),
    ] {
        assert!(explained(&part).err.contains(words), "{part:?}");
    }
    let ended = explained(&["--from=2", "--until=1"]);
    assert_eq!(ended.code, Some(2), "{}", ended.err);
    let bytes = timecode(1, 1).bytes;
    let ended = posewire(folder.path(), &["explain", "-", "--only", "0"], &bytes);
    assert_eq!(ended.code, Some(2), "{}", ended.err);
    assert!(
        ended.err.contains("--only is for recordings and captures"),
        "{}",
        ended.err
    );
}

#[test]
fn faults_that_natnet_frames_do_not_meet_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let to = ["--to", "natnet://127.0.0.1:0?data-port=0", "--no-wait"];
    let arguments = [
        &[
            "stream",
            "synthetic:walk",
            "--faults",
            "drift=200ppm,loss=1%",
            "--duration",
            "0.1",
        ],
        &to[..],
    ];
    let ended = posewire(folder.path(), &arguments.concat(), b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(
        ended.err.contains(": without drift, which NatNet frames do not meet\n"),
        "{}",
        ended.err
    );
}

#[test]
fn all_sources_of_a_capture_are_recorded() {
    let folder = tempfile::tempdir().unwrap();
    write_capture(&folder.path().join("take.pcapng"), 10, 2);
    let ended = posewire(folder.path(), &["record", "take.pcapng", "-o", "take.mcap"], b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let [written, recorded] = ["take.pcapng", "take.mcap"].map(|name| {
        let captured = Capture::open(&folder.path().join(name), &CaptureOptions::default()).unwrap();
        let mut captured: Vec<_> = captured.map(Result::unwrap).collect();
        // Each source has a thread of its own, and which of two in the same moment comes first is the system's choice.
        captured.sort_by_key(|captured| captured.datagram.received);
        let datagram = |Captured { source, datagram, .. }| (source, datagram.received, datagram.bytes);
        captured.into_iter().map(datagram).collect::<Vec<_>>()
    });
    assert_eq!(recorded, written);
    let sources = recorded.iter().map(|(source, ..)| *source);
    assert_eq!(sources.collect::<Vec<_>>(), [0, 1].repeat(5));
}
