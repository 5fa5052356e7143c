//! MXTP over TCP: MVN connects to us, or we to a streamer that listens.

use super::intake::{Intake, TICK};
use crate::clock::Clock;
use crate::endpoint::{Endpoint, TcpAddress, TcpMode};
use crate::net::{self, Backoff, TcpConnection, TcpIncoming};
use crate::queue::{Consumer, Policy, Producer, bounded};
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Notice, Result};
use posewire_motion::Stamp;
use posewire_mxtp::Framer;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// A TCP endpoint that MXTP arrives on.
#[derive(Debug)]
pub(in crate::source) struct MxtpTcp {
    address: TcpAddress,
    /// What to accept connections on; without it we connect.
    incoming: Option<TcpIncoming>,
}

impl MxtpTcp {
    pub(in crate::source) fn open(address: &TcpAddress) -> Result<Self> {
        let mut address = address.clone();
        let incoming = match address.mode {
            Some(TcpMode::Connect) => None,
            _ => Some(net::listen(&address)?),
        };
        if let Some(incoming) = &incoming {
            address.port = incoming.local_address().port();
        }
        Ok(Self { address, incoming })
    }

    pub(in crate::source) fn endpoint(&self) -> Endpoint {
        Endpoint::MxtpTcp(self.address.clone())
    }

    pub(in crate::source) fn run(self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        let (news, arriving) = bounded(QUEUED_READS, Policy::Lossless);
        let stop_connecting = stop.clone();
        let connecting = thread::spawn(move || {
            if let Some(incoming) = self.incoming {
                return accept_peers(&incoming, &news, &stop_connecting);
            }
            call_peer(&self.address, &news, &stop_connecting);
            Ok(())
        });
        take_in(&arriving, outlet, stop);
        // A reader that waits for room in the queue must not be waited for.
        arriving.close();
        connecting
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

/// What the thread of a connection tells the source's.
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
        peer: String,
        reason: String,
    },
}

/// Cuts the streams of all connections into datagrams, until the stop.
fn take_in(arriving: &Consumer<News>, outlet: &mut Outlet, stop: &Stop) {
    let mut intake = Intake::new(outlet);
    let mut framers: BTreeMap<usize, Framer> = BTreeMap::new();
    let mut skipped_before = 0;
    let mut batch = Vec::new();
    while arriving.drain(&mut batch, TICK).is_open() && !stop.is_stopped() {
        for news in batch.drain(..) {
            skipped_before += heed(news, &mut framers, &mut intake);
        }
        let skipped: u64 = framers.values().map(Framer::skipped).sum();
        if !intake.tick(0, skipped_before + skipped) {
            break;
        }
    }
    let skipped: u64 = framers.values().map(Framer::skipped).sum();
    intake.finish(0, skipped_before + skipped);
}

/// Acts on one piece of news; gives the bytes skipped on a connection that has ended.
fn heed(news: News, framers: &mut BTreeMap<usize, Framer>, intake: &mut Intake<'_>) -> u64 {
    match news {
        News::Connected { connection, peer } => {
            framers.insert(connection, Framer::new());
            intake.notice(Notice::Connected { peer });
        }
        News::Bytes { connection, at, bytes } => {
            let framer = framers.entry(connection).or_default();
            framer.push(&bytes);
            while let Some(datagram) = framer.next_datagram() {
                intake.datagram(at, datagram);
            }
        }
        News::Ended {
            connection,
            peer,
            reason,
        } => {
            intake.notice(Notice::Disconnected { peer, reason });
            return framers.remove(&connection).map_or(0, |framer| framer.skipped());
        }
    }
    0
}

/// Takes every peer that connects, each on a thread of its own, until the stop.
fn accept_peers(incoming: &TcpIncoming, news: &Producer<News>, stop: &Stop) -> Result<()> {
    let open = Arc::new(AtomicUsize::new(0));
    for connection in 0.. {
        let Some(accepted) = accept_within_limit(incoming, &open, stop)? else {
            break;
        };
        let (news, stop, open) = (news.clone(), stop.clone(), Arc::clone(&open));
        open.fetch_add(1, Ordering::Relaxed);
        thread::spawn(move || {
            read_from(accepted, connection, &news, &stop);
            open.fetch_sub(1, Ordering::Relaxed);
        });
    }
    Ok(())
}

/// The next connection while fewer than [`MAX_CONNECTIONS`] are open; `None` at the stop.
fn accept_within_limit(incoming: &TcpIncoming, open: &AtomicUsize, stop: &Stop) -> Result<Option<TcpConnection>> {
    while !stop.is_stopped() {
        if open.load(Ordering::Relaxed) >= MAX_CONNECTIONS {
            stop.wait(TICK);
        } else if let Some(connection) = incoming.accept(Duration::from_secs(1), stop)? {
            return Ok(Some(connection));
        }
    }
    Ok(None)
}

/// Connects, and connects again whenever the connection is lost, until the stop.
fn call_peer(address: &TcpAddress, news: &Producer<News>, stop: &Stop) {
    let mut backoff = Backoff::default();
    for connection in 0.. {
        match net::connect(address, CONNECT_TIMEOUT) {
            Ok(connected) => {
                backoff.reset();
                read_from(connected, connection, news, stop);
            }
            Err(error) => tracing::debug!(%error, "not connected yet"),
        }
        if stop.wait(backoff.next_delay()) {
            break;
        }
    }
}

/// Hands over what a peer sends until it ends, the queue closes or the stop.
fn read_from(mut from: TcpConnection, connection: usize, news: &Producer<News>, stop: &Stop) {
    let peer = from.peer().to_string();
    if news
        .push(News::Connected {
            connection,
            peer: peer.clone(),
        })
        .is_ok()
    {
        let reason = read_all(&mut from, connection, news, stop);
        // When the queue is closed nobody is left to be told.
        let _ = news.push(News::Ended {
            connection,
            peer,
            reason,
        });
    }
}

/// Why nothing more is read.
fn read_all(from: &mut TcpConnection, connection: usize, news: &Producer<News>, stop: &Stop) -> String {
    let clock = Clock::new();
    let mut buffer = vec![0; READ_SIZE];
    while !stop.is_stopped() {
        let count = match from.read(&mut buffer, Duration::from_millis(100)) {
            Ok(None) => continue,
            Ok(Some(0)) => return "it ended the stream".to_owned(),
            Ok(Some(count)) => count,
            Err(error) => return error.to_string(),
        };
        let bytes = buffer.get(..count).unwrap_or_default().to_vec();
        if news
            .push(News::Bytes {
                connection,
                at: clock.now(),
                bytes,
            })
            .is_err()
        {
            break;
        }
    }
    "this program is stopping".to_owned()
}

const QUEUED_READS: usize = 256;
const READ_SIZE: usize = 64 * 1024;
const MAX_CONNECTIONS: usize = 16;
const CONNECT_TIMEOUT: Duration = Duration::from_secs(2);
