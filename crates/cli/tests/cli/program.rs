//! The program from its start to its end, and where its test data is.

use crate::running::Running;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How the program ended and what it said.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Ended {
    /// It ended well, printed this and said nothing.
    pub(crate) fn with(out: &str) -> Self {
        Self {
            code: Some(0),
            out: out.to_owned(),
            err: String::new(),
        }
    }
}

/// Runs the program in a folder with these arguments and this standard input.
pub(crate) fn posewire(folder: &Path, arguments: &[&str], input: &[u8]) -> Ended {
    let program = env!("CARGO_BIN_EXE_posewire");
    Running::run(folder, Command::new(program).args(arguments), input).end()
}

/// `posewire monitor`, listening.
pub(crate) struct Monitor {
    pub(crate) endpoint: String,
    pub(crate) running: Running,
}

impl Monitor {
    /// Starts it with these arguments and waits until it listens.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut running = Running::start(Path::new("."), &[&["monitor"], arguments].concat());
        let line = running.line();
        let endpoint = line.strip_prefix("listening on ").unwrap_or_else(|| panic!("{line}"));
        Self {
            endpoint: endpoint.trim_end().to_owned(),
            running,
        }
    }
}

/// `posewire stream`, passing on a live stream.
pub(crate) struct Relay {
    pub(crate) endpoint: String,
    /// The datagram types that it announces.
    pub(crate) types: String,
    pub(crate) running: Running,
}

impl Relay {
    /// Starts it with these arguments and waits until it listens.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut running = Running::start(Path::new("."), &[&["stream"], arguments].concat());
        let line = running.line();
        let endpoint = line.strip_prefix("streaming ").and_then(|rest| rest.split(',').next());
        let types = line.split_once(", types ").map_or("", |(_, types)| types.trim());
        Self {
            endpoint: endpoint.unwrap_or_else(|| panic!("{line}")).to_owned(),
            types: types.to_owned(),
            running,
        }
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
