//! Streams something and gathers what arrives.

use posewire::endpoint::Endpoint;
use posewire::sink::{MxtpSink, MxtpSinkOptions, Progress};
use posewire::source::PlaybackOptions;
use posewire::stats::{DatagramKind, ServerStatistics, Statistics, StreamStatistics};
use posewire::stop::Stop;
use posewire::{Item, Notice, Result, Session, Sink, Source, SourceId};
use posewire_motion::{Frame, Subject};
use posewire_mxtp::MessageType;
use posewire_mxtp::motion::MessageTypes;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::Duration;

/// Everything that arrived.
#[derive(Clone, Default)]
pub(crate) struct Gathered {
    pub(crate) frames: Vec<Arc<Frame>>,
    pub(crate) subjects: Vec<Arc<Subject>>,
    pub(crate) statistics: Option<Arc<Statistics>>,
    pub(crate) notices: Vec<Notice>,
}

impl Gathered {
    /// The numbers of the server that it came from.
    pub(crate) fn server(&self) -> ServerStatistics {
        let statistics = self
            .statistics
            .as_ref()
            .expect("a receiver gives statistics when it ends");
        ServerStatistics::clone(statistics.server.as_ref().expect("the server has answered"))
    }

    /// The numbers of one datagram type of one character.
    pub(crate) fn statistics_of(&self, character: u32, message_type: MessageType) -> &StreamStatistics {
        let statistics = self
            .statistics
            .as_ref()
            .expect("a receiver gives statistics when it ends");
        let subject = statistics
            .subjects
            .iter()
            .find(|subject| subject.subject.id == character);
        let streams = &subject.expect("the character was heard").streams;
        streams
            .iter()
            .find(|stream| stream.kind == DatagramKind::Mxtp(message_type))
            .expect("the type was heard")
    }

    /// Asserts that nothing of any type of any character was lost or strange.
    pub(crate) fn assert_whole(&self) {
        let statistics = self
            .statistics
            .as_ref()
            .expect("a receiver gives statistics when it ends");
        assert_eq!(statistics.malformed, 0);
        assert_eq!(statistics.kernel_dropped, 0);
        assert_eq!(statistics.skipped_bytes, 0);
        for (subject, stream) in statistics.streams() {
            let counters = &stream.counters;
            let losses = [
                counters.missing,
                counters.duplicate,
                counters.late,
                counters.restarts(),
                counters.incomplete,
            ];
            let of = subject.map(|subject| subject.id);
            assert_eq!(losses, [0; 5], "{} of {of:?}", stream.kind);
        }
    }
}

/// A sink that keeps everything. Clones keep it in the same place.
#[derive(Clone, Default)]
pub(crate) struct Gatherer(Arc<(Mutex<Gathered>, Condvar)>);

impl Gatherer {
    pub(crate) fn lock(&self) -> MutexGuard<'_, Gathered> {
        self.0.0.lock().unwrap()
    }

    /// Waits no longer than `time` until what was gathered is enough; whether it is.
    pub(crate) fn comes_within(&self, time: Duration, enough: impl Fn(&Gathered) -> bool) -> bool {
        let waiting = |gathered: &mut Gathered| !enough(gathered);
        let (_gathered, timeout) = self.0.1.wait_timeout_while(self.lock(), time, waiting).unwrap();
        !timeout.timed_out()
    }

    /// Waits until what was gathered is enough; fails when it is not in a generous time.
    pub(crate) fn wait_until(&self, enough: impl Fn(&Gathered) -> bool) {
        let waiting = |gathered: &mut Gathered| !enough(gathered);
        let (gathered, timeout) = self.0.1.wait_timeout_while(self.lock(), PATIENCE, waiting).unwrap();
        assert!(
            !timeout.timed_out(),
            "after {PATIENCE:?} only {} frames have come",
            gathered.frames.len()
        );
    }
}

impl Sink for Gatherer {
    fn accept(&mut self, _: SourceId, item: &Item) -> Result<()> {
        let mut gathered = self.lock();
        match item {
            Item::Frame { frame, .. } => gathered.frames.push(Arc::clone(frame)),
            Item::Subject(subject) => gathered.subjects.push(Arc::clone(subject)),
            Item::Statistics(statistics) => gathered.statistics = Some(Arc::clone(statistics)),
            Item::Notice(notice) => gathered.notices.push(notice.clone()),
            _ => {}
        }
        self.0.1.notify_all();
        Ok(())
    }
}

