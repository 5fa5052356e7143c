//! The tests' own Python, and what runs in it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Why there is no report.
#[derive(Clone, Debug)]
pub(crate) enum Failure {
    /// What the test needs is not on this machine; it is to be skipped.
    Absent(String),
    /// Something went wrong.
    Broken(String),
}

/// The interpreter that `tests/peers/install` has given the packages to.
pub(crate) struct Python(PathBuf);

impl Python {
    /// # Errors
    /// Why the package is not there.
    pub(crate) fn with(package: &str) -> Result<Self, Failure> {
        let place = root().join("target/peers");
        let missing = fs::read_to_string(place.join("missing"))
            .map_err(|_| Failure::Absent("tests/peers/install has not been run".to_owned()))?;
        let mut lines = missing.lines().filter_map(|line| line.split_once(": "));
        match lines.find(|(name, _)| *name == package || *name == "everything") {
            None => Ok(Self(place.join("venv/bin/python"))),
            Some((_, reason)) => Err(Failure::Absent(format!("{package} cannot be installed: {reason}"))),
        }
    }

    /// Runs a script of `tests/peers` and gives the JSON object that it prints.
    ///
    /// # Errors
    /// How the script failed.
    pub(crate) fn run(&self, script: &str, arguments: &[&str]) -> Result<serde_json::Value, Failure> {
        let output = Command::new(&self.0)
            .arg("-Bs")
            .arg(root().join("tests/peers").join(script))
            .args(arguments)
            .output()
            .map_err(|error| Failure::Broken(format!("{}: {error}", self.0.display())))?;
        let out = String::from_utf8_lossy(&output.stdout);
        let report = out.lines().rfind(|line| line.starts_with('{'));
        report.and_then(|line| serde_json::from_str(line).ok()).ok_or_else(|| {
            let err = String::from_utf8_lossy(&output.stderr);
            Failure::Broken(format!("{script} ended with {}: {out}{err}", output.status))
        })
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
