//! `posewire explain`.

use crate::program::{Ended, assert_documented, assert_fits, posewire, reference, vectors};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

fn explain(arguments: &[&str], input: &[u8]) -> Ended {
    posewire(&vectors(), &[&["explain"], arguments].concat(), input)
}

fn vector(name: &str) -> Vec<u8> {
    fs::read(vectors().join(name).with_extension("bin")).unwrap()
}

/// The project's own NatNet packets.
fn natnet_vectors() -> PathBuf {
    vectors().with_file_name("natnet")
}

fn natnet(name: &str) -> Vec<u8> {
    fs::read(natnet_vectors().join(name).with_extension("bin")).unwrap()
}

/// The only object of a run that had a single datagram.
fn object(ended: &Ended) -> Value {
    let [object] = &objects(ended)[..] else {
        panic!("{}{}", ended.out, ended.err)
    };
    object.clone()
}

fn objects(ended: &Ended) -> Vec<Value> {
    ended
        .out
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn a_datagram_is_explained_field_by_field() {
    let expected = r#"MXTP24 char 0 sample 4242 time 17.675s 0x80 centre of mass (1.000, -1.000, 1.016) [center-of-mass-short]
centre of mass, Rev J, 36 bytes at byte 0

offset  bytes     MV0305    field                      value
     0  4d585450  2.4.1.1   header.magic               "MXTP"
     4  3234      2.4.1.1   header.message_type        "24"
     6  00001092  2.4.1.2   header.sample              4242
    10  80        2.4.1.3   header.counter             128        0x80: part 0, the last
    11  01        2.4.1.4   header.items                1
    12  0000450b  2.4.1.5   header.time_ms             17675      ms
    16  00        2.4.1.6   header.character            0
    17  00        2.4.1.7   header.body_segments        0
                                                       this and the six bytes after it are 0: Rev J
    18  00        2.4.1.8   header.props                0
    19  00        2.4.1.9   header.finger_segments      0
    20  0000      2.4.1.10  header.reserved            0000
    22  0000      2.4.1.11  header.payload_size         0         bytes
    24  3f800000  2.7.5     center_of_mass.position.x   1         m
    28  bf800000  2.7.5     center_of_mass.position.y  -1         m
    32  3f820000  2.7.5     center_of_mass.position.z   1.015625  m

quirks
  center-of-mass-short   a centre of mass of 12 bytes, no velocity or acceleration
"#;
    let ended = explain(&["24_center_of_mass_short_rev_j.bin"], b"");
    assert_eq!(ended, Ended::with(expected));
}

#[test]
fn every_vector_is_explained_within_the_page() {
    for (folder, protocol) in [(vectors(), "mxtp"), (natnet_vectors(), "natnet")] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|ending| ending != "bin") {
                continue;
            }
            let ended = explain(&[path.to_str().unwrap(), "--protocol", protocol], b"");
            assert_eq!((ended.code, ended.err.as_str()), (Some(0), ""), "{}", path.display());
            let (_, table) = ended.out.split_once('\n').unwrap();
            assert_fits(table);
        }
    }
}

#[test]
fn json_has_the_header_and_every_field() {
    let ended = explain(&["quirk_time_code_text.bin", "--json"], b"");
    let [object] = &objects(&ended)[..] else {
        panic!("{}", ended.out)
    };
    assert_documented(object, "datagram", &["captured"]);
    assert_eq!((&object["offset"], &object["length"]), (&0.into(), &40.into()));
    assert_eq!(
        (&object["header"]["type"], &object["header"]["revision"]),
        (&"25".into(), &"N".into())
    );
    assert_eq!(
        (&object["protocol"], &object["bitstream"]),
        (&"mxtp".into(), &Value::Null)
    );
    assert_eq!(object["quirks"], serde_json::json!(["time-code-text"]));
    assert_eq!(object["error"], Value::Null);
    let text = serde_json::json!({
        "offset": 28, "length": 12, "name": "time_code", "value": "99:99:99.999",
        "unit": "UTC", "section": "MV0305 2.7.6", "note": null,
    });
    assert_eq!(object["fields"].as_array().unwrap().last(), Some(&text));
}

