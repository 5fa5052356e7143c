//! Builds the page with Node.js and embeds it.
//!
//! `POSEWIRE_NO_WEB=1` leaves it out, and so does a machine without Node.js; the program then serves a line that says how
//! to get the page. `POSEWIRE_WEB=required` makes a page that cannot be built an error. Nothing is written to the source
//! tree: where nobody has run `npm ci` in `web`, the sources are copied to cargo's folder and built there.

use std::env;
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for variable in ["POSEWIRE_NO_WEB", "POSEWIRE_WEB"] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    for source in SOURCES {
        println!("cargo::rerun-if-changed=web/{source}");
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo says where to write"));
    let page = if env::var_os("POSEWIRE_NO_WEB").is_some() {
        Err("POSEWIRE_NO_WEB is set".to_owned())
    } else {
        // Asked for when this runs: a target folder may outlive the clone that this was compiled in.
        let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo says where the crate is"));
        build(&here.join("web"), &out)
    };
    let list = match page {
        Ok(folder) => list(&folder).expect("what was just built can be read"),
        Err(reason) if env::var("POSEWIRE_WEB").is_ok_and(|wish| wish == "required") => panic!("no page: {reason}"),
        Err(reason) => {
            println!("cargo::warning=the browser page is left out: {reason}");
            "static ASSETS: &[Asset] = &[];\n".to_owned()
        }
    };
    fs::write(out.join("assets.rs"), list).expect("cargo's folder can be written");
}

/// Builds the page and gives the folder that it is in, or says why it could not be.
fn build(web: &Path, out: &Path) -> Result<PathBuf, String> {
    npm(&["--version"], web, out)?;
    let folder = if has_packages(web) {
        web.to_owned()
    } else {
        install(web, &out.join("web"), out)?
    };
    npm(&["run", "build"], &folder, out)?;
    Ok(out.join(BUILT))
}

/// Whether the packages that the page needs are in its folder already.
fn has_packages(web: &Path) -> bool {
    let changed = |name: &str| fs::metadata(web.join(name)).and_then(|about| about.modified()).ok();
    let (installed, asked) = (changed("node_modules/.package-lock.json"), changed("package-lock.json"));
    installed
        .zip(asked)
        .is_some_and(|(installed, asked)| installed >= asked)
}

/// A copy of the sources with the packages that they need.
fn install(web: &Path, folder: &Path, out: &Path) -> Result<PathBuf, String> {
    let lock = |folder: &Path| fs::read(folder.join("package-lock.json")).ok();
    let done = folder.join("node_modules/.package-lock.json").exists() && lock(folder) == lock(web);
    for source in SOURCES {
        copy(&web.join(source), &folder.join(source)).map_err(|error| format!("cannot copy web/{source}: {error}"))?;
    }
    if !done {
        npm(
            &["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline"],
            folder,
            out,
        )?;
    }
    Ok(folder.to_owned())
}

/// Copies a file, or a folder in place of the one that is there.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    if !from.is_dir() {
        fs::create_dir_all(to.parent().unwrap_or(to))?;
        return fs::copy(from, to).map(drop);
    }
    if to.exists() {
        fs::remove_dir_all(to)?;
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

fn npm(arguments: &[&str], folder: &Path, out: &Path) -> Result<(), String> {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let ran = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .env("POSEWIRE_WEB_OUT", out.join(BUILT))
        .output();
    let ran = ran.map_err(|error| format!("npm of Node.js 20 or newer does not run: {error}"))?;
    if ran.status.success() {
        return Ok(());
    }
    let said = [ran.stdout, ran.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    let lines: Vec<_> = said.lines().filter(|line| !line.trim().is_empty()).collect();
    let last = lines[lines.len().saturating_sub(20)..].join(" | ");
    Err(format!("npm {} failed: {last}", arguments.join(" ")))
}

/// The list of the page's files as Rust.
fn list(folder: &Path) -> io::Result<String> {
    let mut files = Vec::new();
    find(folder, &mut files)?;
    files.sort();
    let mut list = "static ASSETS: &[Asset] = &[\n".to_owned();
    for file in files {
        let name = file
            .strip_prefix(folder)
            .unwrap_or(&file)
            .to_string_lossy()
            .replace('\\', "/");
        // A path with a quote in it is still one string.
        let file = file.to_string_lossy();
        let _ = writeln!(list, "    ({name:?}, include_bytes!({file:?})),");
    }
    Ok(list + "];\n")
}

fn find(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}

/// What the page is made of, in `web`.
const SOURCES: [&str; 7] = [
    "index.html",
    "package.json",
    "package-lock.json",
    "public",
    "src",
    "tsconfig.json",
    "vite.config.ts",
];
/// Where it is built, in cargo's folder.
const BUILT: &str = "page";
