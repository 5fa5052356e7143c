//! Records a session.

mod syncing;
#[cfg(test)]
mod tests;

use crate::beside::is_same_file;
use crate::capture::{Capture, CaptureOptions};
use crate::doctor::Senders;
use crate::endpoint::Endpoint;
use crate::queue::Policy;
use crate::recording::{Briefing, Whereabouts, Writer, WriterOptions, read_locked};
use crate::stats::Statistics;
use crate::stop::Stop;
use crate::{Error, Item, Result, Sink, SourceId, Wants};
use posewire_motion::{Frame, Stamp};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use syncing::Syncing;

/// How a session is recorded.
pub type RecordOptions = WriterOptions;

/// Writes every datagram as it came and the poses that were read from them into an MCAP file, see [`recording`](crate::recording).
///
/// What has come is in the file at most [`FLUSH_EVERY`](Self::FLUSH_EVERY) later, where it survives the end of this program, and on
/// the disk a second later. When nothing more can be written, as on a full disk, what was written stays readable, the session
/// is stopped, and everything from there on is counted in [`RecordProgress::unwritten`]; [`finish`](Sink::finish) gives the error.
/// So it does when somebody removes the file, which is noticed within a second.
///
/// ```
/// use posewire::sink::{RecordOptions, RecordSink};
/// use posewire::source::PlaybackOptions;
/// use posewire::stop::Stop;
/// use posewire::{Session, Source};
/// use std::time::Duration;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("take.mcap");
/// let options = PlaybackOptions { duration: Some(Duration::from_millis(50)), ..PlaybackOptions::default() };
/// let source = Source::open(&"synthetic:walk".parse()?, &options)?;
/// let stop = Stop::new();
/// let sink = RecordSink::create(&path, &[source.endpoint().clone()], RecordOptions::default(), stop.clone())?;
/// Session::start([source], vec![Box::new(sink)], stop).wait()?;
/// # assert!(posewire::recording::Survey::of(&path)?.complete);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RecordSink {
    writer: Option<Writer>,
    failure: Option<Error>,
    stop: Stop,
    /// When the oldest of what is not in the file is to be there.
    due: Option<Instant>,
    /// When to look next whether the file is still there.
    look: Instant,
    /// What was in the files after the last flush, which is what is left if the next one fails.
    flushed: Counted,
    /// What is in the files before the present one.
    finished: Counted,
    senders: BTreeMap<SourceId, Senders>,
    /// The files that are recorded anew, which no file of the recording replaces.
    read: Vec<std::fs::File>,
    progress: RecordProgress,
    shared: Arc<Mutex<RecordProgress>>,
    subjects: BTreeMap<(SourceId, u32), usize>,
    syncing: Syncing,
}

/// How far a recording has come.
#[derive(Clone, Debug, Default)]
pub struct RecordProgress {
    /// The file that is written now, or was last.
    pub file: PathBuf,
    /// How many files there are.
    pub files: u32,
    /// Bytes of all files.
    pub bytes: u64,
    /// The sources, in the session's order.
    pub sources: Vec<RecordedSource>,
    /// The subjects, in the order in which they were first heard of.
    pub subjects: Vec<RecordedSubject>,
    /// Items that found no room in the queue, because the disk was too slow.
    pub dropped: u64,
    /// Datagrams and samples that could not be written.
    pub unwritten: u64,
    /// Descriptions of subjects that changed more often than [`Writer::subject`] writes; no data is lost by that.
    pub descriptions_left_out: u64,
    /// Whether somebody has moved the file that is written, into which the recording goes on.
    pub moved: bool,
    /// Why nothing more is written. Then [`sources`](Self::sources) and [`subjects`](Self::subjects) have counts of what is in the
    /// files, and [`unwritten`](Self::unwritten) has the rest.
    pub failure: Option<Error>,
}

/// What was recorded of a source.
#[derive(Clone, Debug)]
pub struct RecordedSource {
    /// Where it is open.
    pub endpoint: Endpoint,
    /// Its datagrams.
    pub datagrams: u64,
    /// Their bytes.
    pub bytes: u64,
    /// When the last one was received.
    pub last: Option<Stamp>,
    /// Senders that send the same characters, or frames to the same group, at the same time: a sentence for each such case.
    pub two_senders: Vec<String>,
    /// How the source itself is doing.
    pub statistics: Option<Arc<Statistics>>,
}

