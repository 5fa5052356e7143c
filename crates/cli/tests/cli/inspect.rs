//! `posewire inspect`.

use crate::program::{Ended, assert_documented, assert_fits, posewire, reference};
use serde_json::{Value, json};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A take of two segments, whose hip opens by 7 mm at sample 5.
fn take() -> String {
    let mut text = r##"<?xml version="1.0" encoding="UTF-8"?>
<mvnx version="4">
<mvn version="2021.2" build="7"/>
<comment>first of three</comment>
<weather>mild</weather>
<subject label="Ada" torsoColor="#102030" frameRate="10" segmentCount="2" recDate="Fri May 1 2020" configuration="FullBody">
<segments>
<segment label="Pelvis" id="1"><points>
<point label="pHipOrigin"><pos_b>0 0 0</pos_b></point><point label="jRightHip"><pos_b>0 -0.1 0</pos_b></point>
</points></segment>
<segment label="RightUpperLeg" id="2"><points><point label="jRightHip"><pos_b>0 0 0</pos_b></point></points></segment>
</segments>
<sensors><sensor label="Pelvis"/></sensors>
<joints><joint label="jRightHip"><connector1>Pelvis/jRightHip</connector1><connector2>RightUpperLeg/jRightHip</connector2></joint></joints>
<frames segmentCount="2" sensorCount="1" jointCount="1">
<frame time="0" index="" tc="" ms="0" type="identity"><orientation>1 0 0 0 1 0 0 0</orientation><position>0 0 1 0 -0.1 1</position></frame>
"##
    .to_owned();
    for (sample, gap, marker) in [
        (3, 0.001, ""),
        (4, 0.002, "<marker>clap</marker>"),
        (5, 0.007, ""),
        (8, 0.0, ""),
    ] {
        let (time, ms) = (sample * 100, 3_600_000 + sample * 100);
        let hip = -0.1 - gap;
        writeln!(
            text,
            r#"<frame time="{time}" index="{sample}" ms="{ms}" type="normal">
<orientation>1 0 0 0 1 0 0 0</orientation><position>0 0 1 0 {hip:.6} 1</position>
<sensorOrientation>1 0 0 0</sensorOrientation><jointAngle>1 2 3</jointAngle><mood>7 8</mood>{marker}</frame>"#
        )
        .unwrap();
    }
    text + "</frames></subject></mvnx>\n"
}

fn folder(name: &str, content: impl AsRef<[u8]>) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join(name), content).unwrap();
    folder
}

fn inspect(folder: &Path, arguments: &[&str]) -> Ended {
    posewire(folder, &[&["inspect"], arguments].concat(), b"")
}

fn object(ended: &Ended) -> Value {
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    serde_json::from_str(&ended.out).unwrap()
}

#[test]
fn a_take_in_utf_16_is_told_as_one_in_utf_8() {
    let mut said = ["UTF-8", "UTF-16"].map(|encoding| {
        let text = take().replace("UTF-8", encoding);
        let wide = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let bytes = if encoding == "UTF-16" { wide } else { text.into_bytes() };
        object(&inspect(folder("take.mvnx", bytes).path(), &["take.mvnx", "--json"]))
    });
    assert_ne!(said[0]["bytes"], said[1]["bytes"]);
    said[1]["bytes"] = said[0]["bytes"].clone();
    assert_eq!(said[0], said[1]);
}

#[test]
fn a_take_is_told_on_one_page() {
    let folder = folder("take.mvnx", take());
    let expected = "\
take.mvnx
  format          MVNX 4, 1,977 bytes
  written by      MVN 2021.2
  build           7
  subject         Ada, colour 102030
  comment         first of three
  recorded        Fri May 1 2020
  configuration   FullBody

motion
  rate            10 Hz
  frames          4, samples 3 to 8
  duration        0.600 s
  time of day     01:00:00.300 to 01:00:00.800 UTC
  missing         2 samples: 6-7
  calibration     identity

skeleton
  segments        2: body 2
  points          3: Pelvis 2, RightUpperLeg 1
  joints          1
  angles          none
  sensors         1: Pelvis
  contacts        none

sections                   columns
  orientation                    8  2 segments           w x y z
  position                       6  2 segments           x y z              m
  sensorOrientation              4  1 sensor             w x y z
  jointAngle                     3  1 joint              x y z              deg

largest gaps between the two ends of a joint, mm
  worst           jRightHip 7.0 at sample 5
  all             jRightHip 7.0

events
  sample 4        clap

unknown elements
  weather                    once on line 5
  mood                       4 times, first on line 19
";
    let ended = inspect(folder.path(), &["take.mvnx"]);
    assert_eq!(ended, Ended::with(expected));
}

