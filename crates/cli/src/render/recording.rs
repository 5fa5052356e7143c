//! Recordings as people read them.

use crate::plain::{grouped, plural, printable};
use posewire::recording::{SenderSurvey, Survey};
use posewire::sink::RecordProgress;
use posewire_motion::Stamp;
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

/// How far a recording has come, on one line.
pub(crate) fn recording_line(progress: &RecordProgress, per_second: f64, elapsed: Duration) -> String {
    let mut line = format!(
        "{:.0} s, {}, {per_second:.0}/s, {}",
        elapsed.as_secs_f64(),
        plural(progress.datagrams(), "datagram"),
        megabytes(progress.bytes)
    );
    match progress.lost() {
        0 => {}
        lost => _ = write!(line, ", {lost} LOST"),
    }
    line
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
        _ = write!(text, "\n  {}: {count}, {} missing", source.endpoint, source.missing());
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
    _ = write!(text, "\n{}{files}", progress.file.display());
    text
}

/// What a recording holds.
pub(crate) fn recording(file: &Path, bytes: u64, survey: &Survey) -> String {
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
    let complete = if survey.complete {
        "yes"
    } else {
        "no, it was cut off: posewire inspect --recover completes it"
    };
    row(&mut text, "complete", complete);
    if let Some(damage) = survey.damage.as_deref().filter(|_| !survey.complete) {
        row(&mut text, "ends with", &printable(damage));
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
