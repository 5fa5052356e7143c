//! Recordings as people read them.

use crate::plain::{grouped, plural, printable};
use posewire::Error;
use posewire::endpoint::Endpoint;
use posewire::recording::{SenderSurvey, Survey, is_being_recorded};
use posewire::sink::{RecordProgress, RecordedSource};
use posewire_motion::Stamp;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How far a recording has come, on one line.
pub(crate) fn recording_line(progress: &RecordProgress, per_second: f64, elapsed: Duration) -> String {
    let mut line = format!(
        "{:.0} s, {}, {per_second:.0}/s, {}",
        elapsed.as_secs_f64(),
        plural(progress.datagrams(), "datagram"),
        megabytes(progress.bytes)
    );
    let missing: u64 = progress.sources.iter().map(RecordedSource::missing).sum();
    if missing > 0 {
        _ = write!(line, ", {} missing", grouped(missing));
    }
    if progress.lost() > 0 {
        _ = write!(line, ", {} LOST", grouped(progress.lost()));
    }
    let silent: Vec<_> = silent(progress).collect();
    match (silent.as_slice(), progress.sources.len()) {
        ([], _) => {}
        ([source], _) => _ = write!(line, ", nothing from {}", source.endpoint),
        (several, all) => _ = write!(line, ", nothing from {} of {all} sources", several.len()),
    }
    line
}

/// The sources from which nothing has come.
pub(crate) fn silent(progress: &RecordProgress) -> impl Iterator<Item = &RecordedSource> {
    let sends_datagrams = |source: &&RecordedSource| !matches!(source.endpoint, Endpoint::Synthetic(_));
    let sources = progress.sources.iter().filter(sends_datagrams);
    sources.filter(|source| source.last.is_none())
}

/// What was lost on this machine, and why.
pub(crate) fn losses(progress: &RecordProgress) -> String {
    let mut text = "LOST".to_owned();
    let kernel = progress.lost() - progress.dropped - progress.unwritten;
    for (count, why) in [
        (kernel, "dropped by the kernel: this machine is too busy"),
        (
            progress.dropped,
            "found no room in the queue: the disk or this machine is too slow",
        ),
        (progress.unwritten, "could not be written"),
    ] {
        if count > 0 {
            let comma = if text.len() > 4 { "," } else { "" };
            _ = write!(text, "{comma} {} {why}", grouped(count));
        }
    }
    text
}

/// How a recording went: a line for each source and subject, and where it is.
pub(crate) fn recorded(progress: &RecordProgress, elapsed: Duration) -> String {
    let mut text = format!(
        "recorded {} and {} in {:.1} s, {}",
        plural(progress.datagrams(), "datagram"),
        plural(progress.frames(), "sample"),
        elapsed.as_secs_f64(),
        megabytes(progress.bytes)
    );
    for source in &progress.sources {
        let count = plural(source.datagrams, "datagram");
        let missing = grouped(source.missing());
        _ = write!(text, "\n  {}: {count}, {missing} missing", source.endpoint);
    }
    for source in silent(progress) {
        _ = write!(text, "\nNOTHING CAME from {}", source.endpoint);
    }
    for said in progress.sources.iter().flat_map(|source| &source.two_senders) {
        _ = write!(text, "\n{}", two_senders(said));
    }
    for subject in &progress.subjects {
        let count = plural(subject.frames, "sample");
        _ = write!(text, "\n  {}: {count}", called(&subject.name, subject.id));
    }
    if progress.lost() > 0 {
        _ = write!(text, "\n{}", losses(progress));
    }
    if progress.descriptions_left_out > 0 {
        let count = plural(progress.descriptions_left_out, "description");
        _ = write!(
            text,
            "\n{count} of subjects left out, as these change without end: the datagrams with them are there"
        );
    }
    let files = match progress.files {
        1 => String::new(),
        files => format!(", the last of {files} files"),
    };
    let file = progress.file.display();
    match progress.failure {
        Some(Error::Removed { .. }) => _ = write!(text, "\n{file} is gone{files}"),
        _ if progress.moved => _ = write!(text, "\n{}", moved(progress)),
        _ => _ = write!(text, "\n{file}{files}"),
    }
    text
}

/// What is said when somebody has moved the file that is written.
pub(crate) fn moved(progress: &RecordProgress) -> String {
    let file = progress.file.display();
    format!("{file} was MOVED while it was recorded: the recording is in it where it is now")
}

/// What is said of several who send the same.
pub(crate) fn two_senders(said: &str) -> String {
    format!(
        "TWO SENDERS: {} The datagrams of both are recorded, the poses jump between them.",
        printable(said)
    )
}

/// A file of a split recording that is not the first.
pub(crate) struct LaterFile {
    pub(crate) path: PathBuf,
    pub(crate) complete: bool,
    pub(crate) is_recorded: bool,
    /// Whether it says that another follows it.
    continued: bool,
}