/// What was recorded of a subject.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedSubject {
    /// Its source.
    pub source: SourceId,
    /// Its number at the source.
    pub id: u32,
    /// Its name, empty where the source does not say.
    pub name: String,
    /// Its samples.
    pub frames: u64,
}

impl RecordProgress {
    /// Everything that was lost on this machine: in the kernel, in the queue, and because it could not be written.
    pub fn lost(&self) -> u64 {
        let statistics = self.sources.iter().filter_map(|source| source.statistics.as_ref());
        let kernel: u64 = statistics.map(|statistics| statistics.kernel_dropped).sum();
        kernel + self.dropped + self.unwritten
    }

    /// Datagrams of all sources.
    pub fn datagrams(&self) -> u64 {
        self.sources.iter().map(|source| source.datagrams).sum()
    }

    /// Samples of all subjects.
    pub fn frames(&self) -> u64 {
        self.subjects.iter().map(|subject| subject.frames).sum()
    }
}

impl RecordedSource {
    /// Samples that never came, as far as the source can tell, of all its streams.
    pub fn missing(&self) -> u64 {
        let statistics = self.statistics.iter();
        statistics
            .flat_map(|statistics| statistics.streams().map(|(_, stream)| stream.counters.missing))
            .sum()
    }
}

impl RecordSink {
    /// The longest that what has come is not in the file yet, on a machine that keeps up.
    pub const FLUSH_EVERY: Duration = Duration::from_millis(100);
    /// Seconds of everything that 16 people give at 240 Hz, which is less than what any queue may hold in bytes.
    pub(super) const QUEUED: usize = 65_536;

    /// Creates the file. `sources` are the endpoints of the session's sources, in its order; `stop` is the session's.
    ///
    /// # Errors
    /// [`Error::Exists`] when the file is there and is not to be overwritten, [`Error::OntoItself`] when a source reads it,
    /// [`Error::BeingRecorded`] when another recorder writes it, [`Error::Write`] when it cannot be created.
    pub fn create(path: &Path, sources: &[Endpoint], options: RecordOptions, stop: Stop) -> Result<Self> {
        let read = reserve(sources, path)?;
        let endpoints: Vec<_> = sources.iter().map(ToString::to_string).collect();
        let writer = Writer::create(path, &endpoints, options)?;
        let sources = sources.iter().map(|endpoint| RecordedSource {
            endpoint: endpoint.clone(),
            datagrams: 0,
            bytes: 0,
            last: None,
            two_senders: Vec::new(),
            statistics: None,
        });
        let progress = RecordProgress {
            file: path.to_owned(),
            files: 1,
            sources: sources.collect(),
            ..RecordProgress::default()
        };
        Ok(Self {
            syncing: Syncing::start(&writer),
            writer: Some(writer),
            failure: None,
            stop,
            due: None,
            look: Instant::now() + LOOK_EVERY,
            flushed: Counted::default(),
            finished: Counted::default(),
            senders: BTreeMap::new(),
            read,
            shared: Arc::new(Mutex::new(progress.clone())),
            progress,
            subjects: BTreeMap::new(),
        })
    }

    /// Writes who is there already, before anything is recorded.
    pub(super) fn brief(&mut self, briefing: &Briefing) -> Result<()> {
        self.writer.as_mut().map_or(Ok(()), |writer| writer.brief(briefing))
    }

    /// How far it has come, brought up to date with every flush.
    pub fn progress(&self) -> Arc<Mutex<RecordProgress>> {
        Arc::clone(&self.shared)
    }

