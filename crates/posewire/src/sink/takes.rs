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
use std::collections::BTreeMap;
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
    state: Arc<Mutex<State>>,
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
    cut_short: Option<TakeProgress>,
    takes: u32,
    /// Of takes that were ended.
    lost: u64,
    /// Whether a take has ended of whose last moments the statistics are still to come.
    owed: bool,
    ended: bool,
}

#[derive(Debug)]
struct Take {
    sink: RecordSink,
    begun: Instant,
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
            cut_short: None,
            takes: 0,
            lost: 0,
            owed: false,
            ended: false,
        };
        let state = Arc::new(Mutex::new(state));
        Self { takes: Takes { state } }
    }

    /// The means to begin and end takes.
    pub fn takes(&self) -> Takes {
        self.takes.clone()
    }
}

impl Takes {
    /// Begins a take, and gives its file: `walk.mcap`, or `walk_2.mcap` where that is there.
    ///
    /// # Errors
    /// [`Error::TakeRuns`] while another is recorded, [`Error::Stopped`] when the session is over, [`Error::Write`] when the
    /// file cannot be written.
    pub fn begin(&self, name: &TakeName) -> Result<PathBuf> {
        self.lock().begin(name)
    }

    /// Ends the take, and gives how it went; `None` when there is none. Its file is complete when this returns.
    ///
    /// # Errors
    /// Why not everything could be written.
    pub fn end(&self) -> Result<Option<TakeProgress>> {
        let take = self.lock().take.take();
        let Some(mut take) = take else { return Ok(None) };
        let lasted = take.begun.elapsed();
        // The streams do not wait while the file is seen onto the disk.
        let finished = take.sink.finish();
        let progress = TakeProgress {
            lasted,
            ..take.progress()
        };
        let mut state = self.lock();
        state.lost += progress.recorded.lost();
        state.owed = true;
        finished.map(|()| Some(progress))
    }

    /// How far they have come.
    pub fn progress(&self) -> TakesProgress {
        let state = self.lock();
        let recording = state.take.as_ref().map(Take::progress);
        let sources = (0..=u16::MAX).map(SourceId).zip(&state.sources);
        let heard = |(id, endpoint): (SourceId, &Endpoint)| {
            let statistics = state.statistics.get(&id);
            let datagrams = statistics.map_or(0, |statistics| statistics.datagrams);
            (endpoint.clone(), datagrams)
        };
        TakesProgress {
            cut_short: state.cut_short.clone(),
            takes: state.takes,
            sources: sources.map(heard).collect(),
            lost: state.lost + recording.as_ref().map_or(0, |take| take.recorded.lost()),
            recording,
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn begin(&mut self, name: &TakeName) -> Result<PathBuf> {
        if self.ended {
            let what = "no more is recorded".to_owned();
            return Err(Error::Stopped { what });
        }
        if let Some(take) = &self.take {
            let file = take.progress().recorded.file;
            return Err(Error::TakeRuns { file });
        }
        let (mut sink, file) = self.create(name)?;
        sink.brief(&self.briefing)?;
        self.takes += 1;
        self.take = Some(Take {
            sink,
            begun: Instant::now(),
            statistics: self.statistics.clone(),
            dropped: self.dropped,
        });
        Ok(file)
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
        let Item::Statistics(statistics) = item else {
            let take = self.take.as_mut();
            return take.map_or(Ok(()), |take| take.sink.accept(source, item));
        };
        let before = self.statistics.insert(source, Arc::clone(statistics));
        if let Some(take) = &mut self.take {
            let begun = take.statistics.get(&source);
            let since = since(statistics, begun.map(|begun| &**begun));
            return take.sink.accept(source, &Item::Statistics(Arc::new(since)));
        }
        if std::mem::take(&mut self.owed) {
            let before = before.map_or(0, |before| before.kernel_dropped);
            self.lost += statistics.kernel_dropped.saturating_sub(before);
        }
        Ok(())
    }
}

impl Take {
    fn progress(&self) -> TakeProgress {
        let progress = self.sink.progress();
        TakeProgress {
            recorded: progress.lock().unwrap_or_else(PoisonError::into_inner).clone(),
            lasted: self.begun.elapsed(),
        }
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
        self.takes.lock().accept(source, item)
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
        let cut_short = self.takes.end()?;
        self.takes.lock().cut_short = cut_short;
        Ok(())
    }
}

/// Takes of one name; a folder that has more is not meant.
const MOST_OF_A_NAME: u32 = 9999;
