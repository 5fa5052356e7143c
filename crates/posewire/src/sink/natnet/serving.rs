//! What a NatNet sink does, whichever of its threads does it.

use super::NatNetSinkOptions;
use super::faulty::FaultyFrames;
use super::gathering::{Gathering, Share};
use super::ledger::Ledger;
use super::ports::Ports;
use crate::clock::Clock;
use crate::endpoint::{Endpoint, NatNetAddress};
use crate::histogram::DurationHistogram;
use crate::sink::{LeftOut, Progress};
use crate::{Error, Result};
use posewire_motion::{Frame, Stamp, Subject};
use posewire_natnet::client::Mode;
use posewire_natnet::frame::HostStamps;
use posewire_natnet::motion::{Encoder, lacks};
use posewire_natnet::server::{Delivery, Server, ServerOptions};
use posewire_natnet::{Output, Socket, Transmit};
use std::collections::{BTreeMap, BTreeSet};
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The server, what it is fed with and what is counted.
pub(super) struct Serving {
    endpoint: String,
    /// Where frames go when nobody has to connect.
    group: Option<SocketAddr>,
    states_rate: bool,
    ports: Arc<Ports>,
    clock: Clock,
    server: Server,
    encoder: Encoder,
    /// By their numbers, as they were last described.
    subjects: BTreeMap<u32, Arc<Subject>>,
    gathering: Gathering,
    ledger: Ledger,
    frames: u64,
    lateness: DurationHistogram,
    progress: Arc<Mutex<Progress>>,
    next_summary: Instant,
    /// Subjects of which a frame has been looked at.
    seen: BTreeSet<u32>,
    faults: Option<FaultyFrames>,
    /// When the frame that is being sent was due.
    frame_due: Instant,
}

impl Serving {
    pub(super) fn new(address: &NatNetAddress, options: &NatNetSinkOptions, ports: Arc<Ports>) -> Self {
        let opened = NatNetAddress {
            port: ports.local_address().port(),
            data_port: ports.data_port,
            ..address.clone()
        };
        let group = (opened.mode == Mode::Multicast).then(|| (opened.group, opened.data_port).into());
        let serving = Self {
            server: Server::new(server_options(&opened, options)),
            endpoint: Endpoint::NatNet(opened).to_string(),
            group,
            states_rate: options.rate.is_some(),
            ports,
            clock: Clock::new(),
            encoder: Encoder::new(address.settings()),
            subjects: BTreeMap::new(),
            gathering: Gathering::new(options.gather),
            ledger: Ledger::default(),
            frames: 0,
            lateness: DurationHistogram::new(),
            progress: Arc::default(),
            next_summary: Instant::now(),
            seen: BTreeSet::new(),
            faults: options.faults.clone().map(FaultyFrames::new),
            frame_due: Instant::now(),
        };
        serving.publish();
        serving
    }

    pub(super) fn progress(&self) -> Arc<Mutex<Progress>> {
        Arc::clone(&self.progress)
    }

    pub(super) fn is_ready(&self) -> bool {
        self.group.is_some() || self.ledger.peers() > 0
    }

    /// How long the other thread may wait for commands before it looks whether something is due.
    pub(super) fn patience(&self) -> Duration {
        if self.gathering.subjects() > 1 { GATHERING } else { IDLE }
    }

    /// Tells clients of a subject that is new or changed.
    ///
    /// # Errors
    /// [`Error::Descriptions`] when it is one too many.
    pub(super) fn describe(&mut self, subject: &Arc<Subject>) -> Result<()> {
        self.gathering.expect(subject.id);
        if !self.take_over(subject)? {
            return Ok(());
        }
        if let Some(rate) = subject.rate.filter(|_| !self.states_rate) {
            self.server.set_frame_rate(rate as f32);
        }
        let subjects = self.gathering.subjects();
        self.server
            .set_model(self.encoder.model())
            .map_err(|error| Error::Descriptions { subjects, error })
    }