impl LaterFile {
    pub(crate) fn of(path: &Path) -> posewire::Result<Self> {
        let survey = Survey::of(path)?;
        Ok(Self {
            path: path.to_owned(),
            complete: survey.complete,
            is_recorded: is_being_recorded(path),
            continued: survey.continued,
        })
    }
}

/// What a recording holds: of one that was split, what its first file does.
pub(crate) fn recording(file: &Path, bytes: u64, survey: &Survey, is_recorded: bool, later: &[LaterFile]) -> String {
    let mut text = format!("{}\n", file.display());
    row(
        &mut text,
        "format",
        &format!("MCAP, {}, by {}", megabytes(bytes), printable(&survey.library)),
    );
    let about = |key: &str| survey.about.get(key).map(|value| printable(value));
    if let (Some(host), Some(system)) = (about("host"), about("system")) {
        row(&mut text, "recorded on", &format!("{host}, {system}"));
    }
    if let Some(part) = about("part").filter(|part| part != "1" || survey.continued) {
        let goes_on = if survey.continued { ", another follows" } else { "" };
        row(&mut text, "part", &format!("{part}{goes_on}"));
    }
    row(&mut text, "lasts", &format!("{:.3} s", seconds(survey.span)));
    row(&mut text, "complete", completeness(survey.complete, is_recorded));
    if let Some(damage) = survey.damage.as_deref().filter(|_| !survey.complete && !is_recorded) {
        row(&mut text, "damage", &printable(damage));
    }
    for file in later {
        let name = file.path.file_name().unwrap_or_default().to_string_lossy();
        let complete = completeness(file.complete, file.is_recorded);
        row(
            &mut text,
            "goes on in",
            &format!("{}: complete: {complete}", printable(&name)),
        );
    }
    if later.last().map_or(survey.continued, |last| last.continued) {
        row(&mut text, "goes on in", "a file that is not here");
    }
    if let Some(lost) = survey.lost.filter(|lost| *lost > 0) {
        row(
            &mut text,
            "lost",
            &format!("{} before they were written", plural(lost, "item")),
        );
    }
    for (number, source) in survey.sources.iter().enumerate() {
        row(&mut text, &format!("source {number}"), &printable(&source.endpoint));
        source.senders.iter().for_each(|sender| sender_row(&mut text, sender));
        if source.repeated > 0 {
            let repeated = plural(source.repeated, "description");
            row(&mut text, "", &format!("{repeated} repeated from before"));
        }
    }
    for subject in &survey.subjects {
        let value = format!(
            "{}, {}, source {}",
            called(&subject.name, subject.id),
            plural(subject.frames, "sample"),
            subject.source
        );
        row(&mut text, "subject", &value);
    }
    if survey.other > 0 {
        row(&mut text, "other", &plural(survey.other, "message"));
    }
    text
}

fn completeness(complete: bool, is_recorded: bool) -> &'static str {
    match (complete, is_recorded) {
        (_, true) => "no, it is being recorded",
        (true, _) => "yes",
        (false, _) => "no: posewire inspect --recover writes what is whole of it",
    }
}

/// A subject's name, or its number where it has none.
fn called(name: &str, id: u32) -> String {
    if name.is_empty() {
        return format!("subject {id}");
    }
    printable(name)
}

fn sender_row(text: &mut String, sender: &SenderSurvey) {
    let wire = sender.wire.map_or("unknown", posewire::Wire::name);
    let value = format!(
        "{} {wire}: {}, {}",
        printable(&sender.from),
        plural(sender.datagrams, "datagram"),
        megabytes(sender.bytes)
    );
    row(text, "", &value);
}

pub(super) fn row(text: &mut String, label: &str, value: &str) {
    _ = writeln!(text, "{}", format!("  {label:<12} {value}").trim_end());
}

pub(super) fn seconds(span: Option<(Stamp, Stamp)>) -> f64 {
    span.map_or(0.0, |(first, last)| last.since(first).as_secs_f64())
}

pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(url: &str, datagrams: u64) -> RecordedSource {
        RecordedSource {
            endpoint: url.parse().unwrap(),
            datagrams,
            bytes: 0,
            last: (datagrams > 0).then_some(Stamp(1)),
            two_senders: Vec::new(),
            statistics: None,
        }
    }

    #[test]
    fn the_line_says_which_sources_are_silent() {
        let mut progress = RecordProgress {
            sources: vec![source("mxtp://0.0.0.0:1", 2400), source("mxtp://0.0.0.0:2", 0)],
            ..RecordProgress::default()
        };
        let line = |progress: &RecordProgress| recording_line(progress, 240.0, Duration::from_secs(10));
        let said = "10 s, 2,400 datagrams, 240/s, 0.0 MB, nothing from mxtp://0.0.0.0:2";
        assert_eq!(line(&progress), said);
        progress.sources.push(source("mxtp://0.0.0.0:3", 0));
        assert!(line(&progress).ends_with("nothing from 2 of 3 sources"));
        progress.sources.truncate(1);
        assert!(line(&progress).ends_with(" MB"));
    }
}
