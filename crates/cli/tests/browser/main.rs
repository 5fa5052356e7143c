//! The page in a real Chromium, as its users see it.
//!
//! The tests themselves are scripts for Node.js in `crates/viewer/tests/e2e`, which start this program and drive the
//! browser. Without Chromium, Node.js or the packages of the page they are skipped with the reason;
//! `POSEWIRE_E2E=required` makes that a failure. The pictures that they take are kept in `target/e2e`.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

#[test]
fn performers_are_shown_as_they_are_streamed() {
    run("live.test.mjs");
}

#[test]
fn channels_are_plotted_with_their_values() {
    run("plots.test.mjs");
}

#[test]
fn takes_are_played_to_the_frame() {
    run("takes.test.mjs");
}

#[test]
fn views_are_kept_and_shared() {
    run("sharing.test.mjs");
}

#[test]
fn the_page_is_for_everybody() {
    run("access.test.mjs");
}

#[test]
fn a_page_that_is_stopped_disturbs_nobody() {
    run("stopped.test.mjs");
}

#[test]
fn takes_are_recorded_from_the_page() {
    run("recorder.test.mjs");
}

#[test]
fn pictures_are_taken_for_the_documentation() {
    run("pictures.test.mjs");
}

/// Runs one script, one at a time: a browser that draws in software takes a whole machine.
fn run(script: &str) {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let (chromium, web) = match found() {
        Ok(found) => found,
        Err(reason) if env::var("POSEWIRE_E2E").is_ok_and(|wish| wish == "required") => panic!("{reason}"),
        Err(reason) => return println!("skipped: {reason}"),
    };
    let output = Command::new("node")
        .args(["--test", "--test-reporter=spec", "--test-concurrency=1"])
        .arg(viewer().join("tests/e2e").join(script))
        .env("POSEWIRE", env!("CARGO_BIN_EXE_posewire"))
        .env("CHROMIUM", chromium)
        .env("WEB", web)
        .env("PICTURES", pictures())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// The browser, and the folder with the page's packages; or what is missing.
fn found() -> Result<(PathBuf, PathBuf), String> {
    let node = Command::new("node").arg("--version").output();
    if !node.is_ok_and(|output| output.status.success()) {
        return Err("no Node.js here".to_owned());
    }
    let chromium = NAMES.iter().find_map(|name| in_path(name));
    let chromium = chromium.ok_or_else(|| format!("no Chromium here (looked for {})", NAMES.join(", ")))?;
    let web = viewer().join("web");
    if !web.join("node_modules/playwright-core").is_dir() {
        return Err("playwright-core is not installed: run `npm ci` in crates/viewer/web".to_owned());
    }
    Ok((chromium, web))
}

fn in_path(name: &str) -> Option<PathBuf> {
    let folders = env::var_os("PATH")?;
    env::split_paths(&folders)
        .map(|folder| folder.join(name))
        .find(|path| path.is_file())
}

fn viewer() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../viewer")
}

/// Beside what cargo builds, which is what the program is.
fn pictures() -> PathBuf {
    let built = Path::new(env!("CARGO_BIN_EXE_posewire"));
    let target = built.ancestors().nth(2).unwrap_or(built);
    target.join("e2e")
}

/// What Chromium is called, where it is called anything.
const NAMES: &[&str] = &["chromium", "chromium-browser", "google-chrome-stable", "google-chrome"];
