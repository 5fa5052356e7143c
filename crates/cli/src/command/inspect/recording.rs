//! What a recording holds, and making one whole that was cut off.

use crate::cli::Inspect;
use crate::command::End;
use crate::context::say;
use crate::error::Usage;
use crate::plain::plural;
use crate::{json, render};
use posewire::recording::{Survey, recover};
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::Path;

/// Whether a file says of itself that it is an MCAP file.
pub(super) fn is_one(path: &Path) -> bool {
    let mut beginning = [0; MAGIC.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut beginning));
    read.is_ok() && beginning == *MAGIC
}

/// Only recordings can be recovered.
pub(super) fn refuse(arguments: &Inspect) -> Result<(), Usage> {
    if !arguments.recovery.recover {
        return Ok(());
    }
    Err(Usage {
        problem: format!("--recover is for recordings, {} is none", arguments.file.display()),
        help: "--salvage uses a damaged take up to the damage".to_owned(),
    })
}

pub(super) fn run(arguments: &Inspect) -> anyhow::Result<End> {
    let mut file = arguments.file.as_path();
    if arguments.recovery.recover {
        let to = arguments.recovery.output.as_deref().unwrap_or(file);
        let recovered = recover(file, to)?;
        if recovered.was_complete {
            say(format_args!("{} was complete", file.display()));
        }
        let messages = plural(recovered.messages, "message");
        say(format_args!("{messages} of {} are in {}", file.display(), to.display()));
        file = to;
    }
    let survey = Survey::of(file)?;
    let bytes = fs::metadata(file)
        .map_err(|error| posewire::Error::read(file, &error))?
        .len();
    if arguments.json {
        json::print(&json::RecordingFileRecord::new(file, bytes, &survey))?;
    } else {
        let text = render::recording(file, bytes, &survey);
        std::io::stdout().lock().write_all(text.as_bytes())?;
    }
    Ok(End::Done)
}

const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";
