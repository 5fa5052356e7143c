//! Records takes that are begun and ended while the streams run.

mod since;

use super::record::{RecordOptions, RecordProgress, RecordSink};
use crate::endpoint::Endpoint;
use crate::queue::Policy;
use crate::recording::{Briefing, TakeName};
use crate::stats::Statistics;
use crate::stop::Stop;
use crate::{Error, Item, Result, Sink, SourceId, Wants};
use since::since;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Writes takes of one session into files of a folder, each begun and ended by [`Takes`]; what comes between them is not kept.
///
/// The sources run on between takes, so that a take misses nothing of its beginning and says from the start who is in it. Each is a
/// recording as [`RecordSink`] writes it.
///
/// ```
/// use posewire::sink::TakesSink;
/// use posewire::source::PlaybackOptions;
/// use posewire::stop::Stop;
/// use posewire::{Session, Source};
///
/// let folder = tempfile::tempdir()?;
/// let source = Source::open(&"synthetic:walk".parse()?, &PlaybackOptions::default())?;
/// let sink = TakesSink::new(folder.path(), &[source.endpoint().clone()], None);
/// let (takes, stop) = (sink.takes(), Stop::new());
/// let session = Session::start([source], vec![Box::new(sink)], stop.clone());
///
/// let file = takes.begin(&"walk".parse()?)?;
/// assert!(file.ends_with("walk.mcap"));
/// let take = takes.end()?.expect("it was begun");
/// assert_eq!(take.recorded.file, file);
/// stop.stop();
/// session.wait()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct TakesSink {
    takes: Takes,
}

/// Begins and ends the takes of a [`TakesSink`], from any thread. Clones are the same takes.
#[derive(Clone, Debug)]
pub struct Takes {
    /// Held while something is written, which may take as long as the disk likes.
    state: Arc<Mutex<State>>,
    /// Never held for long.
    told: Arc<Mutex<Told>>,
}

/// How far a take has come, or how it went.
#[derive(Clone, Debug)]
pub struct TakeProgress {
    /// What was recorded.
    pub recorded: RecordProgress,
    /// How long it has lasted.
    pub lasted: Duration,
}

/// How far the takes of a session have come.
#[derive(Clone, Debug, Default)]
pub struct TakesProgress {
    /// The take that is recorded now.
    pub recording: Option<TakeProgress>,
    /// The one that was recorded when the session ended, which ended it.
    pub cut_short: Option<TakeProgress>,
    /// How many were begun.
    pub takes: u32,
    /// The sources and how many datagrams came from each, in takes and between them, when it last told.
    pub sources: Vec<(Endpoint, u64)>,
    /// Datagrams and samples of takes that were lost on this machine, of all that were ended and the present one.
    pub lost: u64,
}

#[derive(Debug)]
struct State {
    folder: PathBuf,
    sources: Vec<Endpoint>,
    options: RecordOptions,
    briefing: Briefing,
    statistics: BTreeMap<SourceId, Arc<Statistics>>,
    /// What the queue has dropped.
    dropped: u64,
    take: Option<Take>,
    /// The sources whose statistics of the last moments of a take are still to come.
    owed: BTreeSet<SourceId>,
    ended: bool,
}

/// What others may know at any time, also while the disk is stuck.
#[derive(Debug, Default)]
struct Told {
    running: Option<Running>,
    cut_short: Option<TakeProgress>,
    takes: u32,
    /// The sources and how many datagrams came from each.
    sources: Vec<(Endpoint, u64)>,
    /// Of takes that were ended.
    lost: u64,
}

/// A take that is recorded, as others see it.
#[derive(Clone, Debug)]
struct Running {
    recorded: Arc<Mutex<RecordProgress>>,
    begun: Instant,
}

#[derive(Debug)]
struct Take {
    sink: RecordSink,
    running: Running,
    /// How the sources were doing when it began.
    statistics: BTreeMap<SourceId, Arc<Statistics>>,
    dropped: u64,
}

