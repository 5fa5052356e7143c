//! A NatNet server whose frames are those of a capture, byte for byte.

use crate::capture::{CaptureOptions, CapturedSource, Opening};
use crate::clock::Clock;
use crate::endpoint::{Endpoint, NatNetAddress};
use crate::faults::{FaultCounts, FaultPlan};
use crate::sink::{FaultyFrames, NatNetLedger, NatNetPorts, TargetProgress};
use crate::stop::Stop;
use crate::{Error, Result};
use posewire_natnet::client::Mode;
use posewire_natnet::command::ServerInfo;
use posewire_natnet::model::Model;
use posewire_natnet::server::{Delivery, Event, Server, ServerOptions};
use posewire_natnet::{Message, MessageId, Output, Packet, Socket, Transmit, Version};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// A NatNet server whose frames are those of a capture, byte for byte.
///
/// Commands are answered as the captured server would: its name, version, descriptions and rate. Frames go as they are to every
/// client, or to the group; for a client that asks for an older version they are written anew.
pub(super) struct RawServer {
    endpoint: String,
    is_group: bool,
    faults: Option<FaultyFrames>,
    /// What offsets are counted from for the faults, which know times of the clock alone.
    opened: Instant,
    shared: Arc<Shared>,
    answering: Option<JoinHandle<()>>,
}

struct Shared {
    ports: NatNetPorts,
    server: Mutex<Server>,
    /// Taken after the server, where both are.
    ledger: Mutex<NatNetLedger>,
    clock: Clock,
    ending: Stop,
}

impl RawServer {
    pub(super) fn open(
        path: &Path,
        options: &CaptureOptions,
        source: &CapturedSource,
        address: &NatNetAddress,
        faults: Option<&FaultPlan>,
    ) -> Result<Self> {
        let opening = Opening::find(path, options, source)?;
        let ports = NatNetPorts::open(address)?;
        let address = NatNetAddress {
            port: ports.local_address().port(),
            data_port: ports.data_port,
            ..address.clone()
        };
        let options = server_options(&opening, &address);
        let version = options.version;
        let mut server = Server::new(options);
        if let Some(model) = opening.model(version) {
            let subjects = model.descriptions.len();
            let set = server.set_model(model);
            set.map_err(|error| Error::Descriptions { subjects, error })?;
        }
        let shared = Arc::new(Shared {
            ports,
            server: Mutex::new(server),
            ledger: Mutex::default(),
            clock: Clock::new(),
            ending: Stop::new(),
        });
        let answers = Arc::clone(&shared);
        Ok(Self {
            is_group: address.mode == Mode::Multicast,
            endpoint: Endpoint::NatNet(address).to_string(),
            faults: faults.cloned().map(FaultyFrames::new),
            opened: Instant::now(),
            shared,
            answering: Some(thread::spawn(move || answers.answer_all())),
        })
    }

    /// Whether somebody is there; of a group nobody knows.
    pub(super) fn is_ready(&self) -> bool {
        self.is_group || !self.shared.lock().clients().is_empty()
    }

    /// Sends a frame that was due at `offset` to all who get frames.
    pub(super) fn send(&mut self, offset: Duration, bytes: &[u8]) {
        let due = self.at(offset);
        for frame in self.shared.relay(bytes) {
            match &mut self.faults {
                Some(faults) => faults.handle(due, &frame),
                None => self.transmit(&frame),
            }
        }
        self.send_faulty();
    }

    /// When what faults hold back is due.
    pub(super) fn timeout(&self) -> Option<Duration> {
        let at = self.faults.as_ref().and_then(FaultyFrames::timeout)?;
        Some(at.saturating_duration_since(self.opened))
    }

    pub(super) fn handle_timeout(&mut self, offset: Duration) {
        let due = self.at(offset);
        if let Some(faults) = &mut self.faults {
            faults.handle_timeout(due);
        }
        self.send_faulty();
    }

    /// Lets go what faults hold back.
    pub(super) fn finish_faults(&mut self) {
        if let Some(faults) = &mut self.faults {
            faults.finish();
        }
        self.send_faulty();
    }

    /// How often what was done on purpose.
    pub(super) fn fault_counts(&self) -> Option<FaultCounts> {
        self.faults.as_ref().map(FaultyFrames::counts)
    }

    fn at(&self, offset: Duration) -> Instant {
        self.opened.checked_add(offset).unwrap_or(self.opened)
    }

