//! The server that a stream comes from.

use super::{Spread, rounded};
use crate::stats::{Clock, Latencies, ModelCounts, ServerStatistics, Statistics, SubjectStatistics};
use posewire_natnet::client::Mode;
use serde::Serialize;
use std::time::Duration;

/// What a NatNet server says of itself, how far away it is, and how much of its subjects is tracked.
#[derive(Debug, Serialize)]
pub struct ServerRecord<'a> {
    kind: &'static str,
    name: &'a str,
    app_version: String,
    address: String,
    connected: bool,
    version: String,
    mode: &'static str,
    group: Option<String>,
    interface: Option<&'a str>,
    recording: Option<bool>,
    edit_mode: Option<bool>,
    model: Option<ModelRecord>,
    clock: Option<ClockRecord>,
    latency_ms: LatencyRecord,
    subjects: Vec<TrackingRecord<'a>>,
    left_out: u64,
    refused: u64,
    elapsed_s: f64,
    ended: bool,
}

#[derive(Debug, Serialize)]
struct ModelRecord {
    marker_sets: usize,
    rigid_bodies: usize,
    skeletons: usize,
    assets: usize,
    force_plates: usize,
    devices: usize,
    cameras: usize,
    unknown: usize,
}

#[derive(Debug, Serialize)]
struct ClockRecord {
    offset_ns: i64,
    uncertainty_ms: f64,
    round_trip_ms: f64,
}

#[derive(Debug, Serialize)]
struct LatencyRecord {
    camera_to_host: Option<Spread>,
    software: Option<Spread>,
    host_to_here: Option<Spread>,
}

#[derive(Debug, Serialize)]
struct TrackingRecord<'a> {
    character: u32,
    name: &'a str,
    segments: usize,
    tracked: usize,
    frames_untracked: u64,
}

impl<'a> ServerRecord<'a> {
    /// `None` for a stream without a server, and before anything came from it.
    pub fn new(all: &'a Statistics) -> Option<Self> {
        let server: &ServerStatistics = all.server.as_deref()?;
        Some(Self {
            kind: "server",
            name: &server.name,
            app_version: server.app_version.to_string(),
            address: server.address.to_string(),
            connected: server.connected,
            version: server.version.to_string(),
            mode: match server.mode {
                Mode::Unicast => "unicast",
                Mode::Multicast => "multicast",
            },
            group: server.group.map(|group| group.to_string()),
            interface: server.interface.as_deref(),
            recording: server.recording,
            edit_mode: server.edit_mode,
            model: server.model.map(ModelRecord::from),
            clock: server.clock.map(ClockRecord::from),
            latency_ms: server.latencies.into(),
            subjects: all.subjects.iter().filter_map(tracking).collect(),
            left_out: server.left_out,
            refused: server.refused,
            elapsed_s: rounded(all.elapsed.as_secs_f64()),
            ended: all.ended,
        })
    }
}

fn tracking(of: &SubjectStatistics) -> Option<TrackingRecord<'_>> {
    let tracking = of.tracking?;
    Some(TrackingRecord {
        character: of.subject.id,
        name: &of.subject.name,
        segments: tracking.segments,
        tracked: tracking.tracked,
        frames_untracked: tracking.frames_untracked,
    })
}

impl From<ModelCounts> for ModelRecord {
    fn from(counts: ModelCounts) -> Self {
        let ModelCounts {
            marker_sets,
            rigid_bodies,
            skeletons,
            assets,
            force_plates,
            devices,
            cameras,
            unknown,
        } = counts;
        Self {
            marker_sets,
            rigid_bodies,
            skeletons,
            assets,
            force_plates,
            devices,
            cameras,
            unknown,
        }
    }
}

impl From<Clock> for ClockRecord {
    fn from(clock: Clock) -> Self {
        let milliseconds = |duration: Duration| rounded(duration.as_secs_f64() * 1000.0);
        Self {
            offset_ns: clock.offset_ns,
            uncertainty_ms: milliseconds(clock.uncertainty),
            round_trip_ms: milliseconds(clock.round_trip),
        }
    }
}

impl From<Latencies> for LatencyRecord {
    fn from(latencies: Latencies) -> Self {
        Self {
            camera_to_host: latencies.camera_to_host.map(Spread::from),
            software: latencies.software.map(Spread::from),
            host_to_here: latencies.host_to_here.map(Spread::from),
        }
    }
}