#[test]
fn json_numbers_have_the_digits_of_the_wire() {
    let ended = explain(&["-", "--json"], &vector("24_center_of_mass_short_rev_n"));
    assert!(ended.out.contains(r#""value":1.015625,"unit":"m""#), "{}", ended.out);
}

#[test]
fn datagrams_back_to_back_are_told_apart_from_noise() {
    let [meta, pose] = ["12_meta_rev_n", "02_quaternion_rev_j"].map(vector);
    let stream = [&meta[..], b"noise", &pose, &pose[..100]].concat();
    let ended = explain(&["-"], &stream);
    assert_eq!(ended.code, Some(0));
    assert!(
        ended
            .out
            .contains("\n\nskipped 5 bytes at byte 93: 6e6f697365, part of no datagram\n\nMXTP02 ")
    );
    let error = "\n\nmalformed\n  MXTP02: expected 23 items of 32 bytes at offset 24, found 76 bytes\n";
    assert!(ended.out.contains(error), "{}", ended.out);
    assert!(
        ended
            .out
            .ends_with("\n3 datagrams, 1 of them malformed, 5 bytes skipped\n"),
        "{}",
        ended.out
    );

    let objects = objects(&explain(&["-", "--json"], &stream));
    let places: Vec<_> = objects
        .iter()
        .map(|o| (o["kind"].as_str(), o["offset"].as_u64()))
        .collect();
    let kinds = ["datagram", "skipped", "datagram", "datagram"].map(Some);
    assert!(places.iter().map(|place| place.0).eq(kinds));
    assert!(places.iter().map(|place| place.1).eq([0, 93, 98, 858].map(Some)));
    assert_eq!(objects[3]["header"]["sample"], objects[2]["header"]["sample"]);
    assert!(objects[3]["error"].as_str().unwrap().contains("offset 24"));
}

#[test]
fn a_malformed_datagram_alone_is_a_failure() {
    let ended = explain(&["-"], &vector("02_quaternion_rev_n")[..20]);
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.out.contains("    12  0000450b  2.4.1.5  header.time_ms"),
        "{}",
        ended.out
    );
    assert!(
        ended
            .out
            .ends_with("\nmalformed\n  expected a 24-byte header, found 20 bytes\n"),
        "{}",
        ended.out
    );
    let error = "error: the standard input: the datagram is malformed and was explained as far as it goes\nhelp: ";
    assert!(ended.err.starts_with(error), "{}", ended.err);
}

#[test]
fn what_is_no_datagram_is_named_with_the_way_out() {
    for (input, code, error) in [
        (
            &b"GET / HTTP/1.1\r\n"[..],
            1,
            "error: the standard input: expected datagrams, which begin with \"MXTP\",",
        ),
        (b"", 2, "error: the standard input is empty\nhelp: "),
        (
            b"4d58 5450 3032",
            2,
            "error: the standard input holds the bytes as hexadecimal text\nhelp: xxd -r -p | ",
        ),
        (
            b"<mvnx version=\"4\">",
            2,
            "error: the standard input is a take, explain reads datagrams\nhelp: posewire inspect ",
        ),
    ] {
        let ended = explain(&["-"], input);
        assert_eq!(ended.code, Some(code), "{}", ended.err);
        assert!(ended.err.starts_with(error), "{}", ended.err);
    }
    let ended = explain(&["mxtp://127.0.0.1"], b"");
    let error =
        "error: mxtp://127.0.0.1 is a live stream, explain reads a file\nhelp: posewire monitor mxtp://127.0.0.1\n";
    assert_eq!(
        ended,
        Ended {
            code: Some(2),
            out: String::new(),
            err: error.to_owned()
        }
    );
    let ended = explain(&["nowhere.bin"], b"");
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.err.starts_with("error: cannot read nowhere.bin: "),
        "{}",
        ended.err
    );
}

