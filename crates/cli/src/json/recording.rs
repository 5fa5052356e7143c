//! How a recording is going, and what one holds.

use crate::render::LaterFile;
use posewire::json::rounded;
use posewire::recording::{SenderSurvey, SourceSurvey, SubjectSurvey, Survey};
use posewire::sink::{RecordProgress, RecordedSource, RecordedSubject};
use posewire_motion::Stamp;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

/// How a recording is going.
#[derive(Serialize)]
pub(crate) struct RecordingRecord<'a> {
    kind: &'static str,
    file: String,
    files: u32,
    bytes: u64,
    elapsed_s: f64,
    rate_hz: f64,
    datagrams: u64,
    frames: u64,
    sources: Vec<SourceRecord<'a>>,
    subjects: Vec<SubjectRecord<'a>>,
    dropped: u64,
    unwritten: u64,
    lost: u64,
    descriptions_left_out: u64,
    moved: bool,
    failure: Option<String>,
    ended: bool,
}

#[derive(Serialize)]
struct SourceRecord<'a> {
    source: usize,
    endpoint: String,
    datagrams: u64,
    bytes: u64,
    missing: u64,
    malformed: u64,
    kernel_dropped: u64,
    two_senders: &'a [String],
}

#[derive(Serialize)]
struct SubjectRecord<'a> {
    source: u16,
    subject: u32,
    name: &'a str,
    frames: u64,
}

impl<'a> RecordingRecord<'a> {
    /// `rate_hz` is that of the last second; at the end there is none, and it is that of all the time.
    pub(crate) fn new(progress: &'a RecordProgress, elapsed: Duration, rate_hz: Option<f64>) -> Self {
        let overall = || progress.datagrams() as f64 / elapsed.as_secs_f64().max(1e-3);
        Self {
            kind: "recording",
            file: progress.file.display().to_string(),
            files: progress.files,
            bytes: progress.bytes,
            elapsed_s: rounded(elapsed.as_secs_f64()),
            rate_hz: rounded(rate_hz.unwrap_or_else(overall)),
            datagrams: progress.datagrams(),
            frames: progress.frames(),
            sources: progress.sources.iter().enumerate().map(source).collect(),
            subjects: progress.subjects.iter().map(subject).collect(),
            dropped: progress.dropped,
            unwritten: progress.unwritten,
            lost: progress.lost(),
            descriptions_left_out: progress.descriptions_left_out,
            moved: progress.moved,
            failure: progress.failure.as_ref().map(ToString::to_string),
            ended: rate_hz.is_none(),
        }
    }
}

fn source((number, source): (usize, &RecordedSource)) -> SourceRecord<'_> {
    let statistics = source.statistics.as_deref();
    SourceRecord {
        source: number,
        endpoint: source.endpoint.to_string(),
        datagrams: source.datagrams,
        bytes: source.bytes,
        missing: source.missing(),
        malformed: statistics.map_or(0, |statistics| statistics.malformed),
        kernel_dropped: statistics.map_or(0, |statistics| statistics.kernel_dropped),
        two_senders: &source.two_senders,
    }
}

fn subject(subject: &RecordedSubject) -> SubjectRecord<'_> {
    SubjectRecord {
        source: subject.source.0,
        subject: subject.id,
        name: &subject.name,
        frames: subject.frames,
    }
}

/// What a recording holds.
#[derive(Serialize)]
pub(crate) struct RecordingFileRecord<'a> {
    kind: &'static str,
    file: String,
    bytes: u64,
    library: &'a str,
    about: &'a BTreeMap<String, String>,
    complete: bool,
    damage: Option<&'a str>,
    first_ns: Option<i64>,
    last_ns: Option<i64>,
    duration_s: f64,
    sources: Vec<SourceFileRecord<'a>>,
    subjects: Vec<SubjectFileRecord<'a>>,
    other: u64,
    lost: Option<u64>,
    continued: bool,
    is_recorded: bool,
    later: Vec<LaterFileRecord>,
}

#[derive(Serialize)]
struct LaterFileRecord {
    file: String,
    complete: bool,
    is_recorded: bool,
}

#[derive(Serialize)]
struct SourceFileRecord<'a> {
    endpoint: &'a str,
    repeated: u64,
    senders: Vec<SenderFileRecord<'a>>,
}

#[derive(Serialize)]
struct SenderFileRecord<'a> {
    from: &'a str,
    wire: Option<&'static str>,
    datagrams: u64,
    bytes: u64,
    duration_s: f64,
}

#[derive(Serialize)]
struct SubjectFileRecord<'a> {
    source: u16,
    subject: u32,
    name: &'a str,
    frames: u64,
    duration_s: f64,
}

impl<'a> RecordingFileRecord<'a> {
    pub(crate) fn new(file: &Path, bytes: u64, survey: &'a Survey, is_recorded: bool, later: &[LaterFile]) -> Self {
        Self {
            kind: "mcap",
            file: file.display().to_string(),
            bytes,
            library: &survey.library,
            about: &survey.about,
            complete: survey.complete,
            damage: survey.damage.as_deref(),
            first_ns: survey.span.map(|(first, _)| first.nanoseconds()),
            last_ns: survey.span.map(|(_, last)| last.nanoseconds()),
            duration_s: seconds(survey.span),
            sources: survey.sources.iter().map(source_file).collect(),
            subjects: survey.subjects.iter().map(subject_file).collect(),
            other: survey.other,
            lost: survey.lost,
            continued: survey.continued,
            is_recorded,
            later: later.iter().map(later_file).collect(),
        }
    }
}

fn later_file(later: &LaterFile) -> LaterFileRecord {
    LaterFileRecord {
        file: later.path.display().to_string(),
        complete: later.complete,
        is_recorded: later.is_recorded,
    }
}

fn source_file(source: &SourceSurvey) -> SourceFileRecord<'_> {
    SourceFileRecord {
        endpoint: &source.endpoint,
        repeated: source.repeated,
        senders: source.senders.iter().map(sender_file).collect(),
    }
}

fn sender_file(sender: &SenderSurvey) -> SenderFileRecord<'_> {
    SenderFileRecord {
        from: &sender.from,
        wire: sender.wire.map(posewire::Wire::name),
        datagrams: sender.datagrams,
        bytes: sender.bytes,
        duration_s: seconds(sender.span),
    }
}

fn subject_file(subject: &SubjectSurvey) -> SubjectFileRecord<'_> {
    SubjectFileRecord {
        source: subject.source,
        subject: subject.id,
        name: &subject.name,
        frames: subject.frames,
        duration_s: seconds(subject.span),
    }
}

fn seconds(span: Option<(Stamp, Stamp)>) -> f64 {
    span.map_or(0.0, |(first, last)| rounded(last.since(first).as_secs_f64()))
}
