//! MXTP to the network, as MVN's Network Streamer sends it.

mod fitting;
mod target;
mod tcp;

use super::OnlySource;
use super::{Progress, Sink, TargetProgress};
use crate::endpoint::Endpoint;
use crate::faults::{FaultPlan, LiveFaults};
use crate::histogram::DurationHistogram;
use crate::stop::Stop;
use crate::{Error, Item, Result, SourceId};
use fitting::Fitting;
use posewire_motion::{Frame, Subject};
use posewire_mxtp::Revision;
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions, MessageTypes};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
pub(crate) use target::Target;

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
    /// Whether subjects are fitted to MVN's skeleton, as those of another system must be: skeletons are recognised by
    /// the names of their segments, as MVN or Motive has them, and what is no person is left out. So are the types of
    /// [`MxtpSink::NOT_FITTED`].
    pub fit: bool,
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
            fit: false,
            faults: None,
        }
    }
}

/// Sends every frame to every target as MVN's Network Streamer does.
///
/// Meta data and scale (types 12 and 13) go out before a subject's first frame and once a second. UDP targets are sent
/// to at once and never waited for. Each TCP peer has a queue and a thread of its own: one that stalls loses its oldest
/// whole samples, which are counted, and delays no other target.
pub struct MxtpSink {
    options: MxtpSinkOptions,
    only: OnlySource,
    targets: Vec<Target>,
    characters: BTreeMap<u32, Character>,
    fitting: Option<Fitting>,
    datagrams: Datagrams,
    faults: Option<LiveFaults>,
    progress: Arc<Mutex<Progress>>,
    lateness: DurationHistogram,
    next_summary: Instant,
}

/// A subject that is streamed.
struct Character {
    encoder: Encoder,
    subject: Arc<Subject>,
    next_description: Option<Instant>,
}

impl MxtpSink {
    /// The types that fitted subjects never have: nobody else tells velocities, trackers and the centre of mass.
    pub const NOT_FITTED: MessageTypes = Fitting::NEVER;

    /// Opens every target. A TCP target that connects is connected when this returns.
    ///
    /// # Errors
    /// What keeps a target from being opened: an address that is not found, a port in use, a peer that refuses.
    /// [`Error::NotATarget`] for an endpoint that is not MXTP.
    pub fn open(targets: &[Endpoint], mut options: MxtpSinkOptions) -> Result<Self> {
        let targets = targets.iter().map(Target::open).collect::<Result<Vec<_>>>()?;
        let sink = Self {
            fitting: options.fit.then(|| Fitting::new(&mut options.types)),
            faults: options.faults.clone().map(LiveFaults::new),
            options,
            only: OnlySource::default(),
            targets,
            characters: BTreeMap::new(),
            datagrams: Datagrams::default(),
            progress: Arc::default(),
            lateness: DurationHistogram::new(),
            next_summary: Instant::now(),
        };
        sink.lock_progress().targets = sink.targets.iter().map(Target::progress).collect();
        sink.tell_left_out();
        Ok(sink)
    }

    /// The types that are sent.
    pub fn types(&self) -> MessageTypes {
        self.options.types
    }

    /// Whether anybody is there to be sent to: not before the first peer has come when all targets listen.
    pub fn is_ready(&self) -> bool {
        self.targets.iter().any(Target::is_ready)
    }

    /// Waits until [`is_ready`](Self::is_ready) or `stop` is set, so that a take is not played to nobody.
    pub fn wait_until_ready(&self, stop: &Stop) {
        while !self.is_ready() && !stop.wait(Duration::from_millis(20)) {}
    }

    /// A handle to the numbers so far, for any thread. They are brought up to date ten times a second and at the end.
    pub fn progress(&self) -> Arc<Mutex<Progress>> {
        Arc::clone(&self.progress)
    }

    fn describe(&mut self, subject: &Arc<Subject>) -> Result<()> {
        let number = u32::from(self.options.character).saturating_add(subject.id);
        let Ok(character) = u8::try_from(number) else {
            return Err(Error::Character { found: number });
        };
        let subject = match &self.options.name {
            Some(name) => Arc::new(Subject {
                name: name.clone(),
                ..(**subject).clone()
            }),
            None => Arc::clone(subject),
        };
        let encoder = Encoder::new(EncoderOptions {
            types: self.options.types,
            revision: self.options.revision,
            split: self.options.split,
            character,
            ..EncoderOptions::default()
        });
        self.characters.insert(
            subject.id,
            Character {
                encoder,
                subject,
                next_description: None,
            },
        );
        self.count_characters();
        Ok(())
    }

