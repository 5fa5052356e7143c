//! The newest of everything that live sources bring, for any number of pages.

use crate::channel::{present, with_told};
use crate::derived::SampleRate;
use crate::hold::Hold;
use crate::scene::{Scene, SubjectRecord};
use crate::series::{Plot, Wish};
use crate::wire::{self, State};
use posewire::endpoint::Endpoint;
use posewire::stats::Statistics;
use posewire::{Foremost, Item, SourceId};
use posewire_motion::{Frame, Subject};
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

/// The newest frame of every subject of live sources. Clones share it.
///
/// What a page does not fetch is replaced by what comes next, so that a slow page costs neither memory nor time of others.
#[derive(Clone, Debug)]
pub struct Feed {
    sources: Arc<[String]>,
    began: Instant,
    state: Arc<Mutex<Newest>>,
}

#[derive(Debug, Default)]
struct Newest {
    subjects: Vec<Live>,
    numbers: HashMap<(SourceId, u32), u32>,
    /// Grows with every change of a subject.
    version: u64,
    /// Grows with every frame that is shown.
    shown: u64,
    /// Frames in their turn.
    frames: u64,
    foremost: Foremost,
    statistics: Vec<Option<Arc<Statistics>>>,
    notices: VecDeque<String>,
    /// How many notices there have been.
    noticed: u64,
    plots: Vec<Weak<Mutex<Plot>>>,
    ended: bool,
    /// Samples of subjects beyond those that are followed.
    refused: u64,
    /// Items that came faster than they could be taken.
    dropped: u64,
}

/// A subject that is live.
#[derive(Debug)]
struct Live {
    source: SourceId,
    subject: Arc<Subject>,
    /// What is shown: the newest, with what it lacks.
    frame: Option<Arc<Frame>>,
    hold: Hold,
    /// Which frame of all it is.
    number: u64,
    arrived: Instant,
    /// The time from frame to frame, s, smoothed.
    period: f64,
    rate: SampleRate,
    /// The sections that it has had.
    present: u32,
    /// The frame as pages get it, once one has asked.
    record: Option<Arc<[u8]>>,
}

/// What a page has of each subject: the frame's number, and the state.
pub(crate) type Seen = Vec<(u64, State)>;

impl Feed {
    /// A feed of these sources, which are those of the session in its order.
    pub fn new(sources: &[Endpoint]) -> Self {
        let newest = Newest {
            statistics: vec![None; sources.len()],
            ..Newest::default()
        };
        Self {
            sources: sources.iter().map(ToString::to_string).collect(),
            began: Instant::now(),
            state: Arc::new(Mutex::new(newest)),
        }
    }

    /// A source as its endpoint.
    pub(crate) fn source(&self, id: u16) -> Option<&str> {
        self.sources.get(usize::from(id)).map(String::as_str)
    }

    /// Takes what a source brings.
    pub(crate) fn take(&self, source: SourceId, item: &Item) {
        let mut newest = self.lock();
        match item {
            Item::Subject(subject) => {
                newest.subject(source, subject);
            }
            Item::Frame { frame, .. } | Item::Ahead { frame, .. } => newest.frame(source, item, frame),
            Item::Statistics(statistics) => {
                if let Some(slot) = newest.statistics.get_mut(usize::from(source.0)) {
                    *slot = Some(Arc::clone(statistics));
                }
            }
            Item::Notice(notice) => newest.notice(notice.to_string()),
            _ => {}
        }
    }

    /// So many items, since the start, were replaced by newer ones before they were taken.
    pub(crate) fn set_dropped(&self, dropped: u64) {
        self.lock().dropped = dropped;
    }

    /// Nothing more will come.
    pub(crate) fn end(&self) {
        self.lock().ended = true;
    }

    /// Whether nothing more will come.
    pub(crate) fn has_ended(&self) -> bool {
        self.lock().ended
    }

    /// Grows with every change of the scene.
    pub(crate) fn version(&self) -> u64 {
        self.lock().version
    }

    /// Every subject that there was, in the order of the page's numbers.
    fn subjects(&self) -> Vec<SubjectRecord> {
        let newest = self.lock();
        let subjects = newest.subjects.iter().zip(0..);
        let subjects =
            subjects.map(|(live, id)| SubjectRecord::new(id, live.source.0, &live.subject, with_told(live.present)));
        subjects.collect()
    }

    /// The scene as JSON.
    pub(crate) fn scene(&self, recorder: bool) -> String {
        let subjects = self.subjects();
        let scene = Scene::live(&self.sources, &subjects, recorder);
        serde_json::to_string(&scene).unwrap_or_default()
    }

    /// The newest statistics of each source that has told any.
    pub(crate) fn statistics(&self) -> Vec<(u16, Arc<Statistics>)> {
        let newest = self.lock();
        let told = (0..).zip(&newest.statistics);
        told.filter_map(|(source, told)| Some((source, Arc::clone(told.as_ref()?))))
            .collect()
    }

    /// The notices behind the first `known` ones, as far as they are still kept, and how many there have been.
    pub(crate) fn notices(&self, known: u64) -> (Vec<String>, u64) {
        let newest = self.lock();
        let fresh = usize::try_from(newest.noticed - known.min(newest.noticed)).unwrap_or(usize::MAX);
        let skipped = newest.notices.len().saturating_sub(fresh);
        (newest.notices.iter().skip(skipped).cloned().collect(), newest.noticed)
    }

    /// How many frames there were, how many of subjects that found no place, and how many items were dropped.
    pub(crate) fn counts(&self) -> (u64, u64, u64) {
        let newest = self.lock();
        (newest.frames, newest.refused, newest.dropped)
    }

