//! `posewire stream --faults`.

use crate::program::{Monitor, assert_documented, objects, posewire};
use std::path::Path;

const PLAN: &str = "loss=1%,dup=1%,reorder=1%,reset@1s,truncate=0.5%,seed=3";

fn streamed(to: &str, plan: &str) -> serde_json::Value {
    let walk = "synthetic:walk?rate=240";
    let arguments = [
        "stream",
        walk,
        "--to",
        to,
        "--duration",
        "2",
        "--faults",
        plan,
        "--json",
    ];
    let ended = posewire(Path::new("."), &arguments, b"");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(
        ended.err.contains(&format!("faults on purpose: {plan}")),
        "{}",
        ended.err
    );
    let summary = objects(&ended.out, "stream").remove(0);
    assert_documented(&summary, "stream", &[]);
    summary["faults"].clone()
}

#[test]
#[cfg(unix)]
fn what_the_sender_did_is_what_the_monitor_counts() {
    let monitor = Monitor::start(&["mxtp://127.0.0.1:0", "--json", "--duration", "60"]);
    let faults = streamed(&monitor.endpoint, PLAN);
    monitor.running.interrupt();
    let ended = monitor.running.end();
    let pose = objects(&ended.out, "statistics");
    let pose = pose.iter().rfind(|object| object["type"] == "02").unwrap();
    assert_documented(pose, "statistics", &[]);

    let streams = faults["streams"].as_array().unwrap();
    let made = &streams.iter().find(|stream| stream["type"] == "02").unwrap()["made"];
    let count = |of: &serde_json::Value, name: &str| of[name].as_u64().unwrap_or(0);
    let lost = count(made, "loss") + count(made, "truncate");
    assert_eq!(count(pose, "received"), 480 - lost, "{made} {pose}");
    assert_eq!(count(pose, "duplicate"), count(made, "dup"));
    assert_eq!(count(pose, "late"), count(made, "reorder"));
    assert_eq!(
        (count(pose, "reset"), count(pose, "rewound"), count(pose, "jumped")),
        (1, 0, 0)
    );
    let receiver = objects(&ended.out, "receiver");
    let receiver = receiver.last().unwrap();
    assert_eq!(receiver["datagrams"], faults["sent"]);
    assert_eq!(receiver["malformed"], faults["made"]["truncate"]);
}

#[test]
fn the_same_seed_makes_the_same_faults_whenever_it_is_played() {
    let to = "mxtp://127.0.0.1:9";
    let plan = "loss=5%,dup=5%,reorder=5%,seed=9";
    assert_eq!(streamed(to, plan), streamed(to, plan));
}

#[test]
fn a_plan_that_is_none_is_refused_with_its_place() {
    let arguments = ["stream", "synthetic:walk", "--faults", "loss=1%,dup=much"];
    let ended = posewire(Path::new("."), &arguments, b"");
    assert_eq!(ended.code, Some(2), "{}", ended.err);
    let expected = "error: faults: expected a share from 0% to 100%, as in 0.5% at character 12, found \"much\"";
    assert!(ended.err.contains(expected), "{}", ended.err);
    assert!(ended.err.contains("help: as in --faults"), "{}", ended.err);
}
