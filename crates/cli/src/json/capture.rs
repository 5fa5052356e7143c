//! What a capture of packets holds.

use posewire::capture::{CapturedSource, Protocol, Survey};
use posewire::json::rounded;
use posewire_motion::Stamp;
use serde::Serialize;
use std::path::Path;

/// What a capture of packets holds.
#[derive(Serialize)]
pub(crate) struct CaptureFileRecord<'a> {
    kind: &'static str,
    file: String,
    format: &'static str,
    bytes: u64,
    packets: u64,
    datagrams: u64,
    first_ns: Option<i64>,
    last_ns: Option<i64>,
    duration_s: f64,
    sources: Vec<CapturedSourceRecord<'a>>,
    other: u64,
    unknown_link: u64,
    malformed: u64,
    cut: u64,
    incomplete: u64,
    gaps: u64,
    skipped_bytes: u64,
    damage: Option<&'a str>,
}

#[derive(Serialize)]
struct CapturedSourceRecord<'a> {
    source: u16,
    endpoint: &'a str,
    protocol: Option<&'static str>,
    datagrams: u64,
    bytes: u64,
    first_ns: Option<i64>,
    last_ns: Option<i64>,
    duration_s: f64,
}

impl<'a> CaptureFileRecord<'a> {
    pub(crate) fn new(file: &Path, bytes: u64, survey: &'a Survey) -> Self {
        let (span, counts) = (survey.span(), &survey.counts);
        Self {
            kind: "packets",
            file: file.display().to_string(),
            format: survey.format.ending(),
            bytes,
            packets: counts.packets,
            datagrams: survey.sources.iter().map(|source| source.datagrams).sum(),
            first_ns: span.map(|(first, _)| first.nanoseconds()),
            last_ns: span.map(|(_, last)| last.nanoseconds()),
            duration_s: seconds(span),
            sources: survey.sources.iter().map(source).collect(),
            other: counts.other,
            unknown_link: counts.unknown_link,
            malformed: counts.malformed,
            cut: counts.cut,
            incomplete: counts.incomplete,
            gaps: counts.gaps,
            skipped_bytes: counts.skipped_bytes,
            damage: survey.damage.as_deref(),
        }
    }
}

fn source(source: &CapturedSource) -> CapturedSourceRecord<'_> {
    CapturedSourceRecord {
        source: source.number,
        endpoint: &source.name,
        protocol: source.protocol.map(Protocol::name),
        datagrams: source.datagrams,
        bytes: source.bytes,
        first_ns: source.span.map(|(first, _)| first.nanoseconds()),
        last_ns: source.span.map(|(_, last)| last.nanoseconds()),
        duration_s: seconds(source.span),
    }
}

fn seconds(span: Option<(Stamp, Stamp)>) -> f64 {
    span.map_or(0.0, |(first, last)| rounded(last.since(first).as_secs_f64()))
}