impl TakesSink {
    /// Takes into this folder. `sources` are the endpoints of the session's sources, in its order. A take goes on in another file
    /// when one has about `split` bytes, if that is given. No take replaces a file.
    pub fn new(folder: &Path, sources: &[Endpoint], split: Option<u64>) -> Self {
        let state = State {
            folder: folder.to_owned(),
            sources: sources.to_vec(),
            options: RecordOptions {
                split,
                overwrite: false,
            },
            briefing: Briefing::default(),
            statistics: BTreeMap::new(),
            dropped: 0,
            take: None,
            owed: BTreeSet::new(),
            ended: false,
        };
        let told = Told {
            sources: sources.iter().map(|endpoint| (endpoint.clone(), 0)).collect(),
            ..Told::default()
        };
        let (state, told) = (Arc::new(Mutex::new(state)), Arc::new(Mutex::new(told)));
        Self {
            takes: Takes { state, told },
        }
    }

    /// The means to begin and end takes.
    pub fn takes(&self) -> Takes {
        self.takes.clone()
    }
}

impl Takes {
    /// Begins a take, and gives its file: `walk.mcap`, or `walk_2.mcap` where that is there. One that could not be written any
    /// more does not stand in its way.
    ///
    /// # Errors
    /// [`Error::TakeRuns`] while another is recorded, [`Error::Stopped`] when the session is over, [`Error::Write`] when the
    /// file cannot be written.
    pub fn begin(&self, name: &TakeName) -> Result<PathBuf> {
        let has_failed = |running: &Running| lock(&running.recorded).failure.is_some();
        if lock(&self.told).running.as_ref().is_some_and(has_failed) {
            self.close();
        }
        let mut state = self.lock();
        let (file, running) = state.begin(name)?;
        let mut told = lock(&self.told);
        told.takes += 1;
        told.running = Some(running);
        Ok(file)
    }

    /// Ends the take, and gives how it went; `None` when there is none. Its file is complete when this returns.
    ///
    /// # Errors
    /// Why not everything could be written.
    pub fn end(&self) -> Result<Option<TakeProgress>> {
        let ended = self.close();
        match ended.as_ref().and_then(|take| take.recorded.failure.clone()) {
            Some(error) => Err(error),
            None => Ok(ended),
        }
    }

    /// How far they have come.
    pub fn progress(&self) -> TakesProgress {
        let told = lock(&self.told);
        let recording = told.running.as_ref().map(Running::progress);
        TakesProgress {
            cut_short: told.cut_short.clone(),
            takes: told.takes,
            sources: told.sources.clone(),
            lost: told.lost + recording.as_ref().map_or(0, |take| take.recorded.lost()),
            recording,
        }
    }

    /// Ends the take, and gives how it went, also when not everything could be written.
    fn close(&self) -> Option<TakeProgress> {
        let mut take = self.lock().end()?;
        let lasted = take.running.begun.elapsed();
        // The streams do not wait while the file is seen onto the disk. Why it cannot be, its progress says.
        let _ = take.sink.finish();
        let ended = TakeProgress {
            lasted,
            ..take.running.progress()
        };
        let mut told = lock(&self.told);
        // Another may have begun meanwhile.
        told.running.take_if(|running| running.is(&take.running));
        let is_incomplete = ended.recorded.failure.is_some() || ended.recorded.moved;
        told.lost += ended.recorded.lost().max(is_incomplete.into());
        Some(ended)
    }

