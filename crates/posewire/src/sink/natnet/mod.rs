//! NatNet to its clients, as Motive serves it.

mod faulty;
mod gathering;
mod ledger;
mod ports;
mod serving;

use super::OnlySource;
use super::{Progress, Sink};
use crate::endpoint::NatNetAddress;
use crate::faults::FaultPlan;
use crate::stop::Stop;
use crate::{Item, Result, SourceId};
pub(crate) use faulty::FaultyFrames;
use gathering::Share;
pub(crate) use ledger::Ledger;
pub(crate) use ports::Ports;
use posewire_motion::{Frame, Subject};
use serving::Serving;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How clients are served.
#[derive(Clone, Debug, PartialEq)]
pub struct NatNetSinkOptions {
    /// A name instead of each subject's own.
    pub name: Option<String>,
    /// Frames a second, for clients who ask; the subject's own rate if absent, and 120 where it has none.
    pub rate: Option<f64>,
    /// Silence after which a client is dropped and told so; `None` for never.
    pub silence_limit: Option<Duration>,
    /// How long the subjects of a sample may come after each other and still share a frame.
    pub gather: Duration,
    /// What is to go wrong with the frames; answers to clients are spared.
    pub faults: Option<FaultPlan>,
}

impl Default for NatNetSinkOptions {
    /// The subjects' own names and rates; clients are dropped after 10 s, and subjects may come 10 ms after each other.
    fn default() -> Self {
        Self {
            name: None,
            rate: None,
            silence_limit: Some(Duration::from_secs(10)),
            gather: Duration::from_millis(10),
            faults: None,
        }
    }
}

/// Serves every frame to the NatNet clients that connect, or to a group, as Motive does.
///
/// A thread answers commands from the moment of opening, also while no frame comes. Frames leave from the data port,
/// each to every client in the client's own version, and nobody is waited for: what the system has no room for is
/// counted for the client that it was for, and a client that has vanished is dropped after
/// [`silence_limit`](NatNetSinkOptions::silence_limit). What a client's own system drops because it does not read cannot be
/// known here.
///
/// The samples of several subjects that have the same number become one NatNet frame. It is sent when all of them have
/// come, when a sample of another number comes, or [`gather`](NatNetSinkOptions::gather) after the first of them; a subject that is missing from
/// eight frames in a row is waited for no more.
///
/// Host stamps say of a paced source that exposure and reception were when the sample was due, of a live one
/// when it was received.
///
/// ```
/// use posewire::endpoint::Endpoint;
/// use posewire::sink::{NatNetSink, NatNetSinkOptions};
///
/// let Endpoint::NatNet(address) = "natnet://127.0.0.1:0?data-port=0".parse()? else { panic!() };
/// let sink = NatNetSink::open(&address, NatNetSinkOptions::default())?;
/// assert!(!sink.is_ready(), "nobody has connected yet");
/// # Ok::<(), posewire::Error>(())
/// ```
pub struct NatNetSink {
    options: NatNetSinkOptions,
    only: OnlySource,
    shared: Arc<Shared>,
    answering: Option<JoinHandle<()>>,
    /// The subjects under the name that the options give, as the source has them and as they are sent.
    renamed: Vec<(Arc<Subject>, Arc<Subject>)>,
}

