//! `posewire stream` to `posewire monitor`.

use crate::program::{Monitor, Relay, assert_documented, objects, posewire};
use crate::takes::small_take;
use std::fs;
use std::path::Path;

fn here() -> &'static Path {
    Path::new(".")
}

#[test]
fn a_walker_is_streamed_and_monitored_with_all_that_it_has() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--frames", "--count", "30"]);
    let walk = "synthetic:walk?rate=60&props=1&fingers=true";
    let arguments = [
        "stream",
        walk,
        "--types",
        "all",
        "--duration",
        "1",
        "--json",
        "--to",
        &monitor.endpoint,
    ];
    let streamed = posewire(here(), &arguments, b"");
    assert_eq!(streamed.code, Some(0), "{}", streamed.err);
    let summary = &objects(&streamed.out, "stream")[0];
    assert_eq!(
        (&summary["frames"], &summary["lost"], &summary["unsent"]),
        (&60.into(), &0.into(), &0.into())
    );

    assert_documented(summary, "stream", &[]);
    assert_eq!(summary["targets"][0]["peers"], 1);

    let ended = monitor.running.end();
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let frames = objects(&ended.out, "frame");
    assert_eq!(frames.len(), 30);
    let frame = &frames[29];
    assert_documented(frame, "frame", &[]);
    assert_eq!((&frame["sample"], &frame["time_ms"]), (&29.into(), &483.into()));
    assert_eq!(frame["segments"].as_array().unwrap().len(), 64);
    assert_eq!(frame["segments"][0]["name"], "Pelvis");
    assert_eq!(
        frame["segments"][0]["angular_acceleration"].as_array().unwrap().len(),
        3
    );
    assert_eq!(frame["joint_angles"][21]["name"], "jLeftBallFoot");
    assert_eq!(frame["ergonomic_angles"].as_array().unwrap().len(), 6);
    assert_eq!(frame["sensors"].as_array().unwrap().len(), 17);
    assert_eq!(frame["center_of_mass"]["velocity"].as_array().unwrap().len(), 3);
    assert!(frame["markers"].as_array().unwrap().len() > 30);
    let subject = &objects(&ended.out, "subject").pop().unwrap();
    assert_documented(subject, "subject", &[]);
    assert_eq!(
        (&subject["name"], &subject["segments"][22]["name"]),
        (&"Ada".into(), &"LeftToe".into())
    );
    assert_eq!(subject["segments"][0]["points"][12]["name"], "pSacrum");
    assert_documented(&objects(&ended.out, "receiver")[0], "receiver", &[]);
    let statistics = objects(&ended.out, "statistics");
    let pose = statistics.iter().rfind(|object| object["type"] == "02").unwrap();
    assert_documented(pose, "statistics", &[]);
    let readme = include_str!("../../../../README.md");
    let shown = readme.lines().find(|line| line.starts_with("{\"kind\"")).unwrap();
    assert_documented(&serde_json::from_str(shown).unwrap(), "statistics", &[]);
    assert_eq!(
        (&pose["missing"], &pose["stride"], &pose["ended"]),
        (&0.into(), &1.into(), &true.into())
    );
    assert!((pose["rate_hz"].as_f64().unwrap() - 60.0).abs() < 15.0, "{pose}");
}

#[test]
fn a_live_stream_is_passed_on_and_peers_are_told_of() {
    let monitor = Monitor::start(&["mxtp+tcp://127.0.0.1:0", "--json", "--frames", "--count", "12"]);
    let mut relay = Relay::start(&["mxtp://127.0.0.1:0", "--to", &monitor.endpoint, "--duration", "20"]);
    let arguments = [
        "stream",
        "synthetic:walk?rate=60",
        "--duration",
        "1",
        "--to",
        &relay.endpoint,
    ];
    assert_eq!(posewire(here(), &arguments, b"").code, Some(0));
    let monitored = monitor.endpoint.clone();
    assert_eq!(objects(&monitor.running.end().out, "frame").len(), 12);
    let said = relay.running.read_until(|line| line.contains("0 peers connected"));
    let told = format!("{monitored}: 0 peers connected");
    assert!(said.contains(&told), "{said}");
}

