//! A take that goes out as NatNet, seen by clients that others wrote: every position right, and no frame missing but
//! those that the system dropped at the client's own socket.
//!
//! Each client watches 1200 frames by their numbers, however long that takes, all clients at the same time. What is right, they
//! compute from the take itself.

use crate::python::{Failure, Python};
use crate::streaming::Streaming;
use crate::takes;
use serde_json::Value;
use std::fs;
use std::net::UdpSocket;
use std::path::Path;
use std::sync::LazyLock;
use std::thread;

#[test]
fn the_vendors_client_sees_4_1() {
    assert_all_seen("natnetsdk", "4.1");
}

#[test]
fn the_vendors_client_sees_3_1() {
    assert_all_seen("natnetsdk", "3.1");
}

#[test]
fn natnet_sees_what_is_sent_to_it() {
    assert_all_seen("natnet", "unicast");
}

#[test]
fn natnet_sees_what_is_sent_to_a_group() {
    assert_all_seen("natnet", "multicast");
}

#[test]
fn libmotioncapture_sees_a_body_at_the_data_port() {
    assert_all_seen("motioncapture", "copy");
}

#[test]
fn libmotioncapture_sees_a_body_that_is_sent_to_a_group() {
    assert_all_seen("motioncapture", "multicast");
}

#[test]
fn optirx_decodes_2_5() {
    assert_all_seen("optirx", "2.5");
}

#[test]
fn optirx_decodes_2_7() {
    assert_all_seen("optirx", "2.7");
}

/// A client, how it is served, and the version that it is to see.
struct Case {
    package: &'static str,
    /// What tells it from the other cases of the package.
    how: &'static str,
    script: &'static str,
    take: fn() -> String,
    /// The options of the target; `PORT` stands for a free port.
    options: &'static str,
    version: &'static str,
    /// Whether the client is alone with a server that waits for it, so that frame 0 is its first.
    from_the_first: bool,
    arguments: &'static [&'static str],
}

impl Case {
    /// Streams to the client and lets it watch.
    fn run(&self) -> Result<Value, Failure> {
        let python = Python::with(self.package)?;
        let folder = tempfile::tempdir().map_err(|error| Failure::Broken(error.to_string()))?;
        let take = folder.path().join("take.mvnx");
        fs::write(&take, (self.take)()).map_err(|error| Failure::Broken(error.to_string()))?;
        let target = format!("natnet://127.0.0.1:0?{}", self.options.replace("PORT", &free_port()));
        let streaming = Streaming::start(&take, &target).map_err(Failure::Broken)?;
        let report = self.watch(&python, &take, &streaming)?;
        match streaming.end() {
            Some(0) => Ok(report),
            code => Err(Failure::Broken(format!("posewire ended with {code:?}"))),
        }
    }

    fn watch(&self, python: &Python, take: &Path, streaming: &Streaming) -> Result<Value, Failure> {
        let take = take.to_string_lossy();
        let port = streaming.port();
        let mut arguments = vec![&*take, "--frames", FRAMES, "--server", "127.0.0.1", "--port", port];
        if let Some(port) = streaming.option("data-port") {
            arguments.extend(["--data-port", port]);
        }
        arguments.extend(self.arguments);
        python.run(self.script, &arguments)
    }
}

/// A port that nobody has. Another program may take it before it is used, which the test then says.
fn free_port() -> String {
    let port = UdpSocket::bind("127.0.0.1:0").and_then(|socket| socket.local_addr());
    port.map_or(0, |address| address.port()).to_string()
}

fn assert_all_seen(package: &str, how: &str) {
    let place = CASES
        .iter()
        .position(|case| (case.package, case.how) == (package, how))
        .unwrap();
    let report = match &REPORTS[place] {
        Ok(report) => report,
        Err(Failure::Absent(reason)) => return println!("skipped: {reason}"),
        Err(Failure::Broken(reason)) => panic!("{reason}"),
    };
    println!("{package}, {how}: {report}");
    for (what, right) in [("errors", "[]"), ("wrong", "0"), ("repeated", "0")] {
        assert_eq!(report[what].to_string(), right, "{what} in {report}");
    }
    assert_eq!(report["version"], CASES[place].version);
    assert_eq!(report["named"], package != "optirx", "{report}");
    let count = |what: &str| report[what].as_u64().unwrap();
    // What a client does not read in time on a busy machine, its own system drops and counts.
    assert!(count("missing") <= count("dropped"), "{report}");
    if CASES[place].from_the_first {
        assert!(count("first") <= count("dropped"), "{report}");
    }
}

/// What every client has reported, in the order of the cases.
static REPORTS: LazyLock<Vec<Result<Value, Failure>>> = LazyLock::new(|| {
    thread::scope(|scope| {
        let watching = CASES.each_ref().map(|case| scope.spawn(|| case.run()));
        let broken = |_| Err(Failure::Broken("the thread panicked".to_owned()));
        watching
            .into_iter()
            .map(|client| client.join().unwrap_or_else(broken))
            .collect()
    })
});

/// Ten seconds of the take, which is played in a loop.
const FRAMES: &str = "1200";

const CASES: [Case; 8] = [
    Case {
        package: "natnetsdk",
        how: "4.1",
        script: "natnet/sdk_client.py",
        take: takes::body,
        options: "data-port=0",
        version: "4.1",
        from_the_first: true,
        arguments: &[],
    },
    Case {
        package: "natnetsdk",
        how: "3.1",
        script: "natnet/sdk_client.py",
        take: takes::body,
        options: "data-port=0&version=3.1",
        version: "3.1",
        from_the_first: true,
        arguments: &[],
    },
    Case {
        package: "natnet",
        how: "unicast",
        script: "natnet/natnet_client.py",
        take: takes::body,
        options: "data-port=0",
        version: "4.1",
        from_the_first: true,
        arguments: &[],
    },
    Case {
        package: "natnet",
        how: "multicast",
        script: "natnet/natnet_client.py",
        take: takes::body,
        options: "mode=multicast&data-port=PORT",
        version: "4.1",
        from_the_first: false,
        arguments: &["--group", "239.255.42.99"],
    },
    Case {
        package: "motioncapture",
        how: "copy",
        script: "natnet/motioncapture_client.py",
        take: takes::wand,
        // The client binds the port that the server tells, so that one on the same machine leaves it free.
        options: "copy=true&data-port=PORT",
        version: "4.1",
        from_the_first: false,
        arguments: &[],
    },
    Case {
        package: "motioncapture",
        how: "multicast",
        script: "natnet/motioncapture_client.py",
        take: takes::wand,
        options: "mode=multicast&data-port=PORT",
        version: "4.1",
        from_the_first: false,
        arguments: &["--group", "239.255.42.99"],
    },
    Case {
        package: "optirx",
        how: "2.5",
        script: "natnet/optirx_client.py",
        take: takes::body,
        options: "data-port=0",
        version: "2.5",
        from_the_first: true,
        arguments: &["--version", "2.5"],
    },
    Case {
        package: "optirx",
        how: "2.7",
        script: "natnet/optirx_client.py",
        take: takes::body,
        options: "data-port=0",
        version: "2.7",
        from_the_first: true,
        arguments: &["--version", "2.7"],
    },
];