    fn record(&mut self, source: SourceId, item: &Item) -> Result<()> {
        if self
            .writer
            .as_ref()
            .is_some_and(|writer| !writer.has_room_for(length_of(item)))
        {
            self.flush()?;
        }
        let Some(writer) = &mut self.writer else {
            self.progress.unwritten += u64::from(is_data(item));
            return Ok(());
        };
        match item {
            Item::Datagram(datagram) => {
                writer.datagram(source, datagram)?;
                self.senders.entry(source).or_default().datagram(datagram);
                if let Some(source) = self.progress.sources.get_mut(usize::from(source.0)) {
                    source.datagrams += 1;
                    source.bytes += datagram.bytes.len() as u64;
                    source.last = Some(datagram.received);
                }
            }
            Item::Subject(subject) => writer.subject(source, subject)?,
            Item::Frame { frame, .. } => {
                writer.frame(source, frame)?;
                self.count(source, frame);
            }
            Item::Statistics(statistics) => {
                if let Some(source) = self.progress.sources.get_mut(usize::from(source.0)) {
                    source.statistics = Some(Arc::clone(statistics));
                }
                return Ok(());
            }
            Item::Notice(_) | Item::Ahead { .. } => return Ok(()),
        }
        self.due.get_or_insert_with(|| Instant::now() + Self::FLUSH_EVERY);
        Ok(())
    }

    fn count(&mut self, source: SourceId, frame: &Frame) {
        let (subject, subjects) = (&frame.subject, &mut self.progress.subjects);
        if subjects.len() >= Writer::MOST_SUBJECTS && !self.subjects.contains_key(&(source, subject.id)) {
            return;
        }
        let place = *self.subjects.entry((source, subject.id)).or_insert(subjects.len());
        if place == subjects.len() {
            subjects.push(RecordedSubject {
                source,
                id: subject.id,
                name: subject.name.clone(),
                frames: 0,
            });
        }
        if let Some(recorded) = subjects.get_mut(place) {
            recorded.frames += 1;
            if recorded.name != subject.name {
                recorded.name.clone_from(&subject.name);
            }
        }
    }

    fn flush(&mut self) -> Result<()> {
        self.hand_over()?;
        if let Some(writer) = &mut self.writer {
            if writer.split(self.progress.dropped)? {
                self.finished = self.flushed.clone();
            }
            self.syncing.follow(writer);
            self.syncing.failure()?;
        }
        self.publish();
        Ok(())
    }

    fn hand_over(&mut self) -> Result<()> {
        self.due = None;
        if let Some(writer) = &mut self.writer {
            writer.hand_over()?;
            self.flushed = Counted::of(&self.progress, writer);
        }
        Ok(())
    }

    /// Completes the file, after all that is to be in it is.
    fn close(&mut self) -> Result<()> {
        if let Some(writer) = &mut self.writer {
            writer.release()?;
        }
        self.hand_over()?;
        self.look()?;
        self.publish();
        if let Some(mut writer) = self.writer.take() {
            writer.path().clone_into(&mut self.progress.file);
            let closed = writer.close(self.progress.dropped);
            self.progress.bytes = writer.length();
            closed?;
        }
        Ok(())
    }

    /// Looks whether the file is still there, and who sends.
    fn look(&mut self) -> Result<()> {
        self.look = Instant::now() + LOOK_EVERY;
        for (source, senders) in &self.senders {
            if let Some(source) = self.progress.sources.get_mut(usize::from(source.0)) {
                source.two_senders = senders.findings().map(|finding| finding.what).collect();
            }
        }
        let Some(writer) = &self.writer else { return Ok(()) };
        let whereabouts = writer.whereabouts();
        self.progress.moved = whereabouts == Some(Whereabouts::Moved);
        if whereabouts == Some(Whereabouts::Removed) {
            let path = writer.path().to_owned();
            return Err(Error::Removed { path });
        }
        Ok(())
    }

    /// Ends the recording at what was flushed.
    fn fail(&mut self, error: Error) {
        let is_gone = matches!(error, Error::Removed { .. });
        if let Some(mut writer) = self.writer.take() {
            writer.path().clone_into(&mut self.progress.file);
            writer.abandon(is_gone);
            self.progress.bytes = writer.length();
        }
        let left = if is_gone { &self.finished } else { &self.flushed };
        self.progress.unwritten += left.restore(&mut self.progress);
        self.progress.failure = Some(error.clone());
        self.failure = Some(error);
        self.due = None;
        self.publish();
        self.stop.stop();
    }

