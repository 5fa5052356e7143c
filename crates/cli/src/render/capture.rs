//! Captures of packets as people read them.

use super::recording::{megabytes, row, seconds};
use crate::plain::{grouped, plural, printable};
use posewire::capture::{CapturedSource, Counts, Protocol, Survey};
use std::path::Path;

/// What a capture of packets holds.
pub(crate) fn capture(file: &Path, bytes: u64, survey: &Survey) -> String {
    let mut text = format!("{}\n", file.display());
    let format = format!("{}, {}", survey.format.ending(), megabytes(bytes));
    row(&mut text, "format", &format);
    row(&mut text, "lasts", &format!("{:.3} s", seconds(survey.span())));
    row(&mut text, "packets", &grouped(survey.counts.packets));
    for source in survey.heard() {
        let name = format!("source {}", source.number);
        row(&mut text, &name, &printable(&source.name));
        row(&mut text, "", &what_came(source, survey));
    }
    if survey.heard().next().is_none() {
        row(
            &mut text,
            "sources",
            "none: no packet is MXTP or NatNet; --protocol takes all of UDP for one of them",
        );
    }
    if survey.counts.other > 0 {
        row(
            &mut text,
            "other",
            &format!("{} of other protocols", plural(survey.counts.other, "packet")),
        );
    }
    if let Some(words) = unread(&survey.counts) {
        row(&mut text, "not read", &words);
    }
    if let Some(damage) = &survey.damage {
        row(&mut text, "ends with", &printable(damage));
    }
    text
}

/// How much, of which protocol, and when.
fn what_came(source: &CapturedSource, survey: &Survey) -> String {
    let began = source
        .span
        .zip(survey.span())
        .map_or(0.0, |((own, _), (all, _))| own.since(all).as_secs_f64());
    format!(
        "{}: {}, {}, from {began:.3} s on for {:.3} s",
        source.protocol.map_or("unknown", Protocol::name),
        plural(source.datagrams, "datagram"),
        megabytes(source.bytes),
        seconds(source.span)
    )
}

/// What of a capture could not be used, in words.
pub(crate) fn unread(counts: &Counts) -> Option<String> {
    let kinds = [
        (
            counts.unknown_link,
            "packet of an unknown link",
            "packets of an unknown link",
        ),
        (counts.malformed, "malformed packet", "malformed packets"),
        (
            counts.cut,
            "packet cut short by the capture",
            "packets cut short by the capture",
        ),
        (
            counts.incomplete,
            "packet without all of its fragments",
            "packets without all of their fragments",
        ),
        (counts.gaps, "gap in a TCP stream", "gaps in TCP streams"),
        (counts.skipped_bytes, "byte of no datagram", "bytes of no datagram"),
    ];
    let words = kinds.into_iter().filter(|(count, ..)| *count > 0);
    let words: Vec<_> = words
        .map(|(count, one, many)| format!("{} {}", grouped(count), if count == 1 { one } else { many }))
        .collect();
    (!words.is_empty()).then(|| words.join(", "))
}
