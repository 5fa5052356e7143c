//! From datagrams to items.

mod remarks;

use std::sync::Arc;
use std::time::{Duration, Instant};

use posewire_motion::{Stamp, Subject};
use posewire_natnet::client::{Answer, Client, ClientOptions, DataSource, Event, Mode, ReceivedFrame};
use posewire_natnet::command::ServerInfo;
use posewire_natnet::model::Model;
use posewire_natnet::{MessageId, Output, Quirks, Transmit};
use std::net::SocketAddr;

use super::advice;
use super::naming::{Arrived, Naming};
use super::senders::Senders;
use super::silence::Silence;
use super::sockets::{Port, Sockets};
use crate::endpoint::NatNetAddress;
use crate::net::Received;
use crate::session::Outlet;
use crate::source::report::Reports;
use crate::source::timeline::Timeline;
use crate::stats::{Link, NatNetTally};
use crate::{Datagram, Error, Item, Notice};
use remarks::Told;

/// Drives the client, counts what it tells, and hands it on.
pub(in crate::source) struct Intake<'a> {
    /// What is to be sent from the command socket.
    pub(in crate::source) outbox: Vec<Transmit>,
    address: NatNetAddress,
    client: Client,
    naming: Naming,
    tally: NatNetTally,
    senders: Senders,
    server: SocketAddr,
    time: Timeline,
    /// When what is taken now was to leave, if it is played.
    due: Option<Instant>,
    /// When all that had arrived was last known to have been read.
    read_until: Stamp,
    /// How the server was last called.
    peer: String,
    silence: Silence,
    left_out: u64,
    begun: Instant,
    told: Told,
    reports: Reports,
    outlet: &'a mut Outlet,
}

impl<'a> Intake<'a> {
    pub(super) fn new(outlet: &'a mut Outlet, address: NatNetAddress, server: SocketAddr) -> Self {
        Self::at(Timeline::live(), outlet, address, server)
    }

    /// Goes by this time. What is played loses no connection, however long nothing comes, and is all of one server, whichever
    /// way its frames came.
    pub(in crate::source) fn at(
        time: Timeline,
        outlet: &'a mut Outlet,
        address: NatNetAddress,
        server: SocketAddr,
    ) -> Self {
        let senders = if time.is_live() { address.mode } else { Mode::Unicast };
        let options = client_options(&address, server, time);
        let mut intake = Self {
            outbox: Vec::new(),
            client: Client::new(time.steady(), options),
            naming: Naming::new(address.settings()),
            tally: NatNetTally::new(time.now()),
            senders: Senders::new(senders, server.ip()),
            server,
            time,
            due: None,
            read_until: time.steady(),
            peer: server.to_string(),
            silence: Silence::default(),
            left_out: 0,
            begun: Instant::now(),
            told: Told::default(),
            reports: Reports::new(),
            outlet,
            address,
        };
        intake.settle(time.now());
        intake
    }

    /// Goes on to a time of a capture; what is taken then was to leave when it is `due`.
    pub(in crate::source) fn go_on(&mut self, to: Stamp, due: Option<Instant>) {
        self.time.go_on(to);
        self.due = due;
    }

    /// Nothing more is to be known of the subjects: no frame waits for it.
    pub(in crate::source) fn know_all(&mut self) {
        self.naming.note_model();
        self.naming.note_rate();
    }

    /// Takes one datagram as it arrived; whether it was a frame.
    pub(in crate::source) fn datagram(&mut self, port: Port, received: Received<'_>) -> bool {
        self.outlet.push_datagram(|| Datagram {
            wire: port.wire,
            from: received.from,
            to: port.local,
            received: received.stamp,
            bytes: received.bytes.into(),
        });
        let is_frame = received.bytes.first_chunk() == Some(&MessageId::FRAME.0.to_le_bytes());
        let from = self.senders.known_as(received.from);
        self.tally.datagram(received.bytes.len());
        if is_frame && !self.is_from_server(from) {
            return false;
        }
        // What was read later can have come earlier: an echo waits in one socket while frames are waited for on the other, and
        // is no slower for that. Nor are those that have waited while this program was suspended.
        let arrival = self
            .time
            .arrival(received.stamp, self.time.steady().since(self.read_until));
        self.client.handle(arrival, from, received.bytes);
        self.silence.note_answer();
        self.settle(received.stamp);
        is_frame
    }

    /// Tells the sinks something about the connection.
    pub(in crate::source) fn notice(&mut self, notice: Notice) {
        self.outlet.push(Item::Notice(notice));
    }