    /// Takes one frame; sends the packet that it completes, and before that the one that it ends.
    pub(super) fn take(&mut self, share: Share) -> Result<()> {
        self.describe_changed(&share.frame.subject)?;
        self.tell_left_out(&share.frame);
        if self.gathering.is_ended_by(&share.frame) {
            self.send()?;
        }
        self.gathering.push(Instant::now(), share);
        if self.gathering.is_complete() {
            self.send()?;
        }
        Ok(())
    }

    /// Answers a datagram of the command port.
    pub(super) fn answer(&mut self, from: SocketAddr, bytes: &[u8]) {
        self.server.handle(self.clock.steady(), from, bytes);
        self.act();
    }

    /// Does what is due: sends what has waited long enough, drops who is silent.
    pub(super) fn tend(&mut self) -> Result<()> {
        let now = Instant::now();
        if self.gathering.is_overdue(now) {
            self.send()?;
        }
        let stamp = self.clock.stamp_of(now);
        if self.server.timeout().is_some_and(|due| due <= stamp) {
            self.server.handle_timeout(stamp);
            self.act();
        }
        self.summarise(now);
        Ok(())
    }

    /// When [`send_delayed`](Self::send_delayed) is next due.
    pub(super) fn faults_timeout(&self) -> Option<Instant> {
        self.faults.as_ref()?.timeout()
    }

    /// Sends the frames that faults have delayed until `now`.
    pub(super) fn send_delayed(&mut self, now: Instant) {
        if let Some(faults) = &mut self.faults {
            faults.handle_timeout(now);
        }
        self.send_faulty();
    }

    /// Sends what is left and says goodbye.
    pub(super) fn finish(&mut self) -> Result<()> {
        let sent = self.send();
        if let Some(faults) = &mut self.faults {
            faults.finish();
        }
        self.send_faulty();
        self.server.close();
        self.act();
        self.publish();
        sent
    }

    fn describe_changed(&mut self, subject: &Arc<Subject>) -> Result<()> {
        // The same subject in nearly every frame, which the encoder tells by its pointer.
        if self.encoder.knows(subject) {
            Ok(())
        } else {
            self.describe(subject)
        }
    }

    /// Lets the encoder know of a subject. True when that changes the descriptions.
    fn take_over(&mut self, subject: &Arc<Subject>) -> Result<bool> {
        match self.subjects.insert(subject.id, Arc::clone(subject)) {
            Some(before) if before.name != subject.name => {
                // What is gathered is still of the old name.
                self.send()?;
                Ok(self.encoder.rename(&before, subject))
            }
            _ => Ok(self.encoder.describe(subject)),
        }
    }

    /// Tells once what of a subject's first frame NatNet has no place for.
    fn tell_left_out(&mut self, frame: &Frame) {
        if !self.seen.insert(frame.subject.id) {
            return;
        }
        for what in lacks(frame) {
            self.leave_out(what, "NatNet has no place for it");
        }
    }

    fn leave_out(&self, what: &str, why: &'static str) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        let what = what.to_owned();
        let entry = LeftOut { what, why };
        if !progress.left_out.contains(&entry) {
            progress.left_out.push(entry);
        }
    }

    /// Sends what is gathered to everybody.
    fn send(&mut self) -> Result<()> {
        let shares = self.gathering.take();
        if shares.is_empty() {
            return Ok(());
        }
        if self.gathering.comes_apart() {
            self.leave_out("frames with everybody in them", NUMBERED_APART);
        }
        let mut frame = self.encoder.frame(shares.iter().map(|share| &*share.frame));
        let due = shares.iter().filter_map(|share| share.due).min();
        self.frame_due = due.unwrap_or_else(Instant::now);
        frame.host_stamps = Some(self.host_stamps(&shares));
        if self.server.send_frame(&frame).is_err() {
            self.ledger.count_too_large();
        }
        self.act();
        self.count(&shares);
        match self.group {
            Some(group) if self.ledger.is_refused() => Err(unsendable(group)),
            _ => Ok(()),
        }
    }

