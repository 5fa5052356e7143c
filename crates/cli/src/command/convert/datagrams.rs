//! Captures to captures: every datagram with its time.

use super::refuse;
use crate::cli::Convert;
use crate::command::End;
use crate::context::{self, say};
use crate::error::{self, Usage};
use crate::json;
use crate::plain::plural;
use posewire::capture::{self, ConvertOptions, Format};
use posewire::stop::Stop;
use serde::Serialize;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// A capture that is read and the one that is written.
pub(super) struct Job {
    input: PathBuf,
    output: PathBuf,
}

/// What is to be converted, where captures become captures.
pub(super) fn jobs(arguments: &Convert) -> anyhow::Result<Option<Vec<Job>>> {
    let Some((output, inputs)) = arguments.paths.split_last() else {
        return Ok(None);
    };
    if let Some(format) = arguments.capture_format() {
        return of_format(inputs, output, format).map(Some);
    }
    let [input] = inputs else { return Ok(None) };
    let is_file = !Path::new(output).is_dir();
    let are_captures = is_file && [input, output].into_iter().all(|path| refuse::is_capture(path));
    Ok(are_captures.then(|| {
        let (input, output) = (input.into(), output.into());
        vec![Job { input, output }]
    }))
}

/// One input may become a file whose name ends as the format does; any number of them go into a folder.
fn of_format(inputs: &[String], output: &str, format: Format) -> anyhow::Result<Vec<Job>> {
    let ending = format.ending();
    if let Some(input) = inputs.iter().find(|input| !refuse::is_capture(input)) {
        return Err(Usage {
            problem: format!("--format {ending} is for recordings and captures, found {input}"),
            help: "posewire convert --help lists the formats of takes".to_owned(),
        }
        .into());
    }
    let path = Path::new(output);
    let own_ending = path.extension().map(OsStr::to_ascii_lowercase);
    match inputs {
        [] => Err(refuse::no_output(output).into()),
        [input] if own_ending.as_deref() == Some(OsStr::new(ending)) && !path.is_dir() => Ok(vec![Job {
            input: input.into(),
            output: path.to_owned(),
        }]),
        _ if path.is_file() || refuse::is_capture(output) && !path.is_dir() => Err(Usage {
            problem: format!("--format {ending} and {output} do not go together"),
            help: "name a folder, or leave --format out".to_owned(),
        }
        .into()),
        _ => into_folder(inputs, path, ending),
    }
}

fn into_folder(inputs: &[String], folder: &Path, ending: &str) -> anyhow::Result<Vec<Job>> {
    let mut jobs: Vec<Job> = Vec::new();
    for input in inputs {
        let mut name = Path::new(input).file_stem().unwrap_or_default().to_owned();
        name.push(format!(".{ending}"));
        let output = folder.join(name);
        if jobs.iter().any(|job| job.output == output) {
            return Err(refuse::same_name(&output, input).into());
        }
        jobs.push(Job {
            input: input.into(),
            output,
        });
    }
    fs::create_dir_all(folder).map_err(|error| posewire::Error::write(folder.display().to_string(), &error))?;
    Ok(jobs)
}

pub(super) fn run(jobs: &[Job], arguments: &Convert) -> anyhow::Result<End> {
    refuse::of_takes(arguments)?;
    let options = ConvertOptions {
        only: only(arguments)?,
        overwrite: arguments.overwrite,
    };
    let stops = context::stops_on_interrupt()?;
    let (mut failed, mut damaged) = (0, 0);
    for job in jobs {
        match job.run(&options, arguments.json, &stops.work) {
            Ok(is_damaged) => damaged += u64::from(is_damaged),
            Err(error) if jobs.len() == 1 || stops.work.is_stopped() => return Err(error),
            // The others are converted all the same.
            Err(error) => {
                error::report(&error);
                failed += 1;
            }
        }
    }
    super::end(failed, jobs.len(), damaged)
}

impl Job {
    /// Converts a capture and says so; whether it is damaged.
    fn run(&self, options: &ConvertOptions, as_json: bool, stop: &Stop) -> anyhow::Result<bool> {
        let Self { input, output } = self;
        let done = capture::convert(input, output, options, stop)?;
        if as_json {
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
        if output
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"))
        {
            say(format_args!(
                "  without poses, which viewers show: posewire record {} -o FILE plays it and writes them too",
                input.display()
            ));
        }
        if let Some(damage) = &done.damage {
            say(format_args!(
                "{} is damaged, and what stands before that was converted: {damage}",
                input.display()
            ));
        }
        Ok(done.damage.is_some())
    }
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