#[test]
fn json_says_the_same_in_metres_and_seconds() {
    let folder = folder("take.mvnx", take());
    let take = object(&inspect(folder.path(), &["take.mvnx", "--json"]));
    assert_documented(&take, "take", &["damage"]);
    assert_eq!(
        (&take["kind"], &take["file"], &take["complete"]),
        (&json!("take"), &json!("take.mvnx"), &json!(true))
    );
    assert_eq!(
        (&take["frames"], &take["rate_hz"], &take["duration_s"]),
        (&json!(4), &json!(10.0), &json!(0.6))
    );
    assert_eq!(
        take["first"],
        json!({ "sample": 3, "time_s": 0.3, "timecode": "01:00:00.300" })
    );
    assert_eq!(
        take["missing_samples"],
        json!({ "count": 2, "runs": [[6, 7]], "runs_left_out": 0 })
    );
    assert_eq!(take["events"], json!([{ "sample": 4, "name": "clap" }]));
    let worst = take["worst_gap"]["gap_m"].as_f64().unwrap();
    assert!((worst - 0.007).abs() < 1e-9);
    assert_eq!(
        (&take["worst_gap"]["joint"], &take["worst_gap"]["sample"]),
        (&json!("jRightHip"), &json!(5))
    );
    let unknown = json!([
        { "name": "weather", "line": 5, "count": 1 },
        { "name": "mood", "line": 19, "count": 4 },
    ]);
    assert_eq!(take["unknown_elements"], unknown);
    let position = json!({ "name": "position", "columns": 6, "unit": "m", "frames": 4, "line": 18 });
    assert_eq!(take["sections"][1], position);
}

#[test]
fn a_cut_take_is_an_error_or_salvaged() {
    let whole = take();
    let cut = &whole[..whole.rfind("<mood>").unwrap()];
    let folder = folder("cut.mvnx", cut);
    let ended = inspect(folder.path(), &["cut.mvnx"]);
    assert_eq!((ended.code, ended.out.as_str()), (Some(1), ""));
    assert!(ended.err.starts_with("error: cut.mvnx: line "), "{}", ended.err);
    assert!(ended.err.contains("\nhelp: --salvage "), "{}", ended.err);
    let take = object(&inspect(folder.path(), &["cut.mvnx", "--salvage", "--json"]));
    assert_eq!((&take["frames"], &take["complete"]), (&json!(3), &json!(false)));
    assert!(take["damage"].as_str().unwrap().starts_with("line "));
}

#[test]
fn the_content_counts_and_not_the_ending() {
    let folder = folder("take.xml", take());
    assert_eq!(object(&inspect(folder.path(), &["take.xml", "--json"]))["frames"], 4);
}

#[test]
fn what_a_take_says_cannot_steer_the_terminal() {
    let folder = folder(
        "take.mvnx",
        take().replace("Ada", "Ada&#27;[2J").replace("clap", "cl\u{9b}ap"),
    );
    let ended = inspect(folder.path(), &["take.mvnx"]);
    assert!(
        !ended.out.contains(|c: char| c.is_control() && c != '\n'),
        "{:?}",
        ended.out
    );
}

#[test]
fn what_is_no_take_is_named_with_the_way_out() {
    let folder = folder("packet.bin", b"MXTP02");
    fs::write(folder.path().join("noise.mvnx"), b"\0\x01\x02").unwrap();
    for (file, code, error) in [
        ("none.mvnx", 1, "error: cannot read none.mvnx: "),
        (
            "take.mvn",
            2,
            "error: take.mvn: the .mvn format is proprietary: export MVNX from MVN\nhelp: ",
        ),
        (
            "noise.mvnx",
            1,
            "error: noise.mvnx: expected an MVNX document, found binary data (00 01 02)",
        ),
        (
            "packet.bin",
            2,
            "error: packet.bin holds MXTP datagrams, inspect reads a take\nhelp: posewire explain packet.bin\n",
        ),
        (
            "mxtp://h",
            2,
            "error: mxtp://h is a live stream, inspect reads a take\nhelp: posewire monitor mxtp://h\n",
        ),
        (
            "synthetic:walk",
            2,
            "error: synthetic:walk is not a file\nhelp: posewire demo ",
        ),
    ] {
        let ended = inspect(folder.path(), &[file]);
        assert_eq!((ended.code, ended.out.as_str()), (Some(code), ""), "{file}");
        assert!(ended.err.starts_with(error), "{}", ended.err);
        assert!(ended.err.contains("\nhelp: "), "{}", ended.err);
    }
}

