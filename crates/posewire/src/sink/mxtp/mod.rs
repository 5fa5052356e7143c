//! MXTP to the network, as MVN's Network Streamer sends it.

mod characters;
mod fitting;
mod target;
mod targets;
mod tcp;

use super::{LeftOut, Progress, Sink};
use crate::endpoint::Endpoint;
use crate::faults::{FaultPlan, LiveFaults};
use crate::histogram::DurationHistogram;
use crate::stop::Stop;
use crate::{Item, Result, SourceId};
use characters::Characters;
use fitting::Fitting;
use posewire_motion::{Frame, Subject};
use posewire_mxtp::Revision;
use posewire_mxtp::motion::{Datagrams, MessageTypes};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
pub(crate) use target::Target;
pub use targets::MxtpTargets;

/// What is sent, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct MxtpSinkOptions {
    /// The datagram types. A frame that lacks what a type needs is sent without it.
    pub types: MessageTypes,
    /// Which revision's header is written.
    pub revision: Revision,
    /// The longest datagram in bytes; pose data beyond it is split. Not split if absent, as MVN does.
    pub split: Option<usize>,
    /// The character number of the first subject.
    pub character: u8,
    /// A name instead of the subject's own.
    pub name: Option<String>,
    /// Whose subjects are fitted to MVN's skeleton.
    pub fit: Fit,
    /// What is to go wrong with the datagrams, the same for every target.
    pub faults: Option<FaultPlan>,
}

impl Default for MxtpSinkOptions {
    /// Types 02, 12, 13, 20, 24 and 25 by Rev N, from character 0 on.
    fn default() -> Self {
        Self {
            types: MessageTypes::DEFAULT,
            revision: Revision::N,
            split: None,
            character: 0,
            name: None,
            fit: Fit::Nobody,
            faults: None,
        }
    }
}

/// Whose subjects are fitted to MVN's skeleton, as those of another system must be: skeletons are recognised by the names of their
/// segments, as MVN or Motive has them, and what is no person is left out. So are the types of [`MxtpSink::NOT_FITTED`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fit {
    /// All subjects are MVN's already.
    #[default]
    Nobody,
    /// The subjects of all sources.
    All,
    /// The subjects of these sources.
    Of(BTreeSet<SourceId>),
}

impl Fit {
    fn includes(&self, source: SourceId) -> bool {
        match self {
            Self::Nobody => false,
            Self::All => true,
            Self::Of(sources) => sources.contains(&source),
        }
    }
}

/// Sends every frame to every target as MVN's Network Streamer does.
///
/// Meta data and scale (types 12 and 13) go out before a subject's first frame and once a second. UDP targets are sent
/// to at once and never waited for. Each TCP peer has a queue and a thread of its own: one that stalls loses its oldest
/// whole samples, which are counted, and delays no other target.
///
/// A subject is the character of its number at its source. Where another source has that one already, it is the first that is free.
pub struct MxtpSink {
    options: MxtpSinkOptions,
    targets: MxtpTargets,
    characters: Characters,
    /// Of each source that is fitted.
    fittings: BTreeMap<SourceId, Fitting>,
    /// What was left out from the beginning.
    never: Vec<LeftOut>,
    datagrams: Datagrams,
    faults: Option<LiveFaults>,
    progress: Arc<Mutex<Progress>>,
    lateness: DurationHistogram,
    next_summary: Instant,
}

impl MxtpSink {
    /// The types that fitted subjects never have: nobody else tells velocities, trackers and the centre of mass.
    pub const NOT_FITTED: MessageTypes = Fitting::NEVER;

    /// Opens every target. A TCP target that connects is connected when this returns.
    ///
    /// # Errors
    /// What keeps a target from being opened: an address that is not found, a port in use, a peer that refuses.
    /// [`Error::NotATarget`](crate::Error::NotATarget) for an endpoint that is not MXTP.
    pub fn open(targets: &[Endpoint], mut options: MxtpSinkOptions) -> Result<Self> {
        let targets = MxtpTargets::open(targets)?;
        let sink = Self {
            never: match options.fit {
                Fit::All => Fitting::leave_out_types(&mut options.types),
                _ => Vec::new(),
            },
            characters: Characters::new(options.clone()),
            fittings: BTreeMap::new(),
            faults: options.faults.clone().map(LiveFaults::new),
            options,
            targets,
            datagrams: Datagrams::default(),
            progress: Arc::default(),
            lateness: DurationHistogram::new(),
            next_summary: Instant::now(),
        };
        sink.lock_progress().targets = sink.targets.progress();
        sink.tell_left_out();
        Ok(sink)
    }

    /// The types that are sent.
    pub fn types(&self) -> MessageTypes {
        self.options.types
    }

    /// Whether anybody is there to be sent to: not before the first peer has come when all targets listen.
    pub fn is_ready(&self) -> bool {
        self.targets.are_ready()
    }

    /// Waits until [`is_ready`](Self::is_ready) or `stop` is set, so that a take is not played to nobody.
    pub fn wait_until_ready(&self, stop: &Stop) {
        while !self.is_ready() && !stop.wait(Duration::from_millis(20)) {}
    }

