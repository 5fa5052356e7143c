//! What a recording holds, and making one whole that was cut off.

use crate::cli::Inspect;
use crate::command::End;
use crate::context::say;
use crate::error::Usage;
use crate::plain::plural;
use crate::render::LaterFile;
use crate::{json, render};
use anyhow::Context;
use posewire::capture::{Capture, CaptureOptions};
use posewire::recording::{Survey, is_being_recorded, recover};
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Whether a file says of itself that it is an MCAP file.
pub(super) fn is_one(path: &Path) -> bool {
    let mut beginning = [0; MAGIC.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut beginning));
    read.is_ok() && beginning == *MAGIC
}

/// Only recordings can be recovered.
pub(super) fn refuse(arguments: &Inspect) -> anyhow::Result<()> {
    if !arguments.recovery.recover {
        return Ok(());
    }
    let path = arguments.file.as_path();
    let mut beginning = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MAGIC.len() as u64).read_to_end(&mut beginning))
        .map_err(|error| posewire::Error::read(path, &error))?;
    let name = path.display();
    let help = if beginning.starts_with(b"<") || name.to_string().contains(".mvnx") {
        "--salvage uses a damaged take up to the damage"
    } else {
        "give a file that posewire record has written"
    };
    let problem = if beginning.is_empty() {
        format!("{name} is empty: there is nothing to recover")
    } else {
        let beginning = beginning.escape_ascii();
        format!("--recover is for recordings, {name} is none: it begins with \"{beginning}\"")
    };
    let help = help.to_owned();
    Err(Usage { problem, help }.into())
}

pub(super) fn run(arguments: &Inspect) -> anyhow::Result<End> {
    let mut files = files_from(&arguments.file);
    if arguments.recovery.recover {
        files = recover_all(&files, arguments.recovery.output.as_deref())?;
    }
    let (file, later) = files.split_first().context("no file was named")?;
    let survey = Survey::of(file)?;
    let bytes = fs::metadata(file)
        .map_err(|error| posewire::Error::read(file, &error))?
        .len();
    let later = later
        .iter()
        .map(|path| LaterFile::of(path))
        .collect::<Result<Vec<_>, _>>()?;
    let is_recorded = is_being_recorded(file);
    if arguments.json {
        json::print(&json::RecordingFileRecord::new(
            file,
            bytes,
            &survey,
            is_recorded,
            &later,
        ))?;
    } else {
        let text = render::recording(file, bytes, &survey, is_recorded, &later);
        std::io::stdout().lock().write_all(text.as_bytes())?;
    }
    Ok(End::Done)
}

/// The files of a recording that was split, of which this is the first; else the file alone.
fn files_from(file: &Path) -> Vec<PathBuf> {
    match Capture::open(file, &CaptureOptions::default()) {
        Ok(capture) => capture.files().to_vec(),
        Err(error) => {
            if let posewire::Error::MissingPart { .. } = error {
                say(&error);
            }
            vec![file.to_owned()]
        }
    }
}

/// Completes each file that lacks its end, in its place or as `output` and those behind it. Gives where they are.
fn recover_all(files: &[PathBuf], output: Option<&Path>) -> anyhow::Result<Vec<PathBuf>> {
    let mut whole = Vec::new();
    for (number, file) in (1_u32..).zip(files) {
        let to = output.map_or_else(|| file.clone(), |output| numbered(output, number));
        if output.is_none() && !is_being_recorded(file) && Survey::of(file)?.complete {
            say(format_args!("{} is complete", file.display()));
        } else {
            let recovered = recover(file, &to).map_err(refuse_existing)?;
            let messages = plural(recovered.messages, "message");
            say(format_args!("{messages} of {} are in {}", file.display(), to.display()));
        }
        whole.push(to);
    }
    Ok(whole)
}

/// There is no `--overwrite` here: a recording is recovered once.
fn refuse_existing(error: posewire::Error) -> anyhow::Error {
    match error {
        posewire::Error::Exists { path } => Usage {
            problem: format!("{} is there already", path.display()),
            help: "choose another name; without -o the recording is completed in its place".to_owned(),
        }
        .into(),
        error => error.into(),
    }
}

/// `whole-002.mcap` for the second file of `whole.mcap`.
fn numbered(output: &Path, number: u32) -> PathBuf {
    if number == 1 {
        return output.to_owned();
    }
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{stem}-{number:03}");
    output.with_file_name(match output.extension() {
        Some(extension) => format!("{name}.{}", extension.to_string_lossy()),
        None => name,
    })
}

const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";
