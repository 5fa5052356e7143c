//! Results as people read them.

mod capture;
mod doctor;
mod recording;
mod server;

pub(crate) use capture::{capture, unread};
pub(crate) use doctor::print_findings;
pub(crate) use recording::{LaterFile, losses, moved, recorded, recording, recording_line, silent, two_senders};
pub(crate) use server::{delivery, kind, model, unknown_latencies};

use crate::plain::{cut, plural, printable};
use posewire::faults::FaultCounts;
use posewire::sink::{ClientProgress, Progress, TargetProgress};
use posewire::source::Preview;
use posewire::stats::{SampleCounts, Statistics, StreamStatistics, SubjectStatistics, Transit};
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
    let segments = plural(subject.skeleton.segments.len() as u64, "segment");
    let name = printable(&subject.name);
    format!(": {name}{others}, {segments}, {} Hz", preview.rate_hz)
}

/// How far a stream has come, on one line.
pub(crate) fn progress_line(progress: &Progress) -> String {
    let mut line = format!("{} sent{}", plural(progress.frames, "sample"), lateness(progress));
    match progress.lost() {
        0 => {}
        lost => _ = write!(line, ", {lost} LOST"),
    }
    line
}

fn lateness(progress: &Progress) -> String {
    match progress.frames {
        0 => String::new(),
        _ => format!(", lateness {}", progress.lateness),
    }
}

/// How a stream went, a line for each target. `unsent` is what was lost here before it could be sent.
pub(crate) fn stream_summary(progress: &Progress, unsent: u64) -> String {
    let mut text = format!("sent {}{}", plural(progress.frames, "sample"), lateness(progress));
    if unsent > 0 {
        _ = write!(
            text,
            ", {unsent} dropped here: the stream came faster than it was passed on"
        );
    }
    for target in &progress.targets {
        text += &target_line(target);
    }
    if let Some(faults) = &progress.faults {
        _ = write!(text, "\n{}", made(faults));
    }
    text
}

/// What became of what was sent to a target, on a line that begins here, and on one for each NatNet client.
pub(crate) fn target_line(target: &TargetProgress) -> String {
    let mut text = format!("\n  {}: {} datagrams", target.endpoint, target.datagrams);
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
    text
}

/// The faults that were made on purpose, on one line.
pub(crate) fn made(counts: &FaultCounts) -> String {
    let kinds: Vec<_> = counts.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    let kinds = if kinds.is_empty() {
        "none".to_owned()
    } else {
        kinds.join(", ")
    };
    let FaultCounts { taken, sent, .. } = counts;
    format!("faults made on purpose: {kinds}; of {taken} datagrams {sent} left")
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
    let refused = statistics.server.as_ref().map_or(0, |server| server.refused);
    let all = [
        (statistics.kernel_dropped, "dropped by the kernel"),
        (statistics.malformed, "malformed"),
        (statistics.skipped_bytes, "bytes skipped"),
        (statistics.characters_refused, "of too many characters"),
        (refused, "refused while no server was connected"),
    ];
    all.into_iter().filter(|(count, _)| *count > 0)
}

fn subject_table(text: &mut String, of_subject: &SubjectStatistics) {
    let subject = &of_subject.subject;
    _ = write!(
        text,
        "character {} {}, {}",
        subject.id,
        printable(&subject.name),
        plural(subject.skeleton.segments.len() as u64, "segment")
    );
    if let Some(timecode) = of_subject.timecode {
        _ = write!(text, ", {timecode}");
    }
    text.push('\n');
    text.push_str(TABLE_HEAD);
    for stream in &of_subject.streams {
        stream_row(text, stream);
    }
    if let Some(SampleCounts { partial, gone, .. }) = of_subject.samples.filter(|samples| !samples.are_whole()) {
        _ = writeln!(text, "     of its samples {gone} are gone and {partial} lack a type");
    }
    if let Some(transit) = &of_subject.transit {
        transit_rows(text, transit);
    }
}

fn transit_rows(text: &mut String, transit: &Transit) {
    let clocks = transit.clocks.meaning();
    match transit.latency {
        Some(latency) => _ = writeln!(text, "     latency {latency}, {clocks}"),
        None => _ = writeln!(text, "     latency {clocks}"),
    }
    if let Some(variation) = transit.variation {
        _ = writeln!(text, "     variation {variation} beyond the quickest");
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
        counters.restarts(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_sent_was_not_late() {
        let mut progress = Progress::default();
        assert_eq!(stream_summary(&progress, 0), "sent 0 samples");
        progress.frames = 1;
        assert!(stream_summary(&progress, 0).starts_with("sent 1 sample, lateness p50 0.00 ms"));
    }
}
