//! Captures to captures: every datagram with its time.

use super::refuse;
use crate::cli::Convert;
use crate::command::End;
use crate::context::{self, say};
use crate::error::Usage;
use crate::json;
use crate::plain::plural;
use posewire::capture::{self, ConvertOptions};
use posewire::endpoint::Endpoint;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The capture that is read and the one that is written, where both paths are of captures.
pub(super) fn paths(arguments: &Convert) -> Option<(PathBuf, PathBuf)> {
    let [input, output] = arguments.paths.as_slice() else {
        return None;
    };
    let of = |path: &String| match path.parse() {
        Ok(Endpoint::Capture { path }) => Some(path),
        _ => None,
    };
    Some((of(input)?, of(output)?))
}

pub(super) fn run(input: &Path, output: &Path, arguments: &Convert) -> anyhow::Result<End> {
    let stops = context::stops_on_interrupt()?;
    let options = ConvertOptions {
        only: only(arguments)?,
        overwrite: arguments.overwrite,
    };
    let done = capture::convert(input, output, &options, &stops.work)?;
    if arguments.json {
        json::print(&Record {
            kind: "capture",
            input: &input.display().to_string(),
            output: &output.display().to_string(),
            datagrams: done.datagrams,
            damage: done.damage.as_deref(),
        })?;
    } else {
        let datagrams = plural(done.datagrams, "datagram");
        say(format_args!("{}: {datagrams}", output.display()));
    }
    if let Some(damage) = &done.damage {
        say(format_args!(
            "the capture is damaged, and what stands before that was converted: {damage}"
        ));
    }
    Ok(End::with_lost(u64::from(done.damage.is_some())))
}

/// The source that is named. Datagrams have no sections.
fn only(arguments: &Convert) -> Result<Option<String>, Usage> {
    if let Some(section) = arguments.sections().first() {
        return Err(Usage {
            problem: format!("--only {section}: datagrams are converted whole, expected a source or nothing"),
            help: "leave it out, or choose a source by number or name, as in --only 0".to_owned(),
        });
    }
    match arguments.sources().as_slice() {
        [] => Ok(None),
        [one] => Ok(Some((*one).to_owned())),
        [first, ..] => Err(refuse::several_sources(first)),
    }
}

/// What became of a capture.
#[derive(Serialize)]
struct Record<'a> {
    kind: &'static str,
    input: &'a str,
    output: &'a str,
    datagrams: u64,
    damage: Option<&'a str>,
}