    /// Writes a tick with a record of each subject that has a newer frame or another state than the page has `seen`.
    pub(crate) fn tick(&self, number: u32, seen: &mut Seen, out: &mut Vec<u8>) {
        let now = Instant::now();
        wire::begin_tick(number, now.saturating_duration_since(self.began).as_secs_f64(), out);
        let mut count = 0;
        let mut newest = self.lock();
        seen.resize(newest.subjects.len(), (0, State::Live));
        for ((id, live), seen) in (0..).zip(&mut newest.subjects).zip(seen) {
            let state = live.state(now);
            if live.number > 0 && (live.number, state) != *seen {
                *seen = (live.number, state);
                live.write(id, now, state, out);
                count += 1;
            }
        }
        wire::set_count(out, count);
    }

    /// Begins to keep every sample of these channels, for as long as the plot is held.
    pub(crate) fn plot(&self, wishes: Vec<Wish>) -> Arc<Mutex<Plot>> {
        let mut plot = Plot::new(wishes);
        let mut newest = self.lock();
        for (live, id) in newest.subjects.iter().zip(0..) {
            plot.resolve(id, &live.subject.skeleton);
        }
        let plot = Arc::new(Mutex::new(plot));
        newest.plots.retain(|plot| plot.strong_count() > 0);
        newest.plots.push(Arc::downgrade(&plot));
        plot
    }

    fn lock(&self) -> MutexGuard<'_, Newest> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Newest {
    /// The place of a subject, which is brought up to date; `None` when there are too many.
    fn subject(&mut self, source: SourceId, subject: &Arc<Subject>) -> Option<u32> {
        if let Some(&id) = self.numbers.get(&(source, subject.id)) {
            let live = &mut self.subjects[id as usize];
            if !Arc::ptr_eq(&live.subject, subject) {
                let changed = live.subject != *subject;
                live.subject = Arc::clone(subject);
                if changed {
                    self.changed(id);
                }
            }
            return Some(id);
        }
        if self.subjects.len() == MOST_SUBJECTS {
            self.refused += 1;
            return None;
        }
        let id = self.subjects.len() as u32;
        self.numbers.insert((source, subject.id), id);
        self.subjects.push(Live::new(source, subject));
        self.changed(id);
        Some(id)
    }

    fn changed(&mut self, id: u32) {
        self.version += 1;
        let skeleton = &self.subjects[id as usize].subject.skeleton;
        for plot in self.plots.iter().filter_map(Weak::upgrade) {
            lock(&plot).resolve(id, skeleton);
        }
    }

    fn frame(&mut self, source: SourceId, item: &Item, frame: &Arc<Frame>) {
        let Some(id) = self.subject(source, &frame.subject) else {
            return;
        };
        let live = &mut self.subjects[id as usize];
        // One that a newer had overtaken would show the past; plots have every sample.
        if self.foremost.newest(source, item).is_some() {
            self.shown += 1;
            if live.take(frame, self.shown, item.arrived()) {
                self.version += 1;
            }
        }
        if matches!(item, Item::Ahead { .. }) {
            return;
        }
        self.frames += 1;
        let rate = frame.subject.rate.or_else(|| live.rate.rate());
        for plot in self.plots.iter().filter_map(Weak::upgrade) {
            lock(&plot).take(id, frame, rate);
        }
    }

    fn notice(&mut self, text: String) {
        if self.notices.len() == MOST_NOTICES {
            self.notices.pop_front();
        }
        self.notices.push_back(text);
        self.noticed += 1;
    }
}

impl Live {
    fn new(source: SourceId, subject: &Arc<Subject>) -> Self {
        Self {
            source,
            subject: Arc::clone(subject),
            frame: None,
            hold: Hold::default(),
            number: 0,
            arrived: Instant::now(),
            period: 0.0,
            rate: SampleRate::default(),
            present: 0,
            record: None,
        }
    }

    /// Takes a frame that has arrived; whether it has a section that none before had.
    fn take(&mut self, frame: &Arc<Frame>, number: u64, arrived: Instant) -> bool {
        if self.number > 0 {
            let elapsed = arrived.saturating_duration_since(self.arrived).as_secs_f64().min(1.0);
            self.period += (elapsed - self.period) * SMOOTHING;
        }
        (self.number, self.arrived) = (number, arrived);
        self.record = None;
        self.rate.take(frame);
        let before = self.present;
        self.present |= present(frame);
        self.frame = Some(self.hold.take(frame));
        self.present != before
    }

    fn state(&self, now: Instant) -> State {
        let age = now.saturating_duration_since(self.arrived);
        if age.as_secs_f64() < (self.period * 10.0).max(STALE_AFTER.as_secs_f64()) {
            State::Live
        } else if age < LOST_AFTER {
            State::Stale
        } else {
            State::Lost
        }
    }

    fn write(&mut self, id: u32, now: Instant, state: State, out: &mut Vec<u8>) {
        let Some(frame) = &self.frame else { return };
        let record = self.record.get_or_insert_with(|| {
            let mut record = Vec::new();
            wire::write_record(id, frame, &mut record);
            record.into()
        });
        let start = out.len();
        out.extend_from_slice(record);
        let age = now.saturating_duration_since(self.arrived).as_secs_f32();
        wire::set_age(&mut out[start..], age, state);
    }
}

fn lock(plot: &Mutex<Plot>) -> MutexGuard<'_, Plot> {
    plot.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The least time without a frame after which a subject is stale.
const STALE_AFTER: Duration = Duration::from_millis(250);
const LOST_AFTER: Duration = Duration::from_secs(3);
/// What a new interval counts for in the smoothed one.
const SMOOTHING: f64 = 0.05;
/// More than MVN and Motive can have together.
const MOST_SUBJECTS: usize = 4096;
const MOST_NOTICES: usize = 32;
