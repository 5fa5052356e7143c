//! A TCP target: each peer has a queue and a thread of its own.

use crate::endpoint::{TcpAddress, TcpMode};
use crate::net::{self, Backoff, TcpConnection, TcpIncoming};
use crate::queue::{Consumer, Policy, Producer, bounded};
use crate::sink::notices::Notices;
use crate::stop::Stop;
use crate::{Error, Notice, Result};
use posewire_mxtp::motion::Datagrams;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The peers behind one TCP endpoint: the one that we connect to, or all that connect to us.
pub(crate) struct TcpTarget {
    peers: Arc<Peers>,
    connecting: Option<JoinHandle<()>>,
    /// The port that we listen on, if we do.
    port: Option<u16>,
}

/// The datagrams of one sample, back to back as they go over the wire.
#[derive(Clone)]
struct Sample {
    bytes: Arc<[u8]>,
    datagrams: u64,
}

struct Peers {
    /// Whether we connect: then what comes while the peer is away is a loss. A peer that came to us may leave.
    expected: bool,
    /// What each peer's queue holds.
    queued: usize,
    /// No new ones are taken; those that are there get what is queued until the limit.
    ending: Stop,
    queues: Mutex<Vec<Producer<Sample>>>,
    open: AtomicUsize,
    written: AtomicU64,
    dropped: AtomicU64,
    notices: Notices,
}

impl TcpTarget {
    /// Each peer's queue holds so many of what [`send`](Self::send) is given.
    pub(super) fn open(address: &TcpAddress, queued: usize) -> Result<Self> {
        let listens = address.mode == Some(TcpMode::Listen);
        let peers = Arc::new(Peers::new(!listens, queued));
        let serving = Arc::clone(&peers);
        if listens {
            let incoming = net::listen(address)?;
            let port = Some(incoming.local_address().port());
            let connecting = Some(thread::spawn(move || accept_peers(&incoming, &serving)));
            return Ok(Self {
                peers,
                connecting,
                port,
            });
        }
        let connection = net::connect(address, CONNECT_TIMEOUT)?;
        let (address, queue) = (address.clone(), peers.welcome());
        let connecting = Some(thread::spawn(move || {
            keep_connected(&address, connection, &queue, &serving);
        }));
        Ok(Self {
            peers,
            connecting,
            port: None,
        })
    }

    /// The port that is listened on, if any.
    pub(super) fn port(&self) -> Option<u16> {
        self.port
    }

    pub(super) fn peers(&self) -> usize {
        self.peers.open.load(Ordering::Relaxed)
    }

    pub(super) fn written(&self) -> u64 {
        self.peers.written.load(Ordering::Relaxed)
    }

    pub(super) fn dropped(&self) -> u64 {
        let queued: u64 = self.peers.lock().iter().map(Producer::dropped).sum();
        queued + self.peers.dropped.load(Ordering::Relaxed)
    }

    /// Who came and went.
    pub(super) fn notices(&self) -> Vec<Notice> {
        self.peers.notices.to_vec()
    }

    /// Queues the datagrams of one sample for every peer. Never waits.
    pub(super) fn send(&mut self, datagrams: &Datagrams) {
        let mut queues = self.peers.lock();
        if queues.is_empty() {
            self.peers.count_missed(1);
            return;
        }
        let sample = Sample {
            bytes: datagrams.as_bytes().into(),
            datagrams: datagrams.len() as u64,
        };
        // A queue closes with its connection, whose thread counts what was in it; this sample came too late for that.
        queues.retain(|queue| {
            let pushed = queue.push(sample.clone());
            self.peers.count_missed(u64::from(pushed.is_err()));
            pushed.is_ok()
        });
    }

    /// Lets every peer have what is queued, within [`FLUSH_LIMIT`].
    pub(super) fn finish(&mut self) {
        self.peers.ending.stop();
        self.peers.lock().iter().for_each(Producer::close);
        if let Some(connecting) = self.connecting.take() {
            connecting
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    }
}

impl Peers {
    fn new(expected: bool, queued: usize) -> Self {
        Self {
            expected,
            queued,
            ending: Stop::new(),
            queues: Mutex::default(),
            open: AtomicUsize::new(0),
            written: AtomicU64::new(0),
            dropped: AtomicU64::new(0),
            notices: Notices::default(),
        }
    }