/// A receiver that runs.
pub(crate) struct Receiver {
    pub(crate) endpoint: Endpoint,
    pub(crate) gatherer: Gatherer,
    session: Session,
    stop: Stop,
}

impl Receiver {
    pub(crate) fn start(endpoint: &str) -> Self {
        Self::run(open(endpoint).unwrap(), Stop::new())
    }

    /// Runs a source that is open until the stop.
    pub(crate) fn run(source: Source, stop: Stop) -> Self {
        let (endpoint, gatherer) = (source.endpoint().clone(), Gatherer::default());
        let session = Session::start([source], vec![Box::new(gatherer.clone())], stop.clone());
        Self {
            endpoint,
            gatherer,
            session,
            stop,
        }
    }

    /// Waits for as many frames, then ends and gives everything.
    pub(crate) fn finish(self, frames: u64) -> Gathered {
        self.gatherer
            .wait_until(|gathered| gathered.frames.len() as u64 >= frames);
        self.stop()
    }

    /// Ends at once and gives everything.
    pub(crate) fn stop(self) -> Gathered {
        self.stop.stop();
        assert_eq!(self.session.wait().unwrap().dropped, 0);
        self.gatherer.lock().clone()
    }
}

/// Opens a source with the usual options.
pub(crate) fn open(endpoint: &str) -> Result<Source> {
    Source::open(&endpoint.parse().unwrap(), &PlaybackOptions::default())
}

/// Plays a source to a sink until it ends.
pub(crate) fn play(source: &str, playback: &PlaybackOptions, sink: MxtpSink) -> Progress {
    let stop = Stop::new();
    let source = Source::open(&source.parse().unwrap(), playback).unwrap();
    let progress = sink.progress();
    sink.wait_until_ready(&stop);
    Session::start([source], vec![Box::new(sink)], stop).wait().unwrap();
    let progress = progress.lock().unwrap().clone();
    assert_eq!(progress.lost(), 0);
    progress
}

/// A sink that takes so many frames and then ends the session, however long that takes.
struct First {
    left: u64,
    sink: MxtpSink,
    stop: Stop,
}

impl Sink for First {
    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        if let Item::Frame { .. } = item {
            let Some(left) = self.left.checked_sub(1) else {
                return Ok(());
            };
            self.left = left;
        }
        self.sink.accept(source, item)?;
        if self.left == 0 {
            self.stop.stop();
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.sink.finish()
    }
}

/// Plays the first frames of a source to a sink. Playback that ends by the clock has fewer of them on a busy machine.
pub(crate) fn play_first(source: &str, frames: u64, sink: MxtpSink) {
    let stop = Stop::new();
    let progress = sink.progress();
    sink.wait_until_ready(&stop);
    let first = First {
        left: frames,
        sink,
        stop: stop.clone(),
    };
    Session::start([open(source).unwrap()], vec![Box::new(first)], stop)
        .wait()
        .unwrap();
    let progress = progress.lock().unwrap();
    assert_eq!((progress.frames, progress.lost()), (frames, 0));
}

/// Streams the first frames of a source over UDP and gives what arrived.
pub(crate) fn first_over_udp(source: &str, frames: u64, options: MxtpSinkOptions) -> Gathered {
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), options).unwrap();
    play_first(source, frames, sink);
    receiver.finish(frames)
}

/// Streams a source over UDP and gives what arrived.
pub(crate) fn over_udp(source: &str, playback: &PlaybackOptions, options: MxtpSinkOptions) -> Gathered {
    let receiver = Receiver::start("mxtp://127.0.0.1:0");
    let sink = MxtpSink::open(std::slice::from_ref(&receiver.endpoint), options).unwrap();
    let progress = play(source, playback, sink);
    receiver.finish(progress.frames)
}

/// Options that send these types.
pub(crate) fn types(types: &str) -> MxtpSinkOptions {
    MxtpSinkOptions {
        types: types.parse::<MessageTypes>().unwrap(),
        ..MxtpSinkOptions::default()
    }
}

/// Playback that ends after so many seconds.
pub(crate) fn seconds(seconds: f64) -> PlaybackOptions {
    PlaybackOptions {
        duration: Some(Duration::from_secs_f64(seconds)),
        ..PlaybackOptions::default()
    }
}

/// Far more than any test needs on the slowest machine.
pub(crate) const PATIENCE: Duration = Duration::from_mins(1);
