//! `posewire convert`: takes to the files of other tools.

mod bar;
mod capture;
mod datagrams;
mod plan;
mod refuse;
mod report;

use super::End;
use crate::cli::Convert;
use crate::context::{self, Stops};
use crate::error::{self, Failure};
use crate::json;
use bar::Bar;
use plan::{Job, Plan, Source};
use posewire::endpoint::FileFormat;
use posewire::file::{Edit, ReadOptions, Recording, Saved, WriteOptions, read, rewrite, save};
use report::Report;
use std::borrow::Cow;
use std::path::Path;
use std::time::Instant;

pub(super) fn run(arguments: &Convert) -> anyhow::Result<End> {
    if let Some(jobs) = datagrams::jobs(arguments)? {
        return datagrams::run(&jobs, arguments);
    }
    let plan = Plan::of(arguments)?;
    let stops = context::stops_on_interrupt()?;
    let (mut takes, mut failed, mut lost) = (0, 0, 0);
    for job in &plan.jobs {
        let done = convert(&plan, job, &stops).unwrap_or_else(Done::failed);
        let alone = plan.jobs.len() == 1 && done.takes.len() == 1;
        lost += done.lost;
        takes += done.takes.len();
        for take in done.takes {
            match take {
                Ok(report) => {
                    lost += u64::from(report.is_incomplete());
                    tell(&report, arguments.json)?;
                }
                Err(error) if alone || stops.work.is_stopped() => return Err(error),
                // The others are converted all the same.
                Err(error) => {
                    error::report(&error);
                    failed += 1;
                }
            }
        }
    }
    end(failed, takes, lost)
}

/// How it ended when so many of all could not be converted, and so much was lost.
fn end(failed: usize, all: usize, lost: u64) -> anyhow::Result<End> {
    match failed {
        0 => Ok(End::with_lost(lost)),
        _ => Err(Failure {
            problem: format!("{failed} of {all} could not be converted"),
            help: "the reason of each is above; the others are done".to_owned(),
        }
        .into()),
    }
}

/// What became of an input.
struct Done {
    /// What became of each take that it gave.
    takes: Vec<anyhow::Result<Report>>,
    /// What of a live stream was lost on this side.
    lost: u64,
}

impl Done {
    /// Of an input that gave no take.
    fn failed(error: anyhow::Error) -> Self {
        Self {
            takes: vec![Err(error)],
            lost: 0,
        }
    }
}

fn convert(plan: &Plan, job: &Job, stops: &Stops) -> anyhow::Result<Done> {
    let began = Instant::now();
    let (takes, lost) = match &job.source {
        Source::File(path) if plan.passes_through(job) => (vec![pass_through(plan, job, path, stops, began)], 0),
        Source::File(path) => {
            let bar = Bar::start("reading", path.display(), &stops.work);
            let recording = read(path, plan.reading, bar.progress());
            bar.end();
            (vec![write(plan, job, None, &recording?, stops, began)], 0)
        }
        Source::Walk(walk) => {
            let takes = capture::walk(walk, plan.duration, stops)?;
            (write_all(plan, job, takes, stops, began), 0)
        }
        Source::Live(endpoint) => {
            let (takes, lost) = capture::live(endpoint, plan.only.as_deref(), plan.duration, stops)?;
            (write_all(plan, job, takes, stops, Instant::now()), lost)
        }
    };
    Ok(Done { takes, lost })
}

/// Writes an MVNX file anew frame by frame.
fn pass_through(plan: &Plan, job: &Job, path: &Path, stops: &Stops, began: Instant) -> anyhow::Result<Report> {
    let bar = Bar::start("rewriting", path.display(), &stops.work);
    let target = job.target(None);
    let done = rewrite(
        path,
        &plan.samples,
        &target,
        plan.reading,
        &plan.writing,
        bar.progress(),
    );
    bar.end();
    let done = done?;
    Ok(Report::new(job, done.frames, done.saved, began).damaged(done.damage))
}

/// Writes the take of every subject, each to a file of its own when there are several.
fn write_all(
    plan: &Plan,
    job: &Job,
    recordings: Vec<Recording>,
    stops: &Stops,
    began: Instant,
) -> Vec<anyhow::Result<Report>> {
    let names = plan::distinct_names(&recordings);
    let several = recordings.len() > 1;
    let reports = recordings.into_iter().zip(names).map(|(recording, name)| {
        let name = several.then_some(name.as_str());
        write(plan, job, name, &recording, stops, began)
    });
    reports.collect()
}

/// Does with a take what was asked for and saves it.
fn write(
    plan: &Plan,
    job: &Job,
    name: Option<&str>,
    recording: &Recording,
    stops: &Stops,
    began: Instant,
) -> anyhow::Result<Report> {
    let (mut writing, mut lacking) = (plan.writing.clone(), Vec::new());
    let (recording, computed) = loop {
        match plan.edit(job).of(Cow::Borrowed(recording), job.format, &writing) {
            // It could not be had again.
            Err(posewire::Error::NoSection { wanted, .. }) if job.is_stream() && leave_out(&mut writing, wanted) => {
                lacking.push(wanted);
            }
            done => break done?,
        }
    };
    let saved = save_take(&writing, job, name, &recording, stops)?;
    let frames = recording.take.len() as u64;
    let report = Report::new(job, frames, saved, began);
    let report = report.computed(&computed).damaged(recording.damage.clone());
    Ok(report.reordered(recording.reordered).lacking(lacking))
}

/// Writes a section no more that was asked for, unless it is the last.
fn leave_out(writing: &mut WriteOptions, section: &str) -> bool {
    let sections = writing.sections.get_or_insert_default();
    sections.retain(|wanted| wanted.name() != section);
    !sections.is_empty()
}

/// Saves a take. Where a file is there already, one of a stream gets a number into its name: it could not be had again.
fn save_take(
    writing: &WriteOptions,
    job: &Job,
    name: Option<&str>,
    recording: &Recording,
    stops: &Stops,
) -> posewire::Result<Saved> {
    let (mut target, mut number) = (job.target(name), 1);
    loop {
        let bar = Bar::start("writing", target.path.display(), &stops.work);
        let saved = save(&target, recording, writing, bar.progress());
        bar.end();
        if !(job.is_live() && matches!(saved, Err(posewire::Error::Exists { .. }))) {
            return saved;
        }
        number += 1;
        let numbered = name.map_or_else(|| number.to_string(), |name| format!("{name}_{number}"));
        target = job.target(Some(&numbered));
    }
}

fn tell(report: &Report, as_json: bool) -> anyhow::Result<()> {
    if as_json {
        json::print(&report.record())?;
    } else {
        context::say(report);
    }
    Ok(())
}

impl Plan {
    /// Whether a file can be written frame by frame as it is read.
    fn passes_through(&self, job: &Job) -> bool {
        // Sections asked for by name may have to be computed.
        job.is_mvnx() && self.rate.is_none() && self.writing.sections.is_none()
    }

    /// What is done to a take of this input.
    fn edit(&self, job: &Job) -> Edit {
        Edit {
            samples: self.samples.clone(),
            rate: self.rate,
            received: !matches!(job.source, Source::File(_)),
        }
    }
}

impl Job {
    fn is_mvnx(&self) -> bool {
        matches!(self.format, FileFormat::Mvnx | FileFormat::MvnxGz)
    }
}

/// How a damaged file is read.
fn reading(arguments: &Convert) -> ReadOptions {
    ReadOptions {
        salvage: arguments.salvage,
        ..ReadOptions::default()
    }
}