    /// Every character's meta data says how many there are.
    fn count_characters(&mut self) {
        let characters = self.characters.len() as u32;
        for character in self.characters.values_mut() {
            let options = EncoderOptions {
                characters,
                ..character.encoder.options().clone()
            };
            character.encoder = Encoder::new(options);
        }
    }

    /// Describes the character that a subject is, if it is one.
    fn describe_fitted(&mut self, subject: &Arc<Subject>) -> Result<()> {
        let Some(fitting) = &mut self.fitting else {
            return self.describe(subject);
        };
        let character = fitting.character(subject);
        self.tell_left_out();
        character.map_or(Ok(()), |character| self.describe(&character))
    }

    fn send_fitted(&mut self, frame: &Frame, due: Option<Instant>) -> Result<()> {
        let Some(fitting) = &mut self.fitting else {
            return self.send_frame(frame, due);
        };
        if let Some(frame) = fitting.frame(frame) {
            return self.send_frame(&frame, due);
        }
        self.tell_left_out();
        Ok(())
    }

    fn tell_left_out(&self) {
        let left_out = self.fitting.as_ref().map(Fitting::left_out).unwrap_or_default();
        let mut progress = self.lock_progress();
        if progress.left_out.len() < left_out.len() {
            progress.left_out = left_out.to_vec();
        }
    }

    fn send_frame(&mut self, frame: &Frame, due: Option<Instant>) -> Result<()> {
        if !self.characters.contains_key(&frame.subject.id) {
            self.describe(&frame.subject)?;
        }
        let Some(character) = self.characters.get_mut(&frame.subject.id) else {
            return Ok(());
        };
        // By what was due rather than by the clock, so that a take is the same datagrams whenever it is played.
        let now = due.unwrap_or_else(Instant::now);
        if character.next_description.is_none_or(|next| next <= now) {
            character.next_description = Some(now + DESCRIBE_EVERY);
            self.datagrams.clear();
            character
                .encoder
                .encode_subject(&character.subject, &mut self.datagrams);
            send(&mut self.targets, &mut self.datagrams, &mut self.faults, now)?;
        }
        self.datagrams.clear();
        character.encoder.encode_frame(frame, &mut self.datagrams);
        send(&mut self.targets, &mut self.datagrams, &mut self.faults, now)?;
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
        let datagrams = &self.datagrams;
        self.targets.iter_mut().try_for_each(|target| target.send(datagrams))
    }

    fn count(&mut self, now: Instant) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.frames += 1;
        if now >= self.next_summary {
            self.next_summary = now + SUMMARISE_EVERY;
            progress.lateness = self.lateness.summary();
            progress.targets = self.targets.iter().map(Target::progress).collect();
            progress.faults = self.faults.as_ref().map(|faults| faults.counts().clone());
        }
    }

    fn lock_progress(&self) -> std::sync::MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Sends datagrams that were due, or what faults make of them.
fn send(
    targets: &mut [Target],
    datagrams: &mut Datagrams,
    faults: &mut Option<LiveFaults>,
    due: Instant,
) -> Result<()> {
    if let Some(faults) = faults {
        datagrams.iter().for_each(|datagram| faults.handle(due, datagram));
        leave(faults, datagrams);
    }
    if datagrams.is_empty() {
        return Ok(());
    }
    targets.iter_mut().try_for_each(|target| target.send(datagrams))
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
        self.only.check(source)?;
        match item {
            Item::Subject(subject) => self.describe_fitted(subject),
            Item::Frame { frame, due } => self.send_fitted(frame, *due),
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
        // Those who are served to the end, and not nobody, which is who is left after it.
        let peers: Vec<_> = self.targets.iter().map(|target| target.progress().peers).collect();
        self.targets.iter_mut().for_each(Target::finish);
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.lateness = self.lateness.summary();
        let targets = self.targets.iter().map(Target::progress).zip(peers);
        progress.targets = targets
            .map(|(target, peers)| TargetProgress { peers, ..target })
            .collect();
        progress.faults = self.faults.as_ref().map(|faults| faults.counts().clone());
        sent
    }
}

const DESCRIBE_EVERY: Duration = Duration::from_secs(1);
const SUMMARISE_EVERY: Duration = Duration::from_millis(100);
