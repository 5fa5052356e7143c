//! What a capture of packets holds.

use crate::cli::Inspect;
use crate::command::End;
use crate::error::Usage;
use crate::{json, render};
use posewire::Error;
use posewire::capture::{Capture, CaptureOptions, Survey};
use posewire::endpoint::Endpoint;
use posewire::stop::Stop;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Whether a file is one, or is called as if it were.
pub(super) fn is_one(path: &Path) -> bool {
    let named = matches!(path.to_string_lossy().parse(), Ok(Endpoint::Capture { .. }));
    // What is no file can be read only once.
    named || path.is_file() && Capture::open(path, &CaptureOptions::default()).is_ok()
}

/// What is only of captures, for what is none.
pub(super) fn refuse(arguments: &Inspect) -> Result<(), Usage> {
    if arguments.forced.is_none() {
        return Ok(());
    }
    Err(Usage {
        problem: format!(
            "--protocol is for captures of packets, {} is none",
            arguments.file.display()
        ),
        help: "leave --protocol out".to_owned(),
    })
}

pub(super) fn run(arguments: &Inspect, stop: &Stop) -> anyhow::Result<End> {
    refuse_of_takes(arguments)?;
    let file = arguments.file.as_path();
    let options = CaptureOptions {
        protocol: arguments.forced.map(Into::into),
    };
    let survey = Survey::of_any(file, &options, stop)?;
    let bytes = fs::metadata(file).map_err(|error| Error::read(file, &error))?.len();
    if arguments.json {
        json::print(&json::CaptureFileRecord::new(file, bytes, &survey))?;
    } else {
        let text = render::capture(file, bytes, &survey);
        std::io::stdout().lock().write_all(text.as_bytes())?;
    }
    Ok(End::Done)
}

/// A capture of packets has no poses to be verified, and is always used up to its damage.
fn refuse_of_takes(arguments: &Inspect) -> Result<(), Usage> {
    let given = [("--verify", arguments.verify), ("--salvage", arguments.salvage)];
    match given.into_iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!("{option} is for takes, {} is a capture", arguments.file.display()),
            help: format!("leave {option} out; posewire convert makes takes of a capture"),
        }),
    }
}