    /// Counts samples that came while their peer was away.
    fn count_missed(&self, samples: u64) {
        if self.expected {
            self.dropped.fetch_add(samples, Ordering::Relaxed);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Producer<Sample>>> {
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A queue for a new peer.
    fn welcome(&self) -> Consumer<Sample> {
        let (producer, consumer) = bounded(self.queued, Policy::Newest);
        let mut queues = self.lock();
        if self.ending.is_stopped() {
            producer.close();
        }
        queues.push(producer);
        self.open.fetch_add(1, Ordering::Relaxed);
        consumer
    }

    /// Writes what is queued until the queue closes, the connection breaks or the flush limit passes.
    fn serve(&self, mut connection: TcpConnection, queue: &Consumer<Sample>) {
        let peer = connection.peer();
        self.notices.push(Notice::Connected { peer: peer.to_string() });
        let mut samples = Vec::new();
        let outcome = self.write_all(&mut connection, queue, &mut samples);
        queue.close();
        let left = (samples.len() + queue.len()) as u64;
        if let Err(error) = &outcome {
            self.notices.push(Notice::Disconnected {
                peer: peer.to_string(),
                reason: error.to_string(),
            });
        }
        match outcome {
            Ok(()) => {}
            Err(error @ Error::Stalled { .. }) => {
                tracing::warn!(%peer, %error, "samples dropped at the end");
                self.dropped.fetch_add(left, Ordering::Relaxed);
            }
            Err(error) => {
                tracing::warn!(%peer, %error, "connection lost");
                self.count_missed(left);
            }
        }
        self.dropped.fetch_add(queue.dropped(), Ordering::Relaxed);
        self.lock().retain(|producer| !producer.is_closed());
        self.open.fetch_sub(1, Ordering::Relaxed);
    }

    /// Writes sample by sample; the one that failed stays in `samples`.
    fn write_all(
        &self,
        connection: &mut TcpConnection,
        queue: &Consumer<Sample>,
        samples: &mut Vec<Sample>,
    ) -> Result<()> {
        let mut flush_until = None;
        while queue.drain_at_most(1, samples, Duration::from_hours(1)).is_open() {
            for sample in &*samples {
                self.write(connection, sample, &mut flush_until)?;
                self.written.fetch_add(sample.datagrams, Ordering::Relaxed);
            }
            samples.clear();
        }
        connection.finish()
    }

    /// Writes one sample, however long the peer takes; at the end only until the flush limit.
    fn write(&self, connection: &mut TcpConnection, sample: &Sample, flush_until: &mut Option<Instant>) -> Result<()> {
        let mut rest = &*sample.bytes;
        while !rest.is_empty() {
            if self.ending.is_stopped() {
                let until = *flush_until.get_or_insert_with(|| Instant::now() + FLUSH_LIMIT);
                if Instant::now() >= until {
                    return Err(connection.stalled(sample.bytes.len() - rest.len(), sample.bytes.len(), FLUSH_LIMIT));
                }
            }
            let written = connection.write_some(rest, Duration::from_millis(100))?;
            rest = rest.get(written..).unwrap_or_default();
        }
        Ok(())
    }
}

/// Serves the peer that we connect to, and connects again whenever it is lost.
fn keep_connected(address: &TcpAddress, first: TcpConnection, queue: &Consumer<Sample>, peers: &Peers) {
    peers.serve(first, queue);
    let mut backoff = Backoff::default();
    let mut is_told = false;
    while !peers.ending.wait(backoff.next_delay()) {
        match net::connect(address, RECONNECT_TIMEOUT) {
            Ok(connection) => {
                let begun = Instant::now();
                peers.serve(connection, &peers.welcome());
                if begun.elapsed() >= STEADY {
                    backoff.reset();
                }
                is_told = false;
            }
            Err(error) if !is_told => {
                peers.notices.push(Notice::NotConnected { error });
                is_told = true;
            }
            Err(_) => {}
        }
    }
}

/// Serves every peer that connects to us.
fn accept_peers(incoming: &TcpIncoming, peers: &Arc<Peers>) {
    let mut serving = Vec::new();
    while !peers.ending.is_stopped() {
        serving.retain(|thread: &JoinHandle<()>| !thread.is_finished());
        match incoming.accept(Duration::from_secs(1), &peers.ending) {
            Ok(Some(connection)) if serving.len() < MAX_PEERS => {
                let (queue, peers) = (peers.welcome(), Arc::clone(peers));
                serving.push(thread::spawn(move || peers.serve(connection, &queue)));
            }
            Ok(_) => {}
            Err(error) => {
                tracing::warn!(%error, "cannot accept a connection");
                peers.ending.wait(Duration::from_secs(1));
            }
        }
    }
    for thread in serving {
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    }
}

const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// An attempt cannot be cut short, so the end of the stream may have to wait for one.
const RECONNECT_TIMEOUT: Duration = Duration::from_secs(1);
/// A connection that lasted so long was one; a peer that hangs up at once is called less and less often.
const STEADY: Duration = Duration::from_secs(1);
const FLUSH_LIMIT: Duration = Duration::from_secs(2);
const MAX_PEERS: usize = 16;