#[test]
fn captured_datagrams_have_no_quirks() {
    for name in ["mxtp/mxtp02.bin", "mxtp/mxtp12.bin"] {
        let Some(path) = reference(name) else { return };
        let ended = explain(&[path.to_str().unwrap(), "--json"], b"");
        let [object] = &objects(&ended)[..] else {
            panic!("{}", ended.out)
        };
        assert_eq!(object["quirks"], serde_json::json!([]));
        assert_eq!(object["error"], Value::Null);
    }
}

#[test]
fn a_natnet_packet_is_explained_field_by_field() {
    let expected = "\
NatNet ECHORESPONSE client 5000, server 7000000
ECHORESPONSE, 20 bytes at byte 0

offset  bytes             field         value
     0  0d00              message       13       ECHORESPONSE
     2  1000              payload_size  16       bytes
     4  8813000000000000  client_ticks  5000     ticks
    12  c0cf6a0000000000  server_ticks  7000000  ticks
";
    let ticks = [5_000_u64, 7_000_000].map(u64::to_le_bytes).concat();
    let ended = explain(&["-"], &[b"\x0d\0\x10\0", &ticks[..]].concat());
    assert_eq!(ended, Ended::with(expected));
}

#[test]
fn a_natnet_version_is_guessed_or_given() {
    let frame = natnet("frame_3_0");
    let guessed = object(&explain(&["-", "--json"], &frame));
    assert_documented(&guessed, "datagram", &["captured"]);
    assert_eq!(guessed["protocol"], "natnet");
    let header = serde_json::json!({"message": 7, "name": "FRAMEOFDATA", "payload_size": frame.len() - 4});
    assert_eq!(guessed["header"], header);
    let bitstream =
        serde_json::json!({"version": "4.0", "given": false, "by": "bytes", "alike": ["3.0"], "otherwise": []});
    assert_eq!(guessed["bitstream"], bitstream);
    let given = object(&explain(&["--version", "3.1", "-", "--json"], &frame));
    let bitstream = serde_json::json!({"version": "3.1", "given": true, "by": "version", "alike": [], "otherwise": []});
    assert_eq!(given["bitstream"], bitstream);
    assert_eq!(given["fields"], guessed["fields"]);

    let text = explain(&["-"], &frame).out;
    let line = "\nbitstream 4.0 is a guess: 3.0 would read the same\n\noffset ";
    assert!(text.contains(line), "{text}");
    let text = explain(&["-", "--version", "3.0"], &frame).out;
    assert!(
        text.contains("\nFRAMEOFDATA, bitstream 3.0, 602 bytes at byte 0\n\noffset "),
        "{text}"
    );
}

#[test]
fn a_version_that_there_is_not_is_refused() {
    let frame = natnet("frame_3_0");
    for version in ["0.0", "1.3", "4.6", "9.9", "3.1.2", "3"] {
        let refused = explain(&["-", "--version", version], &frame);
        assert_eq!(refused.code, Some(2), "{version}");
        assert!(refused.err.contains("a version from 1.4 to 4.5"), "{}", refused.err);
    }
}

#[test]
fn every_natnet_vector_decodes_as_its_version() {
    for entry in fs::read_dir(natnet_vectors()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "json") {
            let vector: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
            let packet = path.with_extension("bin");
            let version = vector["version"].as_str().unwrap();
            let ended = explain(&[packet.to_str().unwrap(), "--version", version, "--json"], b"");
            let explained = object(&ended);
            assert_eq!(explained["error"], Value::Null, "{}", path.display());
            assert_eq!(explained["quirks"], vector["quirks"], "{}", path.display());
            assert_eq!(explained["header"]["message"], vector["message"]);
        }
    }
}

