//! How a stream is doing that we receive.

use super::{Spread, rounded};
use crate::stats::{SampleCounts, Statistics, StreamStatistics, SubjectStatistics, Transit};
use posewire_motion::Subject;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// How a receiver is doing: what belongs to no character.
#[derive(Debug, Serialize)]
pub struct ReceiverRecord<'a> {
    kind: &'static str,
    datagrams: u64,
    bytes: u64,
    malformed: u64,
    last_malformed: Option<&'a str>,
    skipped_bytes: u64,
    kernel_dropped: u64,
    characters_refused: u64,
    elapsed_s: f64,
    ended: bool,
}

impl<'a> ReceiverRecord<'a> {
    /// What `all` says of it.
    pub fn new(all: &'a Statistics) -> Self {
        Self {
            kind: "receiver",
            datagrams: all.datagrams,
            bytes: all.bytes,
            malformed: all.malformed,
            last_malformed: all.last_malformed.as_deref(),
            skipped_bytes: all.skipped_bytes,
            kernel_dropped: all.kernel_dropped,
            characters_refused: all.characters_refused,
            elapsed_s: rounded(all.elapsed.as_secs_f64()),
            ended: all.ended,
        }
    }
}

/// How one datagram type of one character is doing.
#[derive(Debug, Serialize)]
pub struct StatisticsRecord<'a> {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    character: Option<u32>,
    name: &'a str,
    r#type: String,
    rate_hz: f64,
    stride: Option<u32>,
    received: u64,
    missing: u64,
    duplicate: u64,
    late: u64,
    reset: u64,
    rewound: u64,
    jumped: u64,
    malformed: u64,
    incomplete: u64,
    kernel_dropped: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<SamplesRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transit_ms: Option<TransitRecord>,
    datagrams: u64,
    quirks: BTreeMap<&'static str, u64>,
    interval_ms: Spread,
    elapsed_s: f64,
    ended: bool,
}

/// What became of the samples of a character.
#[derive(Debug, Serialize)]
struct SamplesRecord {
    done: u64,
    partial: u64,
    gone: u64,
}

impl From<SampleCounts> for SamplesRecord {
    fn from(SampleCounts { done, partial, gone }: SampleCounts) -> Self {
        Self { done, partial, gone }
    }
}

/// How long the samples of a character were on their way.
#[derive(Debug, Serialize)]
struct TransitRecord {
    variation: Option<Spread>,
    latency: Option<Spread>,
    clocks: &'static str,
}

impl From<Transit> for TransitRecord {
    fn from(transit: Transit) -> Self {
        Self {
            variation: transit.variation.map(Into::into),
            latency: transit.latency.map(Into::into),
            clocks: transit.clocks.name(),
        }
    }
}

/// One record for each character and datagram type, and one for the frames of a server.
pub fn statistics(all: &Statistics) -> impl Iterator<Item = StatisticsRecord<'_>> {
    let streams = all.streams();
    streams.map(|(subject, stream)| StatisticsRecord::new(all, subject, stream))
}

fn of_subject<'a>(all: &'a Statistics, subject: &Arc<Subject>) -> Option<&'a SubjectStatistics> {
    all.subjects.iter().find(|of| Arc::ptr_eq(&of.subject, subject))
}

impl<'a> StatisticsRecord<'a> {
    fn new(all: &'a Statistics, subject: Option<&'a Arc<Subject>>, stream: &StreamStatistics) -> Self {
        let counters = &stream.counters;
        let of_subject = subject.and_then(|subject| of_subject(all, subject));
        let server = all.server.as_ref().map_or("", |server| &server.name);
        Self {
            kind: "statistics",
            character: subject.map(|subject| subject.id),
            name: subject.map_or(server, |subject| &subject.name),
            r#type: stream.kind.to_string(),
            rate_hz: rounded(stream.rate_hz),
            stride: counters.stride,
            received: counters.received,
            missing: counters.missing,
            duplicate: counters.duplicate,
            late: counters.late,
            reset: counters.reset,
            rewound: counters.rewound,
            jumped: counters.jumped,
            malformed: counters.malformed,
            incomplete: counters.incomplete,
            kernel_dropped: all.kernel_dropped,
            samples: of_subject.and_then(|of| of.samples).map(Into::into),
            transit_ms: of_subject.and_then(|of| of.transit).map(Into::into),
            datagrams: counters.datagrams,
            quirks: counters
                .quirks
                .iter()
                .map(|(quirk, count)| (quirk.name(), *count))
                .collect(),
            interval_ms: stream.interval.into(),
            elapsed_s: rounded(all.elapsed.as_secs_f64()),
            ended: all.ended,
        }
    }
}
