//! Statistics of NatNet.

mod heard;

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use posewire_motion::{Frame, Stamp, Subject};
use posewire_natnet::client::{Client, ClockEstimate, FrameCounts, Mode, ReceivedFrame};
use posewire_natnet::command::ServerInfo;
use posewire_natnet::frame::{FrameParams, HostStamps};
use posewire_natnet::model::{Description, Model};
use posewire_natnet::{Quirks, Version};

use super::arrivals::Arrivals;
use super::{Clock, Counters, DatagramKind, Latencies, ModelCounts, ServerStatistics, Statistics};
use crate::endpoint::NatNetAddress;
use crate::histogram::DurationHistogram;
use heard::Heard;

/// Counts what arrives from a NatNet server, besides what the client counts.
#[derive(Debug)]
pub(crate) struct NatNetTally {
    started: Stamp,
    datagrams: u64,
    bytes: u64,
    malformed: u64,
    last_malformed: Option<String>,
    quirks: BTreeMap<posewire_natnet::Quirk, u64>,
    server: Option<(SocketAddr, ServerInfo)>,
    version: Version,
    better: Option<NatNetAddress>,
    model: Option<ModelCounts>,
    /// The server's clock as it was last known.
    clock: Option<Clock>,
    params: Option<FrameParams>,
    arrivals: Arrivals,
    camera_to_host: DurationHistogram,
    software: DurationHistogram,
    host_to_here: DurationHistogram,
    /// Frames so far; the newest has this number.
    frames: u64,
    subjects: BTreeMap<u32, Heard>,
}

/// What the sockets and clocks know and the client does not.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    /// The server that is called.
    pub(crate) server: SocketAddr,
    pub(crate) mode: Mode,
    pub(crate) group: Option<SocketAddr>,
    pub(crate) interface: Option<String>,
    pub(crate) kernel_dropped: u64,
    /// UTC now, and the steady clock that the client goes by.
    pub(crate) now: Stamp,
    pub(crate) steady: Stamp,
}

impl NatNetTally {
    pub(crate) fn new(started: Stamp) -> Self {
        Self {
            started,
            datagrams: 0,
            bytes: 0,
            malformed: 0,
            last_malformed: None,
            quirks: BTreeMap::new(),
            server: None,
            version: Version::UNSPECIFIED,
            better: None,
            model: None,
            clock: None,
            params: None,
            arrivals: Arrivals::default(),
            camera_to_host: DurationHistogram::new(),
            software: DurationHistogram::new(),
            host_to_here: DurationHistogram::new(),
            frames: 0,
            subjects: BTreeMap::new(),
        }
    }

    pub(crate) fn datagram(&mut self, bytes: usize) {
        self.datagrams += 1;
        self.bytes += bytes as u64;
    }

    pub(crate) fn malformed(&mut self, problem: String) {
        self.malformed += 1;
        self.last_malformed = Some(problem);
    }

    pub(crate) fn connected(&mut self, server: SocketAddr, info: ServerInfo) {
        self.version = info.server.natnet_version;
        let frequency = |info: &ServerInfo| info.connection.map(|connection| connection.clock_frequency);
        let is_known = |(at, known): &(SocketAddr, ServerInfo)| *at == server && frequency(known) == frequency(&info);
        let was_known = self.server.as_ref().is_some_and(is_known);
        self.clock = self.clock.filter(|_| was_known);
        self.server = Some((server, info));
    }

    /// The endpoint to use instead.
    pub(crate) fn better(&mut self, better: Option<NatNetAddress>) {
        self.better = better;
    }

    /// Whether no server has said yet who it is.
    pub(crate) fn is_nameless(&self) -> bool {
        self.server.is_none()
    }

    pub(crate) fn version(&mut self, version: Version) {
        self.version = version;
    }