/// What the thread that answers commands shares with the sink.
struct Shared {
    ports: Arc<Ports>,
    serving: Mutex<Serving>,
    ending: Stop,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Serving> {
        self.serving.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl NatNetSink {
    /// Binds the command port and the data port and begins to answer clients.
    ///
    /// # Errors
    /// What keeps a port from being bound: an address that is not this machine's, an interface that is not there, a port
    /// in use; the error's help says by which option another is chosen.
    pub fn open(address: &NatNetAddress, options: NatNetSinkOptions) -> Result<Self> {
        let ports = Arc::new(Ports::open(address)?);
        let shared = Arc::new(Shared {
            serving: Mutex::new(Serving::new(address, &options, Arc::clone(&ports))),
            ports,
            ending: Stop::new(),
        });
        let serving = Arc::clone(&shared);
        Ok(Self {
            options,
            only: OnlySource::default(),
            shared,
            answering: Some(thread::spawn(move || answer(&serving))),
            renamed: Vec::new(),
        })
    }

    /// Tells clients of subjects before their first frames, so that who connects early already gets their descriptions.
    ///
    /// # Errors
    /// [`Error::Descriptions`](crate::Error::Descriptions) when there are too many for one datagram.
    pub fn describe(&mut self, subject: &Arc<Subject>) -> Result<()> {
        let subject = self.named(subject);
        self.shared.lock().describe(&subject)
    }

    /// Whether anybody is there to be sent to: a client, or a group, in which nobody has to connect.
    pub fn is_ready(&self) -> bool {
        self.shared.lock().is_ready()
    }

    /// A handle to the numbers so far, for any thread. They are brought up to date ten times a second and at the end.
    pub fn progress(&self) -> Arc<Mutex<Progress>> {
        self.shared.lock().progress()
    }

    /// The subject as it is sent.
    fn named(&mut self, subject: &Arc<Subject>) -> Arc<Subject> {
        let Some(name) = &self.options.name else {
            return Arc::clone(subject);
        };
        if let Some((_, sent)) = self.renamed.iter().find(|(known, _)| Arc::ptr_eq(known, subject)) {
            return Arc::clone(sent);
        }
        let sent = Arc::new(Subject {
            name: name.clone(),
            ..(**subject).clone()
        });
        self.renamed.retain(|(known, _)| known.id != subject.id);
        self.renamed.push((Arc::clone(subject), Arc::clone(&sent)));
        sent
    }

    /// The frame as it is sent.
    fn framed(&mut self, frame: &Arc<Frame>) -> Arc<Frame> {
        if self.options.name.is_none() {
            return Arc::clone(frame);
        }
        let subject = self.named(&frame.subject);
        Arc::new(Frame {
            subject,
            ..(**frame).clone()
        })
    }

    /// Ends the thread that answers, and gives how it ended.
    fn end(&mut self) -> thread::Result<()> {
        self.shared.ending.stop();
        self.answering.take().map_or(Ok(()), JoinHandle::join)
    }
}

impl Sink for NatNetSink {
    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        self.only.check(source)?;
        match item {
            Item::Subject(subject) => self.describe(subject),
            Item::Frame { frame, due } => {
                let (frame, due) = (self.framed(frame), *due);
                self.shared.lock().take(Share { frame, due })
            }
            _ => Ok(()),
        }
    }

    fn timeout(&self) -> Option<Instant> {
        self.options.faults.as_ref()?;
        self.shared.lock().faults_timeout()
    }

    fn handle_timeout(&mut self) -> Result<()> {
        self.shared.lock().send_delayed(Instant::now());
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        // A panic of the other thread goes on here: it is a defect, not an outcome.
        self.end().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        self.shared.lock().finish()
    }
}

impl Drop for NatNetSink {
    /// Frees the ports, also where the sink was not finished.
    fn drop(&mut self) {
        let _ = self.end();
    }
}

/// Answers commands and does what time demands, until the end.
fn answer(shared: &Shared) {
    let mut buffer = vec![0; LARGEST_DATAGRAM];
    while !shared.ending.is_stopped() {
        let patience = shared.lock().patience();
        let answer = |from, bytes: &[u8]| shared.lock().answer(from, bytes);
        if let Err(error) = shared.ports.receive(patience, &mut buffer, answer) {
            tracing::warn!(%error, "cannot receive NatNet commands");
            shared.ending.wait(Duration::from_secs(1));
        }
        if let Err(error) = shared.lock().tend() {
            tracing::warn!(%error, "cannot send a NatNet frame");
        }
    }
}

const LARGEST_DATAGRAM: usize = 65_535;