#[test]
fn a_take_is_given_a_number_and_a_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.mvnx"), small_take(12)).unwrap();
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--frames", "--count", "12"]);
    let arguments = [
        "stream",
        "small.mvnx",
        "--character",
        "3",
        "--name",
        "Cleo",
        "--to",
        &monitor.endpoint,
    ];
    let streamed = posewire(folder.path(), &[&arguments[..], &["--types", "02,12"]].concat(), b"");
    assert_eq!(streamed.code, Some(0), "{}", streamed.err);
    assert!(
        streamed.err.starts_with("streaming small.mvnx: Bea, 2 segments, 60 Hz"),
        "{}",
        streamed.err
    );

    let frames = objects(&monitor.running.end().out, "frame");
    assert_eq!(frames.len(), 12);
    assert_eq!(
        (&frames[11]["character"], &frames[11]["name"]),
        (&3.into(), &"Cleo".into())
    );
    assert_eq!(frames[6]["segments"][0]["position"], serde_json::json!([0.1, 0.0, 0.9]));
}

#[test]
fn a_loop_counts_on() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.mvnx"), small_take(6)).unwrap();
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--frames", "--count", "15"]);
    let arguments = [
        "stream",
        "small.mvnx",
        "--loop",
        "--duration",
        "0.35",
        "--types",
        "02",
        "--to",
        &monitor.endpoint,
    ];
    assert_eq!(posewire(folder.path(), &arguments, b"").code, Some(0));
    let frames = objects(&monitor.running.end().out, "frame");
    assert!(
        frames
            .iter()
            .map(|frame| frame["sample"].as_u64())
            .eq((0..15).map(Some))
    );
}

#[test]
fn what_a_take_lacks_is_refused_by_number_and_left_out_of_all() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.mvnx"), small_take(6)).unwrap();
    let refused = posewire(folder.path(), &["stream", "small.mvnx", "--types", "02,23"], b"");
    assert_eq!(refused.code, Some(2));
    assert!(
        refused
            .err
            .contains("cannot send type 23 (motion trackers): the source has no sensor data"),
        "{}",
        refused.err
    );
    assert!(
        refused.err.contains("\nhelp: leave 23 out of --types"),
        "{}",
        refused.err
    );

    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--count", "6"]);
    let all = posewire(
        folder.path(),
        &["stream", "small.mvnx", "--types", "all", "--to", &monitor.endpoint],
        b"",
    );
    assert_eq!(all.code, Some(0), "{}", all.err);
    assert!(all.err.contains("leaving out type 23"), "{}", all.err);
    monitor.running.end();
}

#[test]
#[cfg(unix)]
fn a_damaged_take_is_used_up_to_the_damage_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let whole = small_take(12);
    let cut = whole.len() - 300;
    fs::write(folder.path().join("cut.mvnx"), &whole[..cut]).unwrap();
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--count", "1000"]);
    let arguments = ["stream", "cut.mvnx", "--types", "02", "--to", &monitor.endpoint];
    let refused = posewire(folder.path(), &arguments, b"");
    assert_eq!(refused.code, Some(1), "{}", refused.err);
    assert!(refused.err.contains("the file ends inside"), "{}", refused.err);
    assert!(refused.err.contains("help: --salvage"), "{}", refused.err);

    let salvaged = posewire(folder.path(), &[&arguments[..], &["--salvage", "--json"]].concat(), b"");
    assert_eq!(salvaged.code, Some(3), "{}", salvaged.err);
    assert!(salvaged.err.contains("the file is damaged"), "{}", salvaged.err);
    assert_eq!(objects(&salvaged.out, "stream")[0]["frames"], 11);
    monitor.running.interrupt();
    monitor.running.end();
}

#[test]
fn nothing_is_computed_that_no_target_has_a_place_for() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.mvnx"), small_take(3)).unwrap();
    let target = "natnet://127.0.0.1:0?data-port=0";
    let ended = posewire(
        folder.path(),
        &["stream", "take.mvnx", "--no-wait", "--to", target],
        b"",
    );
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.err.contains("sent 3 samples"), "{}", ended.err);
    assert!(
        !ended.err.contains("computed") && !ended.err.contains("left out"),
        "{}",
        ended.err
    );
}

#[test]
fn what_is_left_out_is_said_once_however_short_the_stream_and_many_the_targets() {
    let target = "natnet://127.0.0.1:0?data-port=0";
    let walk = "synthetic:walk?rate=60";
    let targets = ["--to", target, "--to", target];
    let arguments = ["stream", walk, "--no-wait", "--duration", "0.05"];
    let ended = posewire(here(), &[&arguments[..], &targets].concat(), b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let said: Vec<_> = ended.err.lines().filter(|line| line.starts_with("left out")).collect();
    let &[line] = said.as_slice() else {
        panic!("{}", ended.err)
    };
    assert_eq!(line.matches("joint angles").count(), 1, "{line}");
}