    /// A handle to the targets, to add and remove them while it runs.
    pub fn targets(&self) -> MxtpTargets {
        self.targets.clone()
    }

    /// A handle to the numbers so far, for any thread. They are brought up to date ten times a second and at the end.
    pub fn progress(&self) -> Arc<Mutex<Progress>> {
        Arc::clone(&self.progress)
    }

    /// Describes the character that a subject is, if it is one.
    fn describe(&mut self, source: SourceId, subject: &Arc<Subject>) -> Result<()> {
        let Some(fitting) = self.fitting(source) else {
            return self.characters.describe(source, subject);
        };
        let character = fitting.character(subject);
        self.tell_left_out();
        character.map_or(Ok(()), |character| self.characters.describe(source, &character))
    }

    fn send_fitted(&mut self, source: SourceId, frame: &Frame, due: Option<Instant>) -> Result<()> {
        let Some(fitting) = self.fitting(source) else {
            return self.send_frame(source, frame, due);
        };
        if let Some(frame) = fitting.frame(frame) {
            return self.send_frame(source, &frame, due);
        }
        self.tell_left_out();
        Ok(())
    }

    fn fitting(&mut self, source: SourceId) -> Option<&mut Fitting> {
        let is_fitted = self.options.fit.includes(source);
        is_fitted.then(|| self.fittings.entry(source).or_default())
    }

    fn tell_left_out(&self) {
        let fitted = self.fittings.values().flat_map(Fitting::left_out);
        let left_out: Vec<_> = self.never.iter().chain(fitted).collect();
        let mut progress = self.lock_progress();
        if progress.left_out.len() < left_out.len() {
            progress.left_out = left_out.into_iter().cloned().collect();
        }
    }

    fn send_frame(&mut self, source: SourceId, frame: &Frame, due: Option<Instant>) -> Result<()> {
        // By what was due rather than by the clock, so that a take is the same datagrams whenever it is played.
        let now = due.unwrap_or_else(Instant::now);
        let character = self.characters.of(source, &frame.subject)?;
        if character.next_description.is_none_or(|next| next <= now) {
            character.next_description = Some(now + DESCRIBE_EVERY);
            self.datagrams.clear();
            character
                .encoder
                .encode_subject(&character.subject, &mut self.datagrams);
            send(&self.targets, &mut self.datagrams, &mut self.faults, now)?;
        }
        self.datagrams.clear();
        character.encoder.encode_frame(frame, &mut self.datagrams);
        send(&self.targets, &mut self.datagrams, &mut self.faults, now)?;
        let sent = Instant::now();
        if let Some(due) = due {
            self.lateness.record(sent.saturating_duration_since(due));
        }
        self.count(sent);
        Ok(())
    }

    /// Sends what faults have let go.
    fn send_faulty(&mut self) -> Result<()> {
        let Some(faults) = &mut self.faults else {
            return Ok(());
        };
        leave(faults, &mut self.datagrams);
        if self.datagrams.is_empty() {
            return Ok(());
        }
        self.targets.send(&self.datagrams)
    }

    fn count(&mut self, now: Instant) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.frames += 1;
        if now >= self.next_summary {
            self.next_summary = now + SUMMARISE_EVERY;
            progress.lateness = self.lateness.summary();
            progress.targets = self.targets.progress();
            progress.faults = self.faults.as_ref().map(|faults| faults.counts().clone());
        }
    }

    fn lock_progress(&self) -> std::sync::MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Sends datagrams that were due, or what faults make of them.
fn send(targets: &MxtpTargets, datagrams: &mut Datagrams, faults: &mut Option<LiveFaults>, due: Instant) -> Result<()> {
    if let Some(faults) = faults {
        datagrams.iter().for_each(|datagram| faults.handle(due, datagram));
        leave(faults, datagrams);
    }
    if datagrams.is_empty() {
        return Ok(());
    }
    targets.send(datagrams)
}

/// Puts what leaves now into `datagrams`.
fn leave(faults: &mut LiveFaults, datagrams: &mut Datagrams) {
    datagrams.clear();
    while let Some(datagram) = faults.poll() {
        datagrams.push(&datagram);
    }
}

impl Sink for MxtpSink {
    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        match item {
            Item::Subject(subject) => self.describe(source, subject),
            Item::Frame { frame, due } => self.send_fitted(source, frame, *due),
            _ => Ok(()),
        }
    }

    fn timeout(&self) -> Option<Instant> {
        self.faults.as_ref()?.timeout()
    }

    fn handle_timeout(&mut self) -> Result<()> {
        if let Some(faults) = &mut self.faults {
            faults.handle_timeout(Instant::now());
        }
        self.send_faulty()
    }

    fn finish(&mut self) -> Result<()> {
        if let Some(faults) = &mut self.faults {
            faults.finish();
        }
        let sent = self.send_faulty();
        let targets = self.targets.finish();
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.lateness = self.lateness.summary();
        progress.targets = targets;
        progress.faults = self.faults.as_ref().map(|faults| faults.counts().clone());
        sent
    }
}

const DESCRIBE_EVERY: Duration = Duration::from_secs(1);
const SUMMARISE_EVERY: Duration = Duration::from_millis(100);