    /// New descriptions, and the subjects that there are by them. Others are forgotten.
    pub(crate) fn model(&mut self, model: &Model, quirks: Quirks, subjects: &[Arc<Subject>]) {
        self.quirks(quirks);
        self.model = Some(counts(model));
        self.subjects
            .retain(|id, _| subjects.binary_search_by_key(id, |subject| subject.id).is_ok());
    }

    pub(crate) fn subject(&mut self, subject: &Arc<Subject>) {
        let fresh = || Heard::new(subject, self.frames);
        let heard = self.subjects.entry(subject.id).or_insert_with(fresh);
        heard.subject = Arc::clone(subject);
    }

    /// A frame, which arrived at `at`; [`sample`](Self::sample) for each subject in it follows.
    pub(crate) fn frame(&mut self, received: &ReceivedFrame, at: Stamp, clock: Option<ClockEstimate>) {
        self.frames += 1;
        self.arrivals.arrived(at);
        self.quirks(received.quirks);
        self.params = received.frame.params;
        if let Some(stamps) = received.frame.host_stamps {
            self.latencies(stamps, received.received, clock);
        }
    }

    /// What the frame says of one subject.
    pub(crate) fn sample(&mut self, frame: &Frame) {
        if let Some(heard) = self.subjects.get_mut(&frame.subject.id) {
            heard.sample(frame, self.frames);
        }
    }

    /// The numbers so far. Rates are those since the last report.
    pub(crate) fn report(&mut self, client: Option<&Client>, left_out: u64, link: &Link, ended: bool) -> Statistics {
        let frames = self.frames;
        Statistics {
            at: link.now,
            elapsed: link.now.since(self.started),
            ended,
            datagrams: self.datagrams,
            bytes: self.bytes,
            malformed: self.malformed,
            last_malformed: self.last_malformed.clone(),
            skipped_bytes: 0,
            kernel_dropped: link.kernel_dropped,
            characters_refused: 0,
            subjects: self.subjects.values().map(|heard| heard.report(frames)).collect(),
            server: client.and_then(|client| self.server(client, left_out, link, ended)),
        }
    }

    fn server(&mut self, client: &Client, left_out: u64, link: &Link, ended: bool) -> Option<Box<ServerStatistics>> {
        // A group can be listened to whose server answers nobody.
        let unknown = || (self.frames > 0).then(|| (link.server, ServerInfo::default()));
        let (address, info) = self.server.clone().or_else(unknown)?;
        let counters = self.counters(client.counts());
        let clock = client.clock(link.steady).map(|estimate| utc_clock(&estimate, link));
        self.clock = clock.or(self.clock);
        let has = |bits| self.params.map(|params| params.contains(bits));
        Some(Box::new(ServerStatistics {
            name: info.server.name.to_string(),
            app_version: info.server.app_version,
            address,
            connected: client.server_info().is_some(),
            version: client.version().unwrap_or(self.version),
            mode: link.mode,
            group: link.group,
            interface: link.interface.clone(),
            recording: has(FrameParams::RECORDING),
            edit_mode: has(FrameParams::EDIT_MODE),
            frames: self.arrivals.report(DatagramKind::NatNetFrame, counters, ended),
            clock: self.clock,
            latencies: self.latency_summaries(),
            model: self.model,
            left_out,
            refused: client.counts().refused,
            better: self.better.clone(),
        }))
    }

    fn counters(&self, counts: FrameCounts) -> Counters {
        let quirks = self.quirks.iter();
        Counters {
            datagrams: counts.received + counts.duplicate,
            received: counts.received,
            missing: counts.missing,
            duplicate: counts.duplicate + counts.repeated,
            late: counts.late,
            reset: counts.jumps,
            rewound: 0,
            jumped: 0,
            malformed: counts.malformed,
            incomplete: 0,
            stride: (counts.received > 1).then_some(1),
            quirks: quirks.map(|(quirk, count)| ((*quirk).into(), *count)).collect(),
        }
    }

    fn quirks(&mut self, quirks: Quirks) {
        if !quirks.is_empty() {
            quirks
                .iter()
                .for_each(|quirk| *self.quirks.entry(quirk).or_default() += 1);
        }
    }

