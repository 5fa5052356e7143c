//! The datagrams of a capture sent again: the same bytes in the same order with the same gaps between them.
//!
//! ```
//! use posewire::capture::PcapWriter;
//! use posewire::replay::{Replay, ReplayOptions};
//! use posewire::stop::Stop;
//! use posewire::{Datagram, Wire};
//! use posewire_motion::Stamp;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("take.pcapng");
//! let mut writer = PcapWriter::create(&path, false)?;
//! writer.write(&Datagram {
//!     wire: Wire::MxtpUdp,
//!     from: "192.168.1.20:50123".parse()?,
//!     to: "192.168.1.30:9763".parse()?,
//!     received: Stamp(1_700_000_000_123_456_789),
//!     bytes: (*b"MXTP02").into(),
//! })?;
//! writer.finish()?;
//!
//! let replay = Replay::open(&path, &["mxtp://127.0.0.1:9763".parse()?], &ReplayOptions::default())?;
//! let replayed = replay.run(&Stop::new())?;
//! assert_eq!(replayed.datagrams, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod natnet;
mod targets;

use crate::capture::{CaptureOptions, CapturedSource, Playlist, Protocol, Selection, Survey};
use crate::endpoint::Endpoint;
use crate::faults::{FaultCounts, FaultPlan};
use crate::histogram::{DurationHistogram, Summary};
use crate::pacer::Pacer;
use crate::sink::TargetProgress;
use crate::stop::Stop;
use crate::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use targets::Targets;

/// What of a capture is replayed, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayOptions {
    /// How many times as fast as captured.
    pub speed: f64,
    /// Whether to begin again at the end. The same bytes come again, so that receivers see sample numbers start over.
    pub looped: bool,
    /// Begin so long after the first datagram of the capture.
    pub from: Duration,
    /// End so long after the first datagram of the capture.
    pub until: Option<Duration>,
    /// Only this source, by its number or a part of its name.
    pub only: Option<String>,
    /// Of a capture of packets: what the UDP datagrams are; told by their content if absent.
    pub protocol: Option<Protocol>,
    /// What is to go wrong with the datagrams.
    pub faults: Option<FaultPlan>,
}

impl Default for ReplayOptions {
    /// Everything, once, at the pace of the day.
    fn default() -> Self {
        Self {
            speed: 1.0,
            looped: false,
            from: Duration::ZERO,
            until: None,
            only: None,
            protocol: None,
            faults: None,
        }
    }
}

/// How far a replay has come.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Replayed {
    /// Datagrams that were sent, or given to the faults.
    pub datagrams: u64,
    /// Their payloads together.
    pub bytes: u64,
    /// Rounds that were begun.
    pub rounds: u64,
    /// Datagrams for which there is no target: MXTP without an MXTP target, NatNet without a NatNet target.
    pub without_target: u64,
    /// What NatNet clients had asked and what they were answered: the server that replays answers by itself.
    pub asked: u64,
    /// How long after it was due each datagram was on its way.
    pub lateness: Summary,
    /// How far into the capture it has come, all rounds together.
    pub position: Duration,
    /// Each target, in the order given.
    pub targets: Vec<TargetProgress>,
    /// How often what went wrong on purpose.
    pub faults: Option<FaultCounts>,
    /// What ended the capture before its end, if something did.
    pub damage: Option<String>,
}

impl Replayed {
    /// Datagrams that did not reach their target for a reason on this side.
    pub fn lost(&self) -> u64 {
        let lost = |target: &TargetProgress| target.congested + target.failed + target.dropped;
        self.targets.iter().map(lost).sum()
    }
}

/// A capture and where it is to be sent, open and not yet running.
pub struct Replay {
    path: PathBuf,
    speed: f64,
    survey: Survey,
    chosen: Option<u16>,
    playlist: Playlist,
    targets: Targets,
    lateness: DurationHistogram,
    replayed: Replayed,
    progress: Arc<Mutex<Replayed>>,
    next_summary: Instant,
}

impl Replay {
    /// Reads the capture once and opens the targets. A TCP target that connects is connected when this returns.
    ///
    /// # Errors
    /// Those of [`Survey::of`] and [`Survey::choose`]; [`Error::NothingForTarget`] and what else keeps a target from being opened;
    /// [`Error::Speed`].
    pub fn open(path: &Path, targets: &[Endpoint], options: &ReplayOptions) -> Result<Self> {
        Pacer::new(Instant::now(), options.speed, Stop::new())?;
        let reading = CaptureOptions {
            protocol: options.protocol,
        };
        let survey = Survey::of(path, &reading)?;
        let only = options.only.as_deref();
        let chosen = only.map(|only| survey.choose(path, Some(only))).transpose()?;
        let chosen = chosen.map(|source| source.number);
        let selection = Selection {
            source: chosen,
            from: options.from,
            until: options.until,
            looped: options.looped,
        };
        let targets = Targets::open(path, &reading, &survey, chosen, (targets, options.faults.as_ref()))?;
        let replay = Self {
            path: path.to_owned(),
            speed: options.speed,
            playlist: Playlist::open(path, &reading, selection)?,
            survey,
            chosen,
            lateness: DurationHistogram::new(),
            replayed: Replayed {
                targets: targets.progress(),
                ..Replayed::default()
            },
            targets,
            progress: Arc::default(),
            next_summary: Instant::now(),
        };
        replay.tell();
        Ok(replay)
    }