    /// Whether something is to be done about time that has passed. What arrived until then is to be read first: it may
    /// have waited for as long, in this program's stead.
    pub(super) fn is_due(&self) -> bool {
        self.client.timeout().is_some_and(|due| due <= self.time.steady())
    }

    /// To be called when nothing is left to be read.
    pub(super) fn note_all_read(&mut self) {
        self.read_until = self.time.steady();
    }

    /// To be called after each batch: does what is due and hands everything to the sinks. `false` when no sink is left.
    pub(in crate::source) fn tick(&mut self, sockets: Option<&Sockets>) -> bool {
        let now = self.time.steady();
        if self.client.timeout().is_some_and(|due| due <= now) {
            self.client.handle_timeout(now);
            self.settle(self.time.now());
        }
        self.release(false);
        if let Some(sockets) = sockets {
            self.remark_on_silence(sockets);
        }
        self.remark_on_no_answer();
        self.remark_on_version();
        self.look_for_left_out();
        if self.reports.is_due() {
            self.report(sockets, false);
        }
        self.outlet.flush()
    }

    /// The data port to listen at, when a server that sends to each client answers and no frame comes.
    pub(super) fn misses_frames(&mut self) -> Option<u16> {
        let misses = self.address.mode == Mode::Unicast && self.silence.lasts(LISTEN_AFTER) && !self.silence.listened;
        if !misses {
            return None;
        }
        self.silence.listened = true;
        let connection = self.client.server_info()?.connection;
        let port = connection.map_or(self.address.data_port, |connection| connection.data_port);
        (port != 0 && connection.is_none_or(|connection| !connection.is_multicast)).then_some(port)
    }

    /// Keeps in mind why the data port cannot be listened at.
    pub(super) fn note_taken_port(&mut self, error: Error) {
        // On this machine it is the server that has it.
        self.silence.taken = (!self.senders.is_own()).then_some(error);
    }

    /// Says goodbye to the server.
    pub(super) fn disconnect(&mut self) {
        self.client.disconnect();
        self.settle(self.time.now());
    }

    /// The end of the stream: gives what has waited and the last numbers.
    pub(in crate::source) fn finish(mut self, sockets: Option<&Sockets>) {
        self.release(true);
        self.report(sockets, true);
        self.outlet.finish();
    }

    fn is_from_server(&mut self, from: SocketAddr) -> bool {
        let unanswered = self.tally.is_nameless() && self.begun.elapsed() >= LISTEN_AFTER;
        let is_waiting = unanswered || self.silence.lasts(LISTEN_AFTER);
        let Some(adopted) = self.senders.accepts(from.ip(), is_waiting) else {
            return false;
        };
        if adopted {
            let text = format!("frames come from {}, another address of the server", from.ip());
            self.notice(Notice::Remark { text });
        }
        true
    }

    /// Takes what the client has to say. What arrived did so at `at`.
    fn settle(&mut self, at: Stamp) {
        while let Some(output) = self.client.poll() {
            match output {
                Output::Transmit(transmit) => self.outbox.push(transmit),
                Output::Event(event) => self.heed(event, at),
            }
        }
    }

    fn heed(&mut self, event: Event, at: Stamp) {
        match event {
            Event::Connected { server, info } => self.connected(server, info),
            Event::Version(version) => self.tally.version(version),
            Event::Model { model, quirks } => self.model(&model, quirks),
            Event::Frame(frame) => {
                self.silence.broken();
                if let Some(frame) = self.naming.hold((frame, at)) {
                    self.forward(&frame);
                }
            }
            Event::Message(text) => tracing::info!(?text, "the server says"),
            Event::Answer { request, answer } if request == FRAME_RATE => self.rate(&answer),
            Event::Lost(reason) => {
                self.silence = Silence::default();
                let (peer, reason) = (self.peer.clone(), advice::of_loss(reason).to_owned());
                self.notice(Notice::Disconnected { peer, reason });
            }
            Event::Malformed { id, error } => {
                let kind = id.map_or_else(String::new, |id| format!("{id}: "));
                self.tally.malformed(format!("{kind}{error}"));
            }
            _ => {}
        }
    }

