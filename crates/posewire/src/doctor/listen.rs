//! A source, listened to for a while.

use super::neighbours::{OtherPorts, OtherTransport};
use super::silence::{self, Circumstances};
use super::system::{Traffic, addresses, taken};
use super::{Examination, Finding, finding};
use crate::endpoint::Endpoint;
use crate::queue::Policy;
use crate::source::PlaybackOptions;
use crate::stop::Stop;
use crate::{Error, Item, Result, Session, Sink, Source, SourceId, Wants};
use std::io::ErrorKind;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// What was found by listening.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Listened {
    /// What was found, the worst first.
    pub findings: Vec<Finding>,
    /// For how long it was listened; of a capture, how long reading it took.
    pub elapsed: Duration,
    /// Datagrams that came, of whatever protocol.
    pub datagrams: u64,
    /// Datagrams that arrived on this machine and were lost here.
    pub lost_here: u64,
}

/// Listens to an endpoint for `duration`, less when `stop` is set, and says what is wrong with it. A capture is read to its
/// end, as fast as that goes.
///
/// While it listens to an MXTP port it also holds the same port of the other transport, and, after a silence, MVN's usual
/// ports, to tell when the sender uses those.
///
/// # Errors
/// Those of [`Source::open`], but for a port that another program has, which is a finding; and what ends the source.
pub fn listen(endpoint: &Endpoint, duration: Duration, stop: &Stop) -> Result<Listened> {
    let options = PlaybackOptions {
        speed: AT_ONCE,
        ..PlaybackOptions::default()
    };
    let source = match Source::open(endpoint, &options) {
        Ok(source) => source,
        Err(error) if is_taken(&error) => return Ok(of_taken_port(endpoint, &error)),
        Err(error) => return Err(error),
    };
    let endpoint = captured(&source).unwrap_or_else(|| source.endpoint().clone());
    let examiner = Examiner(Arc::new(Mutex::new(Examination::new(&endpoint))));
    let begun = Instant::now();
    let listener = Listener {
        endpoint,
        examiner,
        is_live: source.is_live(),
    };
    let around = listener.run(source, duration, stop)?;
    Ok(listener.result(begun.elapsed(), &around))
}

fn is_taken(error: &Error) -> bool {
    matches!(
        error,
        Error::Socket {
            kind: ErrorKind::AddrInUse,
            ..
        }
    )
}

fn of_taken_port(endpoint: &Endpoint, error: &Error) -> Listened {
    Listened {
        findings: vec![taken(endpoint, error)],
        ..Listened::default()
    }
}

/// The endpoint that a capture was taken at.
fn captured(source: &Source) -> Option<Endpoint> {
    source.captured()?.name.parse().ok()
}

struct Listener {
    endpoint: Endpoint,
    examiner: Examiner,
    is_live: bool,
}

impl Listener {
    /// Listens to the end; gives what else was seen.
    fn run(&self, source: Source, duration: Duration, stop: &Stop) -> Result<Circumstances> {
        let before = Traffic::now();
        let other_transport = OtherTransport::open(&self.endpoint).filter(|_| self.is_live);
        let mut other_ports = None;
        let session = Session::start([source], vec![Box::new(self.examiner.clone())], stop.clone());
        if self.is_live {
            if !stop.wait(duration.min(QUIET)) && !self.examiner.lock().has_heard() {
                other_ports = Some(OtherPorts::open(&self.endpoint));
            }
            stop.wait(duration.saturating_sub(QUIET));
            stop.stop();
        }
        session.wait()?;
        let traffic = Traffic::now().since(&before);
        Ok(Circumstances {
            to_nobody: traffic.to_nobody,
            packets: traffic.packets,
            addresses: addresses(),
            other_transport: other_transport.and_then(|other| other.heard()),
            elsewhere: other_ports.map(|ports| ports.heard()).unwrap_or_default(),
        })
    }

    fn result(&self, elapsed: Duration, around: &Circumstances) -> Listened {
        let examination = self.examiner.lock();
        let mut findings = examination.findings();
        let is_mxtp = matches!(self.endpoint, Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_));
        if self.is_live && is_mxtp && !examination.has_understood() {
            let is_silent = !examination.has_heard();
            let of_silence = silence::findings(&self.endpoint, elapsed, around).into_iter();
            findings.extend(of_silence.filter(|finding| is_silent || finding.check != super::Check::NothingArrives));
        }
        finding::sort(&mut findings);
        Listened {
            findings,
            elapsed,
            datagrams: examination.datagrams(),
            lost_here: examination.lost_here(),
        }
    }
}

/// Feeds an examination.
#[derive(Clone)]
struct Examiner(Arc<Mutex<Examination>>);

impl Examiner {
    fn lock(&self) -> MutexGuard<'_, Examination> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for Examiner {
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, QUEUED_ITEMS)
    }

    fn wants(&self) -> Wants {
        Wants::ALL
    }

    fn accept(&mut self, _: SourceId, item: &Item) -> Result<()> {
        self.lock().take(item);
        Ok(())
    }
}

/// As many times as fast as it was captured; then only reading takes time.
const AT_ONCE: f64 = 1e6;
/// After so long a silence other ports are listened to.
const QUIET: Duration = Duration::from_secs(1);
/// A second or so of many people.
const QUEUED_ITEMS: usize = 65_536;