    /// What a take holds was exposed and received when it was due; a live source tells when it was received.
    fn host_stamps(&self, shares: &[Share]) -> HostStamps {
        let now = self.clock.steady();
        let due = shares.iter().filter_map(|share| share.due).min();
        let due = due.map(|due| self.clock.stamp_of(due));
        let arrived = shares.iter().filter_map(|share| share.frame.received).max();
        let arrived = arrived.map(|arrived| self.clock.arrival(arrived, Duration::ZERO));
        let ticks = |stamp: Stamp| self.server.ticks(stamp.min(now));
        HostStamps {
            mid_exposure: due.map_or(0, ticks),
            data_received: due.or(arrived).map_or_else(|| ticks(now), ticks),
            transmit: ticks(now),
        }
    }

    /// Does what the server wants done.
    fn act(&mut self) {
        while let Some(output) = self.server.poll() {
            match output {
                Output::Transmit(transmit) => self.transmit(&transmit),
                Output::Event(event) => self.ledger.note(event),
            }
        }
    }

    fn transmit(&mut self, transmit: &Transmit) {
        match &mut self.faults {
            Some(faults) if transmit.socket == Socket::Data => {
                faults.handle(self.frame_due, transmit);
                self.send_faulty();
            }
            _ => self.send_packet(transmit),
        }
    }

    /// Sends what faults have let go.
    fn send_faulty(&mut self) {
        while let Some(frame) = self.faults.as_mut().and_then(FaultyFrames::poll) {
            self.send_packet(&frame);
        }
    }

    fn send_packet(&mut self, transmit: &Transmit) {
        let sent = self.ports.send(transmit);
        if transmit.socket == Socket::Data {
            self.ledger.count(transmit.to, sent);
        }
    }

    fn count(&mut self, shares: &[Share]) {
        let now = Instant::now();
        for due in shares.iter().filter_map(|share| share.due) {
            self.lateness.record(now.saturating_duration_since(due));
        }
        self.frames += shares.len() as u64;
        self.summarise(now);
    }

    fn summarise(&mut self, now: Instant) {
        if now >= self.next_summary {
            self.next_summary = now + SUMMARISE_EVERY;
            self.publish();
        }
    }

    fn publish(&self) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.frames = self.frames;
        progress.lateness = self.lateness.summary();
        progress.faults = self.faults.as_ref().map(FaultyFrames::counts);
        progress.targets = vec![self.ledger.progress(&self.endpoint, self.group.is_some())];
    }
}

fn unsendable(group: SocketAddr) -> Error {
    let kind = std::io::ErrorKind::NetworkUnreachable;
    let refused = std::io::Error::new(kind, "no frame can be sent; ?interface= names the network to use");
    Error::socket("send to", format!("udp {group}"), &refused)
}

fn server_options(opened: &NatNetAddress, options: &NatNetSinkOptions) -> ServerOptions {
    let usual = ServerOptions::default();
    ServerOptions {
        version: opened.version.unwrap_or(usual.version),
        delivery: match opened.mode {
            Mode::Unicast => Delivery::Unicast,
            Mode::Multicast => Delivery::Multicast(opened.group),
        },
        data_port: opened.data_port,
        silence_limit: options.silence_limit,
        copy_to_data_port: opened.copy,
        frame_rate: options.rate.map_or(usual.frame_rate, |rate| rate as f32),
        ..usual
    }
}

const NUMBERED_APART: &str =
    "the sources number their samples each for itself, so that each person is missing from frames";
/// How often it is looked whether gathered subjects have waited long enough.
const GATHERING: Duration = Duration::from_millis(10);
const IDLE: Duration = Duration::from_millis(50);
const SUMMARISE_EVERY: Duration = Duration::from_millis(100);