    fn connected(&mut self, server: SocketAddr, info: ServerInfo) {
        self.peer = advice::named(server, &info);
        let peer = self.peer.clone();
        self.notice(match self.time {
            Timeline::Live(_) => Notice::Connected { peer },
            // Nobody is there who could be connected to.
            Timeline::Played { .. } => Notice::Remark {
                text: format!("read as {peer}"),
            },
        });
        self.silence = Silence::begin();
        let better = advice::better(&self.address, &info);
        if let Some(better) = &better {
            self.silence.note_explained();
            let text = advice::of_delivery(better);
            self.notice(Notice::Remark { text });
        }
        self.tally.better(better);
        self.naming.wait();
        self.client.request(self.time.steady(), FRAME_RATE);
        self.tally.connected(server, info);
    }

    fn model(&mut self, model: &Model, quirks: Quirks) {
        self.naming.subjects.describe(model);
        self.naming.note_model();
        let subjects = self.naming.all();
        self.tally.model(model, quirks, &subjects);
        self.announce_all();
        self.remark_on_model(model);
    }

    fn rate(&mut self, answer: &Answer) {
        let rate = match answer {
            Answer::Response(response) => response.as_float().filter(|rate| (1e-3..=1e5).contains(rate)),
            _ => None,
        };
        self.naming.note_rate();
        if rate.is_some() {
            self.naming.subjects.set_rate(rate.map(f64::from));
            self.announce_all();
        }
    }

    /// Tells of the subjects, unless more is to be known of them in a moment.
    fn announce_all(&mut self) {
        if !self.naming.is_waiting() {
            for subject in self.naming.all() {
                self.announce(&subject);
            }
        }
    }

    fn announce(&mut self, subject: &Arc<Subject>) {
        if self.naming.is_news(subject) {
            self.tally.subject(subject);
            self.outlet.push(Item::Subject(Arc::clone(subject)));
        }
    }

    /// Hands on what has waited, when there is nothing more to wait for.
    fn release(&mut self, end: bool) {
        if let Some(frames) = self.naming.release(end) {
            self.announce_all();
            for frame in &frames {
                self.forward(frame);
            }
        }
    }

    fn forward(&mut self, (received, at): &Arrived) {
        let ReceivedFrame { frame, late, .. } = received;
        self.tally.frame(received, *at, self.client.clock(self.time.steady()));
        let mut samples = self.naming.read(frame);
        self.remark_on_sets(samples.is_empty() && !frame.marker_sets.is_empty());
        for mut sample in samples.drain(..) {
            self.announce(&sample.subject);
            self.tally.sample(&sample);
            (sample.received, sample.late) = (Some(*at), *late);
            let frame = Arc::new(sample);
            self.outlet.push(Item::Frame { frame, due: self.due });
        }
        self.naming.reuse(samples);
    }

    /// Bones that no description has, or too many subjects.
    fn look_for_left_out(&mut self) {
        let left_out = self.naming.subjects.left_out();
        if left_out > 0 && self.left_out == 0 {
            let text = "left out: bones that the server does not describe, or subjects beyond 2048".to_owned();
            self.notice(Notice::Remark { text });
            let now = self.time.steady();
            self.client.request_model(now);
            self.settle(self.time.now());
        }
        self.left_out = left_out;
    }

    fn report(&mut self, sockets: Option<&Sockets>, ended: bool) {
        let link = Link {
            server: self.server,
            mode: self.address.mode,
            group: sockets.and_then(Sockets::joined).map(|(group, _)| group),
            interface: sockets.map(|sockets| sockets.local().to_string()),
            kernel_dropped: sockets.map_or(0, Sockets::kernel_dropped),
            now: self.time.now(),
            steady: self.time.steady(),
        };
        let left_out = self.naming.subjects.left_out();
        let statistics = self.tally.report(Some(&self.client), left_out, &link, ended);
        self.outlet.push(Item::Statistics(Arc::new(statistics)));
    }
}

fn client_options(address: &NatNetAddress, server: SocketAddr, time: Timeline) -> ClientOptions {
    let listens = if time.is_live() { address.mode } else { Mode::Multicast };
    let mut options = ClientOptions::new(server, listens);
    options.version = address.version;
    if !time.is_live() {
        options.lost_after = FOR_EVER;
    }
    // Which of the addresses that send to a group is the server's is for `Senders` to say.
    options.data_source = match listens {
        Mode::Unicast => DataSource::Server,
        Mode::Multicast => DataSource::Any,
    };
    options
}

const FRAME_RATE: &str = "FrameRate";
/// Longer than stamps can tell, and short enough to be added up.
const FOR_EVER: Duration = Duration::from_hours(24 * 365 * 1000);
const LISTEN_AFTER: Duration = Duration::from_secs(1);