#[test]
fn natnet_packets_back_to_back_share_one_version() {
    let [info, model, frame] = ["server_info_279", "model_3_0", "frame_3_0"].map(natnet);
    let stream = [&info[..], &model, &frame, b"noise"].concat();
    let objects = objects(&explain(&["-", "--json"], &stream));
    let versions = objects.iter().map(|object| object["bitstream"]["version"].as_str());
    assert!(versions.eq([None, Some("3.0"), Some("3.0"), None]));
    assert_eq!(objects[3]["kind"], "skipped");
    let ended = explain(&["-"], &stream);
    assert!(ended.out.ends_with("\n3 datagrams, 5 bytes skipped\n"), "{}", ended.out);
}

#[test]
fn the_wrong_protocol_is_named_with_the_way_out() {
    let (pose, frame) = (vector("02_quaternion_rev_j"), natnet("frame_3_0"));
    for (arguments, input, code, error) in [
        (
            &["--protocol", "natnet"][..],
            &pose[..],
            2,
            "error: the standard input begins with \"MXTP\", it is no NatNet\nhelp: leave --protocol out, ",
        ),
        (
            &["--version", "3.1"],
            &pose,
            2,
            "error: --version 3.1 is of NatNet, the standard input is read as MXTP\nhelp: leave --version out",
        ),
        (
            &["--protocol", "mxtp"],
            &frame,
            1,
            "error: the standard input: expected datagrams, which begin with \"MXTP\", found ",
        ),
        (
            &[],
            &frame[..100],
            1,
            "error: the standard input: expected datagrams, which begin with \"MXTP\", or whole NatNet packets, found ",
        ),
        (
            &["--version", "three"],
            &frame,
            2,
            "error: invalid value 'three' for '--version <M.m>': expected a version from 1.4 to 4.5",
        ),
    ] {
        let ended = explain(&[&["-"], arguments].concat(), input);
        assert_eq!(ended.code, Some(code), "{}", ended.err);
        assert!(ended.err.starts_with(error), "{}", ended.err);
    }
    let help = "help: leave --protocol out: it begins as a NatNet FRAMEOFDATA does\n";
    assert!(explain(&["-", "--protocol", "mxtp"], &frame).err.ends_with(help));
    let cut = explain(&["-"], &frame[..100]).err;
    assert!(
        cut.contains("FRAMEOFDATA of 598 bytes") && cut.ends_with("cut short: --protocol natnet\n"),
        "{cut}"
    );
}

#[test]
fn a_cut_natnet_packet_is_explained_up_to_the_cut() {
    let ended = explain(&["-", "--protocol", "natnet"], &natnet("frame_3_0")[..100]);
    assert_eq!(ended.code, Some(1));
    assert!(ended.out.starts_with("NatNet FRAMEOFDATA malformed\n"), "{}", ended.out);
    assert!(ended.out.contains("other_markers.count"), "{}", ended.out);
    assert!(
        ended.out.contains("\nmalformed\n  other markers: expected "),
        "{}",
        ended.out
    );
}

#[test]
fn captured_natnet_packets_are_told_by_their_bytes() {
    for (name, version, number) in [
        ("mocapframe_packet_v3", "4.0", Some(162_734)),
        ("modeldef_packet_v3", "3.0", None),
        ("frame-motive-1.7.2-001", "2.7", Some(411_213)),
    ] {
        let Some(path) = reference(&format!("natnet/{name}.bin")) else {
            return;
        };
        let object = object(&explain(&[path.to_str().unwrap(), "--json"], b""));
        assert_eq!(object["bitstream"]["version"], version, "{name}");
        assert_eq!(
            (&object["quirks"], &object["error"]),
            (&serde_json::json!([]), &Value::Null)
        );
        let field = &object["fields"][2];
        assert_eq!(
            field["value"].as_u64().filter(|_| field["name"] == "frame_number"),
            number
        );
    }
}

#[test]
fn the_version_of_the_program_is_asked_for_with_v() {
    let folder = tempfile::tempdir().unwrap();
    let ended = posewire(folder.path(), &["explain", "-V"], b"");
    let version = concat!(env!("CARGO_PKG_VERSION"), "\n");
    assert!(
        ended.code == Some(0) && ended.out.ends_with(version),
        "{}{}",
        ended.out,
        ended.err
    );
}