    /// What the capture holds.
    pub fn survey(&self) -> &Survey {
        &self.survey
    }

    /// The sources that are replayed.
    pub fn sources(&self) -> impl Iterator<Item = &CapturedSource> {
        let is_chosen =
            |source: &&CapturedSource| source.datagrams > 0 && self.chosen.is_none_or(|chosen| chosen == source.number);
        self.survey.sources.iter().filter(is_chosen)
    }

    /// Whether anybody is there to be sent to.
    pub fn is_ready(&self) -> bool {
        self.targets.is_ready()
    }

    /// Waits until [`is_ready`](Self::is_ready) or `stop` is set, so that a capture is not played to nobody.
    pub fn wait_until_ready(&self, stop: &Stop) {
        while !self.is_ready() && !stop.wait(Duration::from_millis(20)) {}
    }

    /// A handle to the numbers so far, for any thread. They are brought up to date ten times a second and at the end.
    pub fn progress(&self) -> Arc<Mutex<Replayed>> {
        Arc::clone(&self.progress)
    }

    /// Replays to the end, or until `stop` is set.
    ///
    /// # Errors
    /// [`Error::NothingInTime`] when nothing lies between the beginning and the end asked for, [`Error::Read`] when the file cannot be
    /// read on, [`Error::Socket`] when the very first datagram cannot be sent.
    pub fn run(mut self, stop: &Stop) -> Result<Replayed> {
        let mut pacer = Pacer::new(Instant::now(), self.speed, stop.clone())?;
        let played = self.play(&mut pacer);
        let played = played.and(self.targets.finish_faults());
        self.targets.finish();
        self.replayed.damage = self.playlist.damage().map(str::to_owned);
        self.summarise();
        played?;
        if self.replayed.datagrams + self.replayed.without_target + self.replayed.asked == 0 && !stop.is_stopped() {
            return Err(Error::NothingInTime {
                lasts: self.survey.lasts(),
                path: self.path,
            });
        }
        Ok(self.replayed)
    }

    fn play(&mut self, pacer: &mut Pacer) -> Result<()> {
        while let Some(due) = self.playlist.next()? {
            if !self.pass(due.offset, pacer)? {
                return Ok(());
            }
            self.replayed.rounds += u64::from(due.begins_round || self.replayed.rounds == 0);
            self.replayed.position = due.offset;
            let datagram = &due.captured.datagram;
            if !self.targets.takes(datagram, &mut self.replayed) {
                continue;
            }
            self.targets.send(due.offset, datagram)?;
            self.count(datagram.bytes.len(), pacer.deadline(due.offset));
        }
        // What faults hold back has its time too.
        while let Some(at) = self.targets.timeout() {
            if !self.pass(at, pacer)? {
                break;
            }
        }
        Ok(())
    }

    /// Waits until what is at `offset` is due, and sends what faults let go until then; `false` when asked to stop.
    fn pass(&mut self, offset: Duration, pacer: &mut Pacer) -> Result<bool> {
        while let Some(at) = self.targets.timeout().filter(|at| *at <= offset) {
            if !pacer.wait(at) {
                return Ok(false);
            }
            self.targets.handle_timeout(at)?;
        }
        let is_near = |at: Instant| at.saturating_duration_since(Instant::now()) < SHORTEST_WAIT;
        if pacer.deadline(offset).is_some_and(is_near) {
            return Ok(!pacer.is_stopped());
        }
        Ok(pacer.wait(offset))
    }

    fn count(&mut self, bytes: usize, due: Option<Instant>) {
        self.replayed.datagrams += 1;
        self.replayed.bytes += bytes as u64;
        let now = Instant::now();
        if let Some(due) = due {
            self.lateness.record(now.saturating_duration_since(due));
        }
        if now >= self.next_summary {
            self.next_summary = now + SUMMARISE_EVERY;
            self.summarise();
        }
    }

    fn summarise(&mut self) {
        self.replayed.lateness = self.lateness.summary();
        self.replayed.targets = self.targets.progress();
        self.replayed.faults = self.targets.fault_counts();
        self.tell();
    }

    fn tell(&self) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.clone_from(&self.replayed);
    }
}

impl std::fmt::Debug for Replay {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Replay")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

/// Systems sleep no shorter than this: what is due sooner is nearer to its time when it is sent at once.
const SHORTEST_WAIT: Duration = Duration::from_micros(50);
const SUMMARISE_EVERY: Duration = Duration::from_millis(100);