    fn accept(&self, source: SourceId, item: &Item) -> Result<()> {
        let mut state = self.lock();
        if let Item::Statistics(statistics) = item {
            let mut told = lock(&self.told);
            if let Some((_, datagrams)) = told.sources.get_mut(usize::from(source.0)) {
                *datagrams = statistics.datagrams;
            }
            told.lost += state.lost_between(source, statistics);
        }
        state.accept(source, item)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl State {
    fn begin(&mut self, name: &TakeName) -> Result<(PathBuf, Running)> {
        if self.ended {
            let what = "no more is recorded".to_owned();
            return Err(Error::Stopped { what });
        }
        if let Some(take) = &self.take {
            let file = take.running.progress().recorded.file;
            return Err(Error::TakeRuns { file });
        }
        let (mut sink, file) = self.create(name)?;
        sink.brief(&self.briefing)?;
        let running = Running {
            recorded: sink.progress(),
            begun: Instant::now(),
        };
        self.take = Some(Take {
            sink,
            running: running.clone(),
            statistics: self.statistics.clone(),
            dropped: self.dropped,
        });
        Ok((file, running))
    }

    fn end(&mut self) -> Option<Take> {
        let ended = self.take.take()?;
        let sources = (0..=u16::MAX).map(SourceId);
        self.owed = sources.zip(&self.sources).map(|(id, _)| id).collect();
        Some(ended)
    }

    /// Creates the first file of the name that is free.
    fn create(&self, name: &TakeName) -> Result<(RecordSink, PathBuf)> {
        let mut number = 1_u32;
        loop {
            let suffix = if number == 1 {
                String::new()
            } else {
                format!("_{number}")
            };
            let file = self.folder.join(format!("{name}{suffix}.mcap"));
            // A take that cannot be written any more ends, and not the session.
            match RecordSink::create(&file, &self.sources, self.options.clone(), Stop::new()) {
                Err(Error::Exists { .. }) if number < MOST_OF_A_NAME => number += 1,
                created => return created.map(|sink| (sink, file)),
            }
        }
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        self.briefing.note(source, item);
        if let Item::Statistics(statistics) = item {
            self.statistics.insert(source, Arc::clone(statistics));
        }
        let Some(take) = &mut self.take else { return Ok(()) };
        let Item::Statistics(statistics) = item else {
            return take.sink.accept(source, item);
        };
        let begun = take.statistics.get(&source);
        let since = since(statistics, begun.map(|begun| &**begun));
        take.sink.accept(source, &Item::Statistics(Arc::new(since)))
    }

    /// What these statistics say the kernel lost of the last moments of a take that has ended.
    fn lost_between(&mut self, source: SourceId, statistics: &Statistics) -> u64 {
        if !self.owed.remove(&source) || self.take.is_some() {
            return 0;
        }
        let before = self.statistics.get(&source).map_or(0, |before| before.kernel_dropped);
        statistics.kernel_dropped.saturating_sub(before)
    }
}

impl Running {
    fn progress(&self) -> TakeProgress {
        TakeProgress {
            recorded: lock(&self.recorded).clone(),
            lasted: self.begun.elapsed(),
        }
    }

    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.recorded, &other.recorded)
    }
}

impl Sink for TakesSink {
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, RecordSink::QUEUED)
    }

    fn wants(&self) -> Wants {
        Wants::ALL
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        self.takes.accept(source, item)
    }

    fn dropped(&mut self, dropped: u64) {
        let mut state = self.takes.lock();
        state.dropped = dropped;
        if let Some(take) = &mut state.take {
            take.sink.dropped(dropped - take.dropped);
        }
    }

    fn timeout(&self) -> Option<Instant> {
        self.takes.lock().take.as_ref()?.sink.timeout()
    }

    fn handle_timeout(&mut self) -> Result<()> {
        let mut state = self.takes.lock();
        let take = state.take.as_mut();
        take.map_or(Ok(()), |take| take.sink.handle_timeout())
    }

    fn finish(&mut self) -> Result<()> {
        self.takes.lock().ended = true;
        // What became of it is told with it.
        let cut_short = self.takes.close();
        lock(&self.takes.told).cut_short = cut_short;
        Ok(())
    }
}

/// Takes of one name; a folder that has more is not meant.
const MOST_OF_A_NAME: u32 = 9999;
