//! The program as a child process, and where its test data is.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::thread::{self, JoinHandle};

/// How the program ended and what it said.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// Runs the program in a folder with these arguments and this standard input.
pub(crate) fn posewire(folder: &Path, arguments: &[&str], input: &[u8]) -> Ended {
    let mut child = Command::new(env!("CARGO_BIN_EXE_posewire"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that has failed already reads no input.
    let _ = child.stdin.take().unwrap().write_all(input);
    let output = child.wait_with_output().unwrap();
    Ended {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// `posewire monitor`, listening.
pub(crate) struct Monitor {
    pub(crate) endpoint: String,
    child: Child,
    out: JoinHandle<String>,
    err: BufReader<ChildStderr>,
}

impl Monitor {
    /// Starts it with these arguments and waits until it listens.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_posewire"))
            .arg("monitor")
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut err = BufReader::new(child.stderr.take().unwrap());
        let mut out = child.stdout.take().unwrap();
        let out = thread::spawn(move || {
            let mut text = String::new();
            out.read_to_string(&mut text).unwrap();
            text
        });
        let mut line = String::new();
        err.read_line(&mut line).unwrap();
        let endpoint = line.strip_prefix("listening on ").unwrap_or_else(|| panic!("{line}"));
        Self {
            endpoint: endpoint.trim_end().to_owned(),
            child,
            out,
            err,
        }
    }

    /// Asks it to end, as Ctrl-C does.
    #[cfg(unix)]
    pub(crate) fn interrupt(&self) {
        let process = self.child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-INT", &process])
                .status()
                .unwrap()
                .success()
        );
    }

    /// Waits until it has ended.
    pub(crate) fn end(mut self) -> Ended {
        let mut err = String::new();
        self.err.read_to_string(&mut err).unwrap();
        Ended {
            code: self.child.wait().unwrap().code(),
            out: self.out.join().unwrap(),
            err,
        }
    }
}

/// `posewire stream`, passing on a live stream; it ends with the test.
pub(crate) struct Relay {
    pub(crate) endpoint: String,
    /// The datagram types that it announces.
    pub(crate) types: String,
    child: Child,
    err: BufReader<ChildStderr>,
}

impl Relay {
    /// Starts it with these arguments and waits until it listens.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_posewire"))
            .arg("stream")
            .args(arguments)
            .stdin(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut err = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        err.read_line(&mut line).unwrap();
        let endpoint = line.strip_prefix("streaming ").and_then(|rest| rest.split(',').next());
        let types = line.split_once(", types ").map_or("", |(_, types)| types.trim());
        Self {
            endpoint: endpoint.unwrap_or_else(|| panic!("{line}")).to_owned(),
            types: types.to_owned(),
            child,
            err,
        }
    }

    /// What it says until a line has these words; all until its end when none has.
    pub(crate) fn read_until(&mut self, words: &str) -> String {
        let mut said = String::new();
        while !said.contains(words) && self.err.read_line(&mut said).unwrap() > 0 {}
        said
    }
}

impl Drop for Relay {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The JSON objects of an output that are of this kind.
pub(crate) fn objects(out: &str, kind: &str) -> Vec<serde_json::Value> {
    let objects = out.lines().map(|line| serde_json::from_str(line).unwrap());
    objects
        .filter(|object: &serde_json::Value| object["kind"] == kind)
        .collect()
}

/// Asserts that an object has the fields that a section of docs/json.md describes and no others, but for those of
/// `optional`, which it may lack.
pub(crate) fn assert_documented(object: &serde_json::Value, kind: &str, optional: &[&str]) {
    let text = include_str!("../../../../docs/json.md");
    let (_, table) = text.split_once(&format!("| `kind` | `\"{kind}\"` |")).unwrap();
    let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
    let documented: Vec<_> = rows
        .flat_map(|row| row.split('|').nth(1).unwrap().split('`').skip(1).step_by(2))
        .chain(["kind"])
        .collect();
    let fields = object.as_object().unwrap();
    for field in fields.keys() {
        assert!(
            documented.contains(&field.as_str()),
            "{field} of {kind} is not in docs/json.md"
        );
    }
    for field in documented {
        let there = fields.contains_key(field) || optional.contains(&field);
        assert!(there, "docs/json.md has {field}, the {kind} has not: {object}");
    }
}

/// The project's own datagrams.
pub(crate) fn vectors() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/mxtp")
}

/// A file of recorded data that does not come with the project, when it is there.
pub(crate) fn reference(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data")
        .join(name);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: reference data not here");
    None
}

/// Checks that a text fits on a page of 100 columns.
pub(crate) fn assert_fits(text: &str) {
    for line in text.lines() {
        assert!(line.chars().count() <= 100, "{line}");
        assert_eq!(line, line.trim_end());
    }
}
