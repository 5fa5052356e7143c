//! Results as people read them.

mod server;

pub(crate) use server::{delivery, kind, model, unknown_latencies};

use crate::plain::{cut, printable};
use posewire::sink::{ClientProgress, Progress};
use posewire::source::Preview;
use posewire::stats::{Statistics, StreamStatistics, SubjectStatistics};
use std::fmt::Write;
use std::time::Duration;

/// Who is in a take, as `: Ada, 23 segments, 240 Hz`.
pub(crate) fn who(preview: &Preview) -> String {
    let Some(subject) = preview.subjects.first() else {
        return String::new();
    };
    let others = match preview.subjects.len() - 1 {
        0 => String::new(),
        1 => " and 1 other".to_owned(),
        more => format!(" and {more} others"),
    };
    let segments = subject.skeleton.segments.len();
    let name = printable(&subject.name);
    format!(": {name}{others}, {segments} segments, {} Hz", preview.rate_hz)
}

/// How far a stream has come, on one line.
pub(crate) fn progress_line(progress: &Progress) -> String {
    let mut line = format!("{} samples sent, {}", progress.frames, lateness(progress));
    match progress.lost() {
        0 => {}
        lost => _ = write!(line, ", {lost} LOST"),
    }
    line
}

fn lateness(progress: &Progress) -> String {
    format!("lateness {}", progress.lateness)
}

/// How a stream went, a line for each target. `unsent` is what was lost here before it could be sent.
pub(crate) fn stream_summary(progress: &Progress, unsent: u64) -> String {
    let mut text = format!("sent {} samples, {}", progress.frames, lateness(progress));
    if unsent > 0 {
        _ = write!(
            text,
            ", {unsent} dropped here: the stream came faster than it was passed on"
        );
    }
    for target in &progress.targets {
        _ = write!(text, "\n  {}: {} datagrams", target.endpoint, target.datagrams);
        for (count, what) in [
            (target.congested, "dropped because the network was busy"),
            (target.failed, "refused by the system"),
            (target.dropped, "samples dropped because the peer was slow or away"),
        ] {
            if count > 0 {
                _ = write!(text, ", {count} {what}");
            }
        }
        target.clients.iter().for_each(|client| client_line(&mut text, client));
    }
    text
}

fn client_line(text: &mut String, client: &ClientProgress) {
    let ClientProgress { address, version, .. } = client;
    _ = write!(text, "\n    {address}, NatNet {version}: {} frames", client.frames);
    if client.dropped > 0 {
        _ = write!(text, ", {} not sent: nobody there, or no room", client.dropped);
    }
}

/// The table of a live stream: a line for each character and datagram type.
pub(crate) fn statistics(statistics: &Statistics) -> String {
    let mut text = format!(
        "{:8.1} s  {} datagrams, {} kB",
        statistics.elapsed.as_secs_f64(),
        statistics.datagrams,
        statistics.bytes / 1000
    );
    for (count, what) in troubles(statistics) {
        _ = write!(text, ", {count} {what}");
    }
    text.push('\n');
    match &statistics.server {
        Some(server) => text.push_str(&server::table(server, &statistics.subjects)),
        None => statistics
            .subjects
            .iter()
            .for_each(|subject| subject_table(&mut text, subject)),
    }
    text
}

/// What went wrong with a stream as a whole: counts above zero, in words.
pub(crate) fn troubles(statistics: &Statistics) -> impl Iterator<Item = (u64, &'static str)> {
    let all = [
        (statistics.kernel_dropped, "dropped by the kernel"),
        (statistics.malformed, "malformed"),
        (statistics.skipped_bytes, "bytes skipped"),
        (statistics.characters_refused, "of too many characters"),
    ];
    all.into_iter().filter(|(count, _)| *count > 0)
}

fn subject_table(text: &mut String, of_subject: &SubjectStatistics) {
    let subject = &of_subject.subject;
    _ = write!(
        text,
        "character {} {}, {} segments",
        subject.id,
        printable(&subject.name),
        subject.skeleton.segments.len()
    );
    if let Some(timecode) = of_subject.timecode {
        _ = write!(text, ", {timecode}");
    }
    text.push('\n');
    text.push_str(TABLE_HEAD);
    for stream in &of_subject.streams {
        stream_row(text, stream);
    }
}

fn stream_row(text: &mut String, stream: &StreamStatistics) {
    let counters = &stream.counters;
    let stride = counters
        .stride
        .map_or_else(|| "-".to_owned(), |stride| stride.to_string());
    _ = writeln!(
        text,
        "  {} {:<16} {:>6.1} {:>4} {:>7} {:>6} {:>4} {:>4} {:>3} {:>3} {:>6.1} {:>6.1}",
        stream.kind,
        cut(stream.kind.name(), 16),
        stream.rate_hz,
        stride,
        counters.received,
        counters.missing,
        counters.duplicate,
        counters.late,
        counters.reset,
        counters.incomplete,
        milliseconds(stream.interval.p99),
        milliseconds(stream.interval.max),
    );
    for (quirk, count) in &counters.quirks {
        _ = writeln!(text, "     {count} {}: {}", quirk.name(), quirk.meaning());
    }
}

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1000.0
}

const TABLE_HEAD: &str = "  ty type                 Hz strd   whole missed  dup late rst inc p99 ms max ms\n";
