//! `posewire monitor` of a NatNet server.

use crate::motive::Motive;
use crate::program::{Ended, assert_documented, objects, posewire};
#[cfg(unix)]
use crate::running::Running;
use posewire_natnet::Version;
use serde_json::Value;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Runs the monitor with these arguments against a server that sends while it runs.
fn monitored(version: Version, exposure: bool, arguments: &[&str]) -> Ended {
    let mut motive = Motive::open(version);
    let endpoint = motive.endpoint();
    let ended = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            let mut due = Instant::now();
            while !ended.load(Ordering::Relaxed) {
                motive.answer();
                if Instant::now() >= due {
                    motive.send(exposure);
                    due += Duration::from_millis(10);
                }
            }
        });
        let arguments = [&["monitor", &endpoint], arguments].concat();
        let seen = posewire(Path::new("."), &arguments, b"");
        ended.store(true, Ordering::Relaxed);
        seen
    })
}

/// The last object of a kind with these in two of its fields.
fn last<'a>(objects: &'a [Value], fields: &[(&str, Value)]) -> &'a Value {
    let is_it = |object: &&Value| fields.iter().all(|(field, value)| object[field] == *value);
    objects
        .iter()
        .rfind(is_it)
        .unwrap_or_else(|| panic!("{fields:?} is not in {objects:?}"))
}

