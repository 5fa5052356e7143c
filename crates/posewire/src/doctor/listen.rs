//! A source, listened to for a while.

use super::examiner::Examiner;
use super::finding::sort;
use super::neighbours::{OtherPorts, OtherTransport};
use super::silence::{self, Circumstances};
use super::system::{Traffic, addresses, holder, taken};
use super::{Check, Finding};
use crate::endpoint::Endpoint;
use crate::source::PlaybackOptions;
use crate::stop::Stop;
use crate::{Error, Result, Session, Source};
use std::io::ErrorKind;
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
    Live(Box<Source>, Option<OtherTransport>),
    /// The sources of a capture.
    Captured(Vec<Source>),
    /// Another program has the port.
    Taken(Finding),
}

impl Listener {
    /// Opens what an endpoint names, as sources do. A port that another program has is a finding and no error. The options
    /// choose what of a capture is read; their speed does not matter.
    ///
    /// # Errors
    /// All others of [`Source::open_all`].
    pub fn open(endpoint: &Endpoint, options: &PlaybackOptions) -> Result<Self> {
        if matches!(endpoint, Endpoint::Capture { .. }) {
            return Self::open_capture(endpoint, options);
        }
        match Source::open(endpoint, options) {
            Ok(source) => {
                let endpoint = source.endpoint().clone();
                let other = OtherTransport::open(&endpoint);
                let opened = Opened::Live(Box::new(source), other);
                Ok(Self { endpoint, opened })
            }
            Err(error) if is_taken(&error) => Ok(Self {
                opened: Opened::Taken(taken(endpoint, &error)),
                endpoint: endpoint.clone(),
            }),
            Err(error) => Err(error),
        }
    }

    fn open_capture(endpoint: &Endpoint, options: &PlaybackOptions) -> Result<Self> {
        let options = PlaybackOptions {
            speed: PlaybackOptions::AT_ONCE,
            ..options.clone()
        };
        let sources = Source::open_all(endpoint, &options)?;
        if let Endpoint::Capture { path } = endpoint
            && sources.iter().any(|source| source.captured().is_none())
        {
            return Err(Error::PosesAlone { path: path.clone() });
        }
        Ok(Self {
            endpoint: endpoint.clone(),
            opened: Opened::Captured(sources),
        })
    }

    /// Where it is open, with the port that the system chose if it was 0.
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
            Opened::Live(source, other) => Listening::begin(&self.endpoint).live(*source, other, duration, stop),
            Opened::Captured(sources) => read(sources, stop),
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

/// Reads a capture to its end.
fn read(sources: Vec<Source>, stop: &Stop) -> Result<Listened> {
    let begun = Instant::now();
    let endpoints: Vec<_> = sources.iter().map(captured).collect();
    let examiner = Examiner::of(&endpoints);
    Session::start(sources, vec![Box::new(examiner.clone())], stop.clone()).wait()?;
    Ok(Listened::new(&examiner, examiner.findings(), begun.elapsed()))
}

/// The endpoint that a source of a capture was taken at.
fn captured(source: &Source) -> Endpoint {
    let name = source.captured().and_then(|captured| captured.name.parse().ok());
    name.unwrap_or_else(|| source.endpoint().clone())
}

impl Listened {
    fn new(examiner: &Examiner, mut findings: Vec<Finding>, elapsed: Duration) -> Self {
        sort(&mut findings);
        Self {
            findings,
            elapsed,
            datagrams: examiner.datagrams(),
            lost_here: examiner.lost_here(),
        }
    }
}

/// A live endpoint that is listened to.
struct Listening<'a> {
    endpoint: &'a Endpoint,
    examiner: Examiner,
    begun: Instant,
    before: Traffic,
}

impl<'a> Listening<'a> {
    fn begin(endpoint: &'a Endpoint) -> Self {
        Self {
            examiner: Examiner::of([endpoint]),
            endpoint,
            begun: Instant::now(),
            before: Traffic::now(),
        }
    }

    fn live(self, source: Source, other: Option<OtherTransport>, duration: Duration, stop: &Stop) -> Result<Listened> {
        let session = Session::start([source], vec![Box::new(self.examiner.clone())], stop.clone());
        let is_quiet = !stop.wait(duration.min(QUIET)) && !self.examiner.has_heard();
        let other_ports = is_quiet.then(|| OtherPorts::open(self.endpoint)).flatten();
        stop.wait(duration.saturating_sub(QUIET));
        stop.stop();
        session.wait()?;
        let traffic = Traffic::now().since(&self.before);
        Ok(self.result(&Circumstances {
            to_nobody: traffic.to_nobody,
            packets: traffic.packets,
            addresses: addresses(),
            other_holder: self.other_holder(other.as_ref()),
            other_transport: other.and_then(|other| other.heard()),
            elsewhere: other_ports.map(|ports| ports.heard()).unwrap_or_default(),
        }))
    }

    /// Who has the port of the other transport, where we could not have it.
    fn other_holder(&self, other: Option<&OtherTransport>) -> Option<String> {
        if other.is_some() || self.examiner.has_heard() {
            return None;
        }
        holder(&OtherTransport::endpoint(self.endpoint)?)
    }

    fn result(&self, around: &Circumstances) -> Listened {
        let elapsed = self.begun.elapsed();
        let mut findings = self.examiner.findings();
        let is_mxtp = matches!(self.endpoint, Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_));
        if is_mxtp && !self.examiner.has_understood() {
            let is_silent = !self.examiner.has_heard();
            let of_silence = silence::findings(self.endpoint, elapsed, around).into_iter();
            findings.extend(of_silence.filter(|finding| is_silent || finding.check != Check::NothingArrives));
        }
        Listened::new(&self.examiner, findings, elapsed)
    }
}

/// After so long a silence other ports are listened to.
const QUIET: Duration = Duration::from_secs(1);