    fn publish(&mut self) {
        if let Some(writer) = &self.writer {
            writer.path().clone_into(&mut self.progress.file);
            self.progress.files = writer.files();
            self.progress.bytes = writer.length();
            self.progress.descriptions_left_out = writer.descriptions_left_out();
        }
        let mut shared = lock(&self.shared);
        shared.clone_from(&self.progress);
    }
}

impl Sink for RecordSink {
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, Self::QUEUED)
    }

    fn wants(&self) -> Wants {
        Wants::ALL
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        if let Err(error) = self.record(source, item) {
            self.fail(error);
            self.progress.unwritten += u64::from(is_data(item));
        }
        Ok(())
    }

    fn dropped(&mut self, dropped: u64) {
        self.progress.dropped = dropped;
        self.publish();
    }

    fn timeout(&self) -> Option<Instant> {
        self.writer.as_ref()?;
        Some(self.due.map_or(self.look, |due| due.min(self.look)))
    }

    fn handle_timeout(&mut self) -> Result<()> {
        let is_time_to_look = Instant::now() >= self.look;
        let looked = if is_time_to_look { self.look() } else { Ok(()) };
        if let Err(error) = looked.and_then(|()| self.flush()) {
            self.fail(error);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        if let Err(error) = self.close() {
            self.fail(error);
        }
        self.syncing.end();
        match self.syncing.failure() {
            Err(error) if self.failure.is_none() => self.fail(error),
            _ => self.publish(),
        }
        self.failure.take().map_or(Ok(()), Err)
    }
}

impl std::fmt::Debug for RecordSink {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RecordSink")
            .field("file", &self.progress.file)
            .field("read", &self.read)
            .finish_non_exhaustive()
    }
}

/// Keeps the files that sources read from being written, for as long as they are open here.
fn reserve(sources: &[Endpoint], path: &Path) -> Result<Vec<std::fs::File>> {
    let mut read = Vec::new();
    for source in sources {
        let Endpoint::Capture { path: capture } = source else {
            continue;
        };
        // What cannot be read the source says.
        let capture = Capture::open(capture, &CaptureOptions::default());
        for file in capture.iter().flat_map(Capture::files) {
            if is_same_file(file, path) {
                return Err(Error::OntoItself { path: path.to_owned() });
            }
            read.extend(read_locked(file));
        }
    }
    Ok(read)
}

/// What of each source and subject is in the files.
#[derive(Clone, Debug, Default)]
struct Counted {
    /// Datagrams and their bytes.
    sources: Vec<(u64, u64)>,
    subjects: Vec<u64>,
}

impl Counted {
    fn of(progress: &RecordProgress, writer: &Writer) -> Self {
        let sources = progress.sources.iter().map(|source| (source.datagrams, source.bytes));
        let written = |subject: &RecordedSubject| {
            let held = writer.held(subject.source, subject.id);
            subject.frames.saturating_sub(held)
        };
        Self {
            sources: sources.collect(),
            subjects: progress.subjects.iter().map(written).collect(),
        }
    }

    /// Takes the counts back to these, and gives how many datagrams and samples that takes away.
    fn restore(&self, progress: &mut RecordProgress) -> u64 {
        let before = progress.datagrams() + progress.frames();
        for (place, source) in progress.sources.iter_mut().enumerate() {
            (source.datagrams, source.bytes) = self.sources.get(place).copied().unwrap_or_default();
        }
        for (place, subject) in progress.subjects.iter_mut().enumerate() {
            subject.frames = self.subjects.get(place).copied().unwrap_or_default();
        }
        before - progress.datagrams() - progress.frames()
    }
}

/// About how many bytes an item takes in the file.
fn length_of(item: &Item) -> u64 {
    match item {
        Item::Datagram(datagram) => AROUND + datagram.bytes.len() as u64,
        Item::Frame { frame, .. } => AROUND + TRANSFORM * frame.subject.skeleton.segments.len() as u64,
        _ => 0,
    }
}

/// Whether an item is a datagram or a sample.
fn is_data(item: &Item) -> bool {
    matches!(item, Item::Datagram(_) | Item::Frame { .. })
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Between looks whether the file is still there.
const LOOK_EVERY: Duration = Duration::from_secs(1);
/// What a message has around it, and a transform in a message, with names as long as they are.
const AROUND: u64 = 64;
const TRANSFORM: u64 = 160;