    fn latencies(&mut self, stamps: HostStamps, received: Stamp, clock: Option<ClockEstimate>) {
        let connection = self.server.as_ref().and_then(|(_, info)| info.connection);
        let Some(frequency) = connection.map(|connection| connection.clock_frequency) else {
            return;
        };
        let time = |ticks: Option<u64>| ticks.and_then(|ticks| duration(ticks, frequency));
        if let Some(system) = time(stamps.system_latency()) {
            self.camera_to_host.record(system);
        }
        if let Some(software) = time(stamps.software_latency().filter(|_| stamps.data_received != 0)) {
            self.software.record(software);
        }
        if let Some(estimate) = clock.filter(|_| stamps.transmit != 0) {
            self.host_to_here
                .record(received.since(estimate.stamp_of(stamps.transmit)));
        }
    }

    fn latency_summaries(&self) -> Latencies {
        let known = |histogram: &DurationHistogram| Some(histogram.summary()).filter(|summary| summary.count > 0);
        Latencies {
            camera_to_host: known(&self.camera_to_host),
            software: known(&self.software),
            host_to_here: known(&self.host_to_here),
        }
    }
}

fn duration(ticks: u64, frequency: u64) -> Option<Duration> {
    let nanoseconds = (u128::from(ticks) * 1_000_000_000).checked_div(frequency.into())?;
    Some(Duration::from_nanos(u64::try_from(nanoseconds).unwrap_or(u64::MAX)))
}

fn utc_clock(estimate: &ClockEstimate, link: &Link) -> Clock {
    Clock {
        offset_ns: estimate.offset().saturating_add(link.now - link.steady),
        uncertainty: estimate.uncertainty,
        round_trip: estimate.round_trip,
    }
}

fn counts(model: &Model) -> ModelCounts {
    let mut counts = ModelCounts::default();
    for description in &model.descriptions {
        let count = match description {
            Description::MarkerSet(_) => &mut counts.marker_sets,
            Description::RigidBody(_) => &mut counts.rigid_bodies,
            Description::Skeleton(_) => &mut counts.skeletons,
            Description::ForcePlate(_) => &mut counts.force_plates,
            Description::Device(_) => &mut counts.devices,
            Description::Camera(_) => &mut counts.cameras,
            Description::Asset(_) => &mut counts.assets,
            _ => &mut counts.unknown,
        };
        *count += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn received(stamps: HostStamps) -> ReceivedFrame {
        let frame = posewire_natnet::frame::Frame {
            host_stamps: Some(stamps),
            ..posewire_natnet::frame::Frame::default()
        };
        ReceivedFrame {
            frame: Arc::new(frame),
            received: Stamp(5_000_000),
            late: false,
            order: posewire_natnet::client::FrameOrder::Next,
            quirks: Quirks::NONE,
        }
    }

    #[test]
    fn a_latency_is_absent_where_its_stamps_say_nothing() {
        let mut tally = NatNetTally::new(Stamp(0));
        let connection = posewire_natnet::command::ConnectionInfo {
            clock_frequency: 1000,
            data_port: 1511,
            is_multicast: false,
            group: [0; 4].into(),
        };
        let info = ServerInfo {
            connection: Some(connection),
            ..ServerInfo::default()
        };
        tally.connected(([127, 0, 0, 1], 1510).into(), info);
        let stamps = HostStamps {
            mid_exposure: 0,
            data_received: 10,
            transmit: 12,
        };
        tally.frame(&received(stamps), Stamp(0), None);
        let latencies = tally.latency_summaries();
        assert_eq!((latencies.camera_to_host, latencies.host_to_here), (None, None));
        assert_eq!(latencies.software.unwrap().max, Duration::from_millis(2));
        assert_eq!(duration(u64::MAX, 1), Some(Duration::from_nanos(u64::MAX)));
        assert_eq!(duration(1, 0), None);
    }
}