    fn send_faulty(&mut self) {
        while let Some(frame) = self.faults.as_mut().and_then(FaultyFrames::poll) {
            self.transmit(&frame);
        }
    }

    fn transmit(&mut self, frame: &Transmit) {
        let sent = self.shared.ports.send(frame);
        self.shared.ledger().count(frame.to, sent);
    }

    pub(super) fn finish(&mut self) {
        self.shared.ending.stop();
        self.shared.lock().close();
        self.shared.transmit();
        if let Some(answering) = self.answering.take() {
            answering
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    }

    pub(super) fn progress(&self) -> TargetProgress {
        self.shared.ledger().progress(&self.endpoint, self.is_group)
    }
}

/// Whether a packet is a frame, and not a question or an answer.
pub(super) fn is_frame(bytes: &[u8]) -> bool {
    Packet::decode(bytes).is_ok_and(|packet| packet.id == MessageId::FRAME)
}

impl Drop for RawServer {
    /// One that was never finished, as another target could not be opened, does not answer for ever.
    fn drop(&mut self) {
        self.shared.ending.stop();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Server> {
        self.server.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn ledger(&self) -> MutexGuard<'_, NatNetLedger> {
        self.ledger.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What goes to each who gets this frame.
    fn relay(&self, bytes: &[u8]) -> Vec<Transmit> {
        let mut server = self.lock();
        if let Err(error) = server.relay_frame(bytes) {
            tracing::warn!(%error, "cannot write a frame anew for a client of another version");
        }
        let mut frames = Vec::new();
        while let Some(output) = server.poll() {
            match output {
                Output::Transmit(transmit) if transmit.socket == Socket::Data => frames.push(transmit),
                output => self.answer(output),
            }
        }
        frames
    }

    /// Answers commands until the end.
    fn answer_all(&self) {
        let mut buffer = vec![0; LONGEST];
        while !self.ending.is_stopped() {
            let received = self.ports.receive(TICK, &mut buffer, |from, bytes| {
                self.lock().handle(self.clock.steady(), from, bytes);
            });
            if let Err(error) = received {
                tracing::warn!(%error, "cannot receive commands");
                self.ending.wait(TICK);
            }
            self.lock().handle_timeout(self.clock.steady());
            self.transmit();
        }
    }

    fn transmit(&self) {
        let mut server = self.lock();
        while let Some(output) = server.poll() {
            self.answer(output);
        }
    }

    fn answer(&self, output: Output<Event>) {
        match output {
            // An answer that does not get through is asked for again.
            Output::Transmit(transmit) => drop(self.ports.send(&transmit)),
            Output::Event(event) => self.ledger().note(event),
        }
    }
}

impl Opening {
    /// The first descriptions that were captured.
    fn model(&self, version: Version) -> Option<Model> {
        self.packets
            .iter()
            .find_map(|bytes| match Message::decode(version, bytes) {
                Ok((Message::Model(model), _)) => Some(model),
                _ => None,
            })
    }

    fn server_info(&self) -> Option<ServerInfo> {
        self.packets.iter().find_map(|bytes| {
            let packet = Packet::decode(bytes).ok()?;
            let is_info = packet.id == MessageId::SERVER_INFO;
            is_info
                .then(|| ServerInfo::decode(packet.payload).ok())?
                .map(|(info, _)| info)
        })
    }

    fn rate(&self) -> Option<f32> {
        self.packets.iter().find_map(|bytes| {
            let packet = Packet::decode(bytes).ok()?;
            let is_rate = packet.id == MessageId::RESPONSE;
            is_rate.then(|| packet.payload.try_into().ok().map(f32::from_le_bytes))?
        })
    }
}

fn server_options(opening: &Opening, address: &NatNetAddress) -> ServerOptions {
    let mut options = ServerOptions {
        delivery: match address.mode {
            Mode::Unicast => Delivery::Unicast,
            Mode::Multicast => Delivery::Multicast(address.group),
        },
        data_port: address.data_port,
        copy_to_data_port: address.copy,
        ..ServerOptions::default()
    };
    if let Some(info) = opening.server_info() {
        options.name = info.server.name;
        options.app_version = info.server.app_version;
        options.version = info.server.natnet_version;
        if let Some(connection) = info.connection.filter(|connection| connection.clock_frequency > 0) {
            options.clock_frequency = connection.clock_frequency;
        }
    }
    if let Some(rate) = opening.rate() {
        options.frame_rate = rate;
    }
    options
}

const LONGEST: usize = 65_535;
const TICK: Duration = Duration::from_millis(20);