/// Six samples at 100 Hz of a hip that bends by 0.2 rad a sample, with what follows from it.
fn consistent_take() -> String {
    let mut text = r#"<mvnx version="4">
<subject label="Ada" frameRate="100" segmentCount="2">
<segments>
<segment label="Pelvis" id="1"><points><point label="jRightHip"><pos_b>0 0 0</pos_b></point></points></segment>
<segment label="RightUpperLeg" id="2"><points><point label="jRightHip"><pos_b>0 0 0</pos_b></point></points></segment>
</segments>
<joints><joint label="jRightHip"><connector1>Pelvis/jRightHip</connector1><connector2>RightUpperLeg/jRightHip</connector2></joint></joints>
<frames segmentCount="2" sensorCount="0" jointCount="1">
"#
    .to_owned();
    for sample in 0..6 {
        let (time, ms, lifted) = (sample * 10, 3_600_000 + sample * 10, 0.2 * f64::from(sample));
        let (w, y, degrees) = ((lifted / 2.0).cos(), -(lifted / 2.0).sin(), lifted.to_degrees());
        writeln!(
            text,
            r#"<frame time="{time}" index="{sample}" ms="{ms}" type="normal">
<orientation>1 0 0 0 {w:.6} 0 {y:.6} 0</orientation><position>{x:.6} 0 1 {x:.6} 0 1</position>
<velocity>2 0 0 2 0 0</velocity><angularVelocity>0 0 0 0 -20 0</angularVelocity>
<jointAngle>0 0 {degrees:.6}</jointAngle></frame>"#,
            x = 0.02 * f64::from(sample),
        )
        .unwrap();
    }
    text + "</frames></subject></mvnx>\n"
}

/// The part of the page that `--verify` adds.
fn verification(take: impl AsRef<[u8]>) -> String {
    let folder = folder("take.mvnx", take);
    let ended = inspect(folder.path(), &["take.mvnx", "--verify"]);
    assert_eq!((ended.code, ended.err.as_str()), (Some(0), ""));
    assert_fits(&ended.out);
    let place = ended.out.find("\nverification\n").unwrap();
    ended.out[place..].to_owned()
}

#[test]
fn a_take_that_agrees_with_itself_is_ok() {
    let expected = "
verification
  ok              joint angles ZXY: 0.0000 deg (limit 0.003)
  not there       joint angles XZY
  not there       ergonomic angles ZXY
  not there       ergonomic angles XZY
  ok              quaternion lengths off 1: 0.0000006 (limit 0.00001)
  ok              connector gaps: 0.0 mm (limit 50)
  ok              missing samples: 0 (limit 0)
  ok              out of order: 0 (limit 0)
  ok              untracked segments: 0 (limit 0)
  ok              clock jitter (p99): 0.0 ms (limit 5.0)
  not there       clock drift: the take is too short to tell
  ok              velocities: 0.000 m/s (limit 1.000)
  ok              angular velocities: 0.000 rad/s (limit 7.071)";
    let found = verification(consistent_take());
    let (checks, angles) = found.split_once("\n\n").unwrap();
    // Of what is hardly off, the last digit of a float decides which sample is worst.
    let lines = checks.lines().filter(|line| !line.starts_with("     "));
    let limit = |line: &str| line.rfind(')').map_or(line.len(), |end| end + 1);
    let lines: Vec<_> = lines.map(|line| &line[..limit(line)]).collect();
    assert_eq!(lines.join("\n"), expected);
    let titles = [
        "largest difference of the recomputed angles, degrees",
        "ZXY    sample        XZY    sample",
        "  jRightHip                    0.0000  ",
    ];
    assert!(
        angles.lines().zip(titles).all(|(line, title)| line.contains(title)),
        "{angles}"
    );
}

#[test]
fn what_is_wrong_with_a_take_is_told_with_its_place() {
    let take = consistent_take()
        .replace("<jointAngle>0 0 34.3", "<jointAngle>0 0 36.3")
        .replace("<position>0.040000 0 1 0.04", "<position>0.040000 0 1 0.14")
        .replace("<orientation>1 0 0 0 0.877583", "<orientation>1.1 0 0 0 0.877583")
        .replace("ms=\"3600030\"", "ms=\"3600080\"")
        .replace("index=\"5\"", "index=\"9\"")
        .replace("0 -20 0<", "0 2 0<");
    let found = verification(take);
    for line in [
        "  look at this    joint angles ZXY: 2.0000 deg (limit 0.003), jRightHip, sample 3\n",
        "  look at this    quaternion lengths off 1: 0.1000000 (limit 0.00001), Pelvis, sample 9\n",
        "  look at this    connector gaps: 100.0 mm (limit 50), jRightHip, sample 2\n",
        "  look at this    missing samples: 4 (limit 0), sample 5\n",
        "  look at this    clock jitter (p99): ",
        "  look at this    velocities: ",
        "  look at this    angular velocities: ",
    ] {
        assert!(found.contains(line), "{line}\nis not in\n{found}");
    }
}