#[test]
fn json_has_the_server_its_frames_and_who_is_tracked() {
    let arguments = ["--json", "--frames", "--count", "120"];
    let ended = monitored(Version::new(4, 1), true, &arguments);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(
        ended.err.starts_with("connecting to natnet://127.0.0.1:"),
        "{}",
        ended.err
    );

    let servers = objects(&ended.out, "server");
    let server = last(&servers, &[("ended", true.into())]);
    assert_documented(server, "server", &[]);
    assert_eq!(
        (&server["version"], &server["mode"], &server["connected"]),
        (&"4.1".into(), &"unicast".into(), &true.into())
    );
    assert_eq!(
        (&server["model"]["skeletons"], &server["model"]["rigid_bodies"]),
        (&1.into(), &2.into())
    );
    assert_eq!(
        server["latency_ms"]["camera_to_host"]["p50"].as_f64().map(f64::round),
        Some(5.0)
    );
    assert_eq!(
        server["latency_ms"]["software"]["p50"].as_f64().map(f64::round),
        Some(2.0)
    );
    let tracked: Vec<_> = server["subjects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| (&one["name"], &one["tracked"]))
        .collect();
    let (ada, wand, hat) = ("Ada".into(), "Wand".into(), "Hat".into());
    assert_eq!(tracked, [(&ada, &1.into()), (&wand, &1.into()), (&hat, &0.into())]);

    let statistics = objects(&ended.out, "statistics");
    let frames = last(&statistics, &[("type", "frame".into()), ("ended", true.into())]);
    assert_documented(frames, "statistics", &["character", "samples", "transit_ms"]);
    assert!(frames["received"].as_u64().is_some_and(|count| count >= 30), "{frames}");
}

#[test]
fn json_frames_leave_out_what_is_lost_and_name_markers() {
    let arguments = ["--json", "--frames", "--count", "8"];
    let ended = monitored(Version::new(3, 1), true, &arguments);
    let frames = objects(&ended.out, "frame");
    let ada = last(&frames, &[("name", "Ada".into())]);
    assert_eq!(ada["segments"].as_array().unwrap().len(), 1, "the chest is not tracked");
    let hat = last(&frames, &[("name", "Hat".into())]);
    assert!(hat.get("segments").is_none(), "{hat}");
    assert_documented(
        hat,
        "frame",
        &[
            "timecode",
            "segments",
            "joint_angles",
            "ergonomic_angles",
            "sensors",
            "center_of_mass",
            "markers",
        ],
    );
    let wand = last(&frames, &[("name", "Wand".into())]);
    assert_eq!(wand["segments"][0]["position"], serde_json::json!([0.0, 0.5, 1.0]));
    let loose = last(&frames, &[("name", "Markers".into())]);
    assert_eq!(
        (&loose["markers"][0]["id"], loose["markers"][0].get("name")),
        (&50_007.into(), None)
    );
}

#[test]
fn markers_have_the_names_that_a_server_gives_them() {
    let ended = monitored(Version::new(4, 1), true, &["--json", "--frames", "--count", "8"]);
    let frames = objects(&ended.out, "frame");
    let wand = last(&frames, &[("name", "Wand".into())]);
    assert_eq!(
        (&wand["markers"][0]["id"], &wand["markers"][0]["name"]),
        (&1.into(), &"Tip".into())
    );
}

#[test]
fn a_table_says_what_is_lost_and_why_a_latency_is_unknown() {
    let ended = monitored(Version::new(4, 1), false, &["--plain", "--count", "40"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    for part in [
        "NatNet 4.1, at 127.0.0.1:",
        "describes 1 skeleton, 2 rigid bodies",
        "camera to host: unknown: the cameras do not say when they exposed",
        "1 of 2 tracked",
    ] {
        assert!(ended.out.contains(part), "{part:?} is not in\n{}", ended.out);
    }
    let hat = ended.out.lines().rfind(|line| line.contains("Hat")).unwrap();
    assert!(hat.contains("rigid body LOST"), "{hat}");

    let ended = monitored(Version::new(2, 7), false, &["--plain", "--count", "40"]);
    let before = "host to here: unknown: frames have no times of it before NatNet 3.0";
    assert!(ended.out.contains(before), "{}", ended.out);
}

#[cfg(unix)]
#[test]
fn a_monitor_that_was_suspended_reads_what_has_waited() {
    let mut motive = Motive::open(Version::new(4, 1));
    let monitor = Running::start(Path::new("."), &["monitor", "--json", &motive.endpoint()]);
    motive.play(Duration::from_millis(1500));
    monitor.signal("-STOP");
    motive.play(Duration::from_millis(3500));
    monitor.signal("-CONT");
    motive.play(Duration::from_millis(1500));
    monitor.interrupt();
    let Ended { code, out, err } = monitor.end();
    assert_eq!(code, Some(0), "{err}");
    assert!(!err.contains("lost"), "{err}");
    let statistics = objects(&out, "statistics");
    let frames = last(&statistics, &[("type", "frame".into()), ("ended", true.into())]);
    assert_eq!((&frames["missing"], &frames["reset"]), (&0.into(), &0.into()));
    assert!(frames["received"].as_u64().is_some_and(|count| count > 200), "{frames}");
    let servers = objects(&out, "server");
    let server = last(&servers, &[("ended", true.into())]);
    let longest = server["latency_ms"]["host_to_here"]["max"].as_f64().unwrap();
    assert!(longest < 250.0, "frames were not late, but read late: {server}");
}

#[test]
fn a_server_that_does_not_answer_is_followed_by_what_to_check() {
    let silent = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let endpoint = format!("natnet://{}", silent.local_addr().unwrap());
    let ended = posewire(
        Path::new("."),
        &["monitor", &endpoint, "--plain", "--duration", "3.5"],
        b"",
    );
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(
        ended.err.contains(&format!("no answer from {endpoint}")),
        "{}",
        ended.err
    );
    assert!(ended.err.contains("Local Interface"), "{}", ended.err);
}

#[test]
fn to_explain_a_live_server_is_to_monitor_it() {
    let ended = posewire(Path::new("."), &["explain", "natnet://10.0.0.7"], b"");
    assert_eq!(ended.code, Some(2));
    assert!(ended.err.contains("explain reads a file"), "{}", ended.err);
    assert!(
        ended.err.contains("help: posewire monitor natnet://10.0.0.7"),
        "{}",
        ended.err
    );
}
