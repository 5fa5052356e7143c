//! MXTP over TCP: MVN connects to us, or we to a streamer that listens.

mod peers;

use self::peers::{accept_peers, call_peer};
use super::intake::Intake;
use crate::endpoint::{Endpoint, TcpAddress, TcpMode};
use crate::net::{self, TcpIncoming};
use crate::queue::{Consumer, Policy, Producer, bounded};
use crate::session::Outlet;
use crate::source::report::TICK;
use crate::stop::Stop;
use crate::{Error, Notice, Result};
use posewire_motion::Stamp;
use posewire_mxtp::Framer;
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// A TCP endpoint that MXTP arrives on.
#[derive(Debug)]
pub(in crate::source) struct MxtpTcp {
    address: TcpAddress,
    way: Way,
}

/// Who calls whom.
#[derive(Debug)]
enum Way {
    Listen(TcpIncoming),
    /// The addresses that the host had at the beginning. They are not asked for again: an answer can take longer than
    /// an end may wait.
    Connect(Vec<SocketAddr>),
}

impl MxtpTcp {
    pub(in crate::source) fn open(address: &TcpAddress) -> Result<Self> {
        let mut address = address.clone();
        let way = if address.mode == Some(TcpMode::Connect) {
            Way::Connect(net::resolve(&address.host, address.port)?)
        } else {
            let incoming = net::listen(&address)?;
            address.port = incoming.local_address().port();
            Way::Listen(incoming)
        };
        Ok(Self { address, way })
    }

    pub(in crate::source) fn endpoint(&self) -> Endpoint {
        Endpoint::MxtpTcp(self.address.clone())
    }

    /// Runs until the stop, or until no sink is left. A connection that fails is told of and tried again.
    pub(in crate::source) fn run(self, outlet: &mut Outlet, stop: &Stop) {
        let (news, arriving) = bounded(QUEUED_READS, Policy::Lossless);
        // Not the session's: that one may never be set, as when there are no sinks.
        let ending = Stop::new();
        let connecting = start_connecting(self.way, news, ending.clone());
        let mut streams = Streams::new(Intake::new(outlet));
        while !stop.is_stopped() && streams.take(&arriving) {}
        ending.stop();
        streams.take_rest(&arriving);
        streams.finish();
        // A reader that waits for room in the queue must not be waited for.
        arriving.close();
        connecting
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    }
}

fn start_connecting(way: Way, news: Producer<News>, ending: Stop) -> JoinHandle<()> {
    thread::spawn(move || match way {
        Way::Listen(incoming) => accept_peers(&incoming, &news, &ending),
        Way::Connect(addresses) => call_peer(&addresses, &news, &ending),
    })
}

/// What the threads of the connections tell the source's.
#[derive(Debug)]
enum News {
    Connected {
        connection: usize,
        peer: String,
    },
    Bytes {
        connection: usize,
        at: Stamp,
        bytes: Vec<u8>,
    },
    Ended {
        connection: usize,
        at: Stamp,
        peer: String,
        reason: String,
    },
    /// No connection came about, and it will be tried again.
    NotConnected(Error),
}

/// The streams of all connections, being cut into datagrams.
struct Streams<'a> {
    framers: BTreeMap<usize, Framer>,
    /// Bytes skipped on connections that have ended.
    skipped_before: u64,
    batch: Vec<News>,
    intake: Intake<'a>,
}

impl<'a> Streams<'a> {
    fn new(intake: Intake<'a>) -> Self {
        Self {
            framers: BTreeMap::new(),
            skipped_before: 0,
            batch: Vec::new(),
            intake,
        }
    }

    /// Takes what arrives within a tick; `false` when nothing more can arrive, or no sink is left.
    fn take(&mut self, arriving: &Consumer<News>) -> bool {
        let drained = arriving.drain(&mut self.batch, TICK);
        let mut batch = std::mem::take(&mut self.batch);
        for news in batch.drain(..) {
            self.heed(news);
        }
        self.batch = batch;
        let skipped = self.skipped();
        self.intake.tick(0, skipped) && drained.is_open()
    }

    /// Takes what had arrived before the end, until the last thread has gone or the limit passes.
    fn take_rest(&mut self, arriving: &Consumer<News>) {
        let until = Instant::now() + REST_LIMIT;
        while Instant::now() < until && self.take(arriving) {}
    }

    fn heed(&mut self, news: News) {
        match news {
            News::Connected { connection, peer } => {
                self.framers.insert(connection, Framer::new());
                self.intake.notice(Notice::Connected { peer });
            }
            News::Bytes { connection, at, bytes } => {
                let framer = self.framers.entry(connection).or_default();
                framer.push(&bytes);
                take_datagrams(framer, at, &mut self.intake);
            }
            News::Ended {
                connection,
                at,
                peer,
                reason,
            } => {
                let mut framer = self.framers.remove(&connection).unwrap_or_default();
                framer.finish();
                take_datagrams(&mut framer, at, &mut self.intake);
                self.skipped_before += framer.skipped();
                self.intake.notice(Notice::Disconnected { peer, reason });
            }
            News::NotConnected(error) => self.intake.notice(Notice::NotConnected { error }),
        }
    }

    fn skipped(&self) -> u64 {
        self.skipped_before + self.framers.values().map(Framer::skipped).sum::<u64>()
    }

    fn finish(self) {
        let skipped = self.skipped();
        self.intake.finish(0, skipped);
    }
}

fn take_datagrams(framer: &mut Framer, at: Stamp, intake: &mut Intake<'_>) {
    while let Some(datagram) = framer.next_datagram() {
        intake.datagram(at, datagram);
    }
}

const QUEUED_READS: usize = 256;
/// Readers take far less; an attempt to connect that goes on has nothing to bring, and must be waited for all the same.
const REST_LIMIT: Duration = Duration::from_secs(1);