#[test]
fn close_to_gimbal_lock_angles_are_counted() {
    // 89 degrees about X: the middle angle of ZXY.
    let take = take().replace(
        "<orientation>1 0 0 0 1 0 0 0</orientation><position>0 0 1 0 -0.107",
        "<orientation>1 0 0 0 0.713250 0.700909 0 0</orientation><position>0 0 1 0 -0.107",
    );
    let folder = folder("take.mvnx", take);
    let take = object(&inspect(folder.path(), &["take.mvnx", "--verify", "--json"]));
    let angle = &take["verification"]["joint_angles"][0];
    assert_eq!((&angle["name"], &angle["xzy"]), (&json!("jRightHip"), &json!(null)));
    assert_eq!(
        (&angle["zxy"]["near_pole"], &angle["zxy"]["sample"]),
        (&json!(1), &json!(3))
    );
    assert!((angle["zxy"]["difference_deg"].as_f64().unwrap() - 3.0).abs() < 1e-9);
    let checks = take["verification"]["checks"].as_array().unwrap();
    assert_eq!(checks[0]["verdict"], "look at this");
    assert_eq!(checks[0]["note"], "1 close to gimbal lock not compared");
}

#[test]
fn a_verification_has_its_documented_fields() {
    let folder = folder("take.mvnx", take());
    let take = object(&inspect(folder.path(), &["take.mvnx", "--verify", "--json"]));
    assert_documented(&take, "take", &["damage"]);
    let text = include_str!("../../../../docs/json.md");
    for (table, object) in [
        ("| field of `verification` |", &take["verification"]),
        ("| field of a member of `checks` |", &take["verification"]["checks"][0]),
    ] {
        let (_, rows) = text.split_once(table).unwrap();
        let (rows, _) = rows.split_once("\n\n").unwrap();
        let names = rows
            .lines()
            .skip(2)
            .flat_map(|row| row.split('|').nth(1).unwrap().split('`').skip(1).step_by(2));
        let mut documented: Vec<_> = names.collect();
        let mut found: Vec<_> = object.as_object().unwrap().keys().map(String::as_str).collect();
        documented.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, documented);
    }
    assert_eq!(
        object(&inspect(folder.path(), &["take.mvnx", "--json"]))["verification"],
        json!(null)
    );
}

#[test]
fn reference_takes_agree_with_themselves() {
    for (name, joints, ergonomic) in [("mvnx/test_mocap.mvnx", 22, 4), ("mvnx/meri-020.mvnx", 22, 0)] {
        let Some(path) = reference(name) else { return };
        let arguments = [path.to_str().unwrap(), "--verify", "--json"];
        let verification = &object(&inspect(Path::new("."), &arguments))["verification"];
        for check in verification["checks"].as_array().unwrap() {
            assert_ne!(check["verdict"], "look at this", "{name}: {check}");
        }
        let compared = |angles: &Value, sequence: &str| {
            let all = angles.as_array().unwrap().iter();
            let compared = all.filter(|angle| {
                angle[sequence]["difference_deg"]
                    .as_f64()
                    .is_some_and(|off| off < 0.003)
            });
            assert!(
                angles
                    .as_array()
                    .unwrap()
                    .iter()
                    .all(|angle| angle[sequence]["near_pole"] == json!(0) || angle[sequence].is_null())
            );
            compared.count()
        };
        assert_eq!(compared(&verification["joint_angles"], "zxy"), joints);
        assert_eq!(compared(&verification["joint_angles"], "xzy"), joints);
        assert_eq!(compared(&verification["ergonomic_angles"], "zxy"), ergonomic);
    }
}

#[test]
fn reference_takes_are_told_on_one_page() {
    for (name, version, frames, sensors) in [("mvnx/test_mocap.mvnx", 4, 112, 11), ("mvnx/meri-020.mvnx", 3, 4, 17)] {
        let Some(path) = reference(name) else { return };
        let path = path.to_str().unwrap();
        let ended = inspect(Path::new("."), &[path]);
        let (_, page) = ended.out.split_once('\n').unwrap();
        assert_fits(page);
        let take = object(&inspect(Path::new("."), &[path, "--json"]));
        assert_eq!(
            (&take["mvnx_version"], &take["frames"]),
            (&json!(version), &json!(frames))
        );
        assert_eq!(take["sensors"].as_array().unwrap().len(), sensors);
        assert_eq!(take["segments"].as_array().unwrap().len(), 23);
        assert!(take["worst_gap"]["gap_m"].as_f64().unwrap() < 0.04);
        assert_eq!(take["unknown_elements"], json!([]));
    }
}
