//! A source, listened to for a while.

use super::finding::sort;
use super::neighbours::{OtherPorts, OtherTransport};
use super::silence::{self, Circumstances};
use super::system::{Traffic, addresses, taken};
use super::{Check, Examination, Finding};
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

/// An endpoint that is opened to be listened to.
///
/// While it is open, an MXTP port is also held by the other transport, and after a second of silence so are MVN's usual ports,
/// to tell when the sender uses those.
#[derive(Debug)]
pub struct Listener {
    endpoint: Endpoint,
    opened: Opened,
}

#[derive(Debug)]
enum Opened {
    Source(Box<Source>, Option<OtherTransport>),
    /// Another program has the port.
    Taken(Finding),
}

impl Listener {
    /// Opens what an endpoint names, as a source does. A port that another program has is a finding and no error. The options
    /// choose what of a capture is read; their speed does not matter.
    ///
    /// # Errors
    /// All others of [`Source::open`].
    pub fn open(endpoint: &Endpoint, options: &PlaybackOptions) -> Result<Self> {
        let options = PlaybackOptions {
            speed: AT_ONCE,
            ..options.clone()
        };
        match Source::open(endpoint, &options) {
            Ok(source) => {
                let endpoint = captured(&source).unwrap_or_else(|| source.endpoint().clone());
                let other = OtherTransport::open(&endpoint).filter(|_| source.is_live());
                let opened = Opened::Source(Box::new(source), other);
                Ok(Self { endpoint, opened })
            }
            Err(error) if is_taken(&error) => Ok(Self {
                opened: Opened::Taken(taken(endpoint, &error)),
                endpoint: endpoint.clone(),
            }),
            Err(error) => Err(error),
        }
    }

    /// Where it is open, with the port that the system chose if it was 0; of a capture, what was captured.
    pub fn endpoint(&self) -> &Endpoint {
        &self.endpoint
    }

    /// Listens for `duration`, less when `stop` is set, and says what is wrong. A capture is read to its end, as fast as that
    /// goes.
    ///
    /// # Errors
    /// What ends the source.
    pub fn listen(self, duration: Duration, stop: &Stop) -> Result<Listened> {
        match self.opened {
            Opened::Source(source, other) => Listening::new(self.endpoint, &source).run(*source, other, duration, stop),
            Opened::Taken(finding) => Ok(Listened {
                findings: vec![finding],
                ..Listened::default()
            }),
        }
    }
}

fn is_taken(error: &Error) -> bool {
    let taken = ErrorKind::AddrInUse;
    matches!(error, Error::Socket { kind, .. } if *kind == taken)
}

/// The endpoint that a capture was taken at.
fn captured(source: &Source) -> Option<Endpoint> {
    source.captured()?.name.parse().ok()
}

/// A listener at work.
struct Listening {
    endpoint: Endpoint,
    examiner: Examiner,
    is_live: bool,
    begun: Instant,
}

impl Listening {
    fn new(endpoint: Endpoint, source: &Source) -> Self {
        Self {
            examiner: Examiner(Arc::new(Mutex::new(Examination::new(&endpoint)))),
            endpoint,
            is_live: source.is_live(),
            begun: Instant::now(),
        }
    }

    fn run(self, source: Source, other: Option<OtherTransport>, duration: Duration, stop: &Stop) -> Result<Listened> {
        let before = Traffic::now();
        let mut other_ports = None;
        let session = Session::start([source], vec![Box::new(self.examiner.clone())], stop.clone());
        if self.is_live {
            if !stop.wait(duration.min(QUIET)) && !self.examiner.lock().has_heard() {
                other_ports = OtherPorts::open(&self.endpoint);
            }
            stop.wait(duration.saturating_sub(QUIET));
            stop.stop();
        }
        session.wait()?;
        let traffic = Traffic::now().since(&before);
        Ok(self.result(&Circumstances {
            to_nobody: traffic.to_nobody,
            packets: traffic.packets,
            addresses: addresses(),
            other_transport: other.and_then(|other| other.heard()),
            elsewhere: other_ports.map(|ports| ports.heard()).unwrap_or_default(),
        }))
    }

    fn result(&self, around: &Circumstances) -> Listened {
        let (elapsed, examination) = (self.begun.elapsed(), self.examiner.lock());
        let mut findings = examination.findings();
        let is_mxtp = matches!(self.endpoint, Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_));
        if self.is_live && is_mxtp && !examination.has_understood() {
            let is_silent = !examination.has_heard();
            let of_silence = silence::findings(&self.endpoint, elapsed, around).into_iter();
            findings.extend(of_silence.filter(|finding| is_silent || finding.check != Check::NothingArrives));
        }
        sort(&mut findings);
        Listened {
            findings,
            elapsed,
            datagrams: examination.datagrams(),
            lost_here: examination.lost_here(),
        }
    }
}

/// Feeds an examination.
#[derive(Clone, Debug)]
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
