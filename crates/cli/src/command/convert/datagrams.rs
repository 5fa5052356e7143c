//! Captures to captures: every datagram with its time.

use crate::cli::Convert;
use crate::command::End;
use crate::context::{self, say};
use crate::json;
use crate::plain::plural;
use posewire::capture;
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
    let done = capture::convert(input, output, arguments.overwrite, &stops.work)?;
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

/// What became of a capture.
#[derive(Serialize)]
struct Record<'a> {
    kind: &'static str,
    input: &'a str,
    output: &'a str,
    datagrams: u64,
    damage: Option<&'a str>,
}
