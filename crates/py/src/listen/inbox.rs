//! What has arrived and not been taken yet.

use super::bell::Sleeper;
use super::newest::Newest;
use crate::frame::{Arrival, Frame};
use posewire::queue::Policy;
use posewire::stats::Statistics;
use posewire::{Foremost, Item, Notice, Result, Sink, SourceId, Wants};
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How samples are kept, and for how long they are worth something.
#[derive(Clone, Copy, Debug)]
pub(super) struct Keeping {
    /// The most samples that wait to be taken.
    pub(super) capacity: usize,
    pub(super) stale_after: Duration,
    pub(super) lost_after: Duration,
}

/// Between the engine's thread, which puts samples in, and Python's, which take them out. Clones share it.
#[derive(Clone)]
pub(super) struct Inbox {
    keeping: Keeping,
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    held: Mutex<Held>,
    /// A sample is there, or there will be no more.
    changed: Condvar,
}

#[derive(Default)]
struct Held {
    waiting: VecDeque<Frame>,
    foremost: Foremost,
    newest: Newest,
    /// Whether anybody has begun to take samples out one by one: before, old ones make room and nobody misses them.
    is_read: bool,
    dropped: u64,
    /// Those of `dropped` that nobody has been told of.
    untold: u64,
    statistics: BTreeMap<SourceId, Arc<Statistics>>,
    notices: VecDeque<String>,
    /// Threads that wait, and those who wait without one.
    waiting_threads: usize,
    sleepers: Vec<Sleeper>,
    ended: bool,
}

impl Inbox {
    pub(super) fn new(keeping: Keeping) -> Self {
        let shared = Arc::default();
        Self { keeping, shared }
    }

    /// The oldest sample that nobody has taken.
    pub(super) fn take(&self) -> Option<Frame> {
        let mut held = self.lock();
        held.is_read = true;
        held.waiting.pop_front()
    }

    /// The newest sample, of all subjects or of one by its name.
    pub(super) fn newest(&self, subject: Option<&str>) -> Option<Frame> {
        let held = self.lock();
        held.newest(subject).cloned()
    }

    /// Waits no longer than told until a sample can be taken or none will come.
    pub(super) fn wait(&self, longest: Duration) -> bool {
        self.wait_until(longest, |held| !held.waiting.is_empty())
    }

    /// Waits no longer than told until there is a newest sample of a subject, or none will come.
    pub(super) fn wait_for_newest(&self, subject: Option<&str>, longest: Duration) -> bool {
        self.wait_until(longest, |held| held.newest(subject).is_some())
    }

    fn wait_until(&self, longest: Duration, is_there: impl Fn(&Held) -> bool) -> bool {
        let mut held = self.lock();
        held.waiting_threads += 1;
        let waits = |held: &mut Held| !is_there(held) && !held.ended;
        let waited = self.shared.changed.wait_timeout_while(held, longest, waits);
        let (mut held, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
        held.waiting_threads -= 1;
        !timeout.timed_out()
    }

    /// Wakes somebody when a sample can be taken or none will come; `false` if that is so already.
    pub(super) fn wake(&self, sleeper: Sleeper) -> bool {
        let mut held = self.lock();
        let sleeps = held.waiting.is_empty() && !held.ended;
        if sleeps {
            held.sleepers.push(sleeper);
        }
        sleeps
    }

    /// Wakes somebody no more.
    pub(super) fn let_sleep(&self, number: u64) {
        self.lock().sleepers.retain(|sleeper| sleeper.number != number);
    }

    /// Whether no sample will come any more; some may wait to be taken.
    pub(super) fn has_ended(&self) -> bool {
        self.lock().ended
    }

    /// Samples that found no room since they are taken one by one.
    pub(super) fn dropped(&self) -> u64 {
        self.lock().dropped
    }

    /// Those of them that nobody has been told of; told by this.
    pub(super) fn tell_dropped(&self) -> u64 {
        std::mem::take(&mut self.lock().untold)
    }

    /// Names of the subjects that were heard of.
    pub(super) fn subjects(&self) -> Vec<String> {
        self.lock().newest.subjects().map(str::to_owned).collect()
    }

    /// The newest statistics of each source.
    pub(super) fn statistics(&self) -> Vec<Arc<Statistics>> {
        self.lock().statistics.values().cloned().collect()
    }

    /// What the sources had to say, the newest last.
    pub(super) fn notices(&self) -> Vec<String> {
        self.lock().notices.iter().cloned().collect()
    }

    /// Ends all waiting.
    pub(super) fn end(&self) {
        let mut held = self.lock();
        held.ended = true;
        self.rouse(held);
    }

    /// Wakes all who wait.
    fn rouse(&self, mut held: MutexGuard<'_, Held>) {
        let threads = held.waiting_threads;
        let sleepers = std::mem::take(&mut held.sleepers);
        drop(held);
        if threads > 0 {
            self.shared.changed.notify_all();
        }
        sleepers.into_iter().for_each(Sleeper::wake);
    }

    fn lock(&self) -> MutexGuard<'_, Held> {
        self.shared.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps a sample that comes in its turn, or ahead of it for those who want the newest alone.
    fn keep(&self, source: SourceId, item: &Item, frame: &Arc<posewire_motion::Frame>) {
        let arrived = Frame {
            frame: Arc::clone(frame),
            arrival: Some(Arrival {
                at: item.arrived(),
                stale_after: self.keeping.stale_after,
                lost_after: self.keeping.lost_after,
            }),
        };
        let mut held = self.lock();
        if held.foremost.newest(source, item).is_some() {
            held.newest.put(source, &arrived);
        }
        if matches!(item, Item::Frame { .. }) {
            held.add(arrived, self.keeping.capacity);
        }
        self.rouse(held);
    }
}

impl Held {
    fn newest(&self, subject: Option<&str>) -> Option<&Frame> {
        subject.map_or_else(|| self.newest.of_all(), |subject| self.newest.of(subject))
    }

    fn add(&mut self, frame: Frame, capacity: usize) {
        if self.waiting.len() < capacity {
            self.waiting.push_back(frame);
        } else if self.is_read {
            self.dropped += 1;
            self.untold += 1;
        } else {
            self.waiting.pop_front();
            self.waiting.push_back(frame);
        }
    }

    fn note(&mut self, notice: &Notice) {
        if self.notices.len() == MOST_NOTICES {
            self.notices.pop_front();
        }
        self.notices.push_back(notice.to_string());
    }
}

impl Sink for Inbox {
    fn queue(&self) -> (Policy, usize) {
        // What waits for Python waits in the inbox; this is for a thread that the system lets wait.
        (Policy::Lossless, self.keeping.capacity.max(1024))
    }

    fn wants(&self) -> Wants {
        Wants {
            ahead: true,
            ..Wants::default()
        }
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        match item {
            Item::Frame { frame, .. } | Item::Ahead { frame, .. } => self.keep(source, item, frame),
            Item::Statistics(statistics) => {
                self.lock().statistics.insert(source, Arc::clone(statistics));
            }
            Item::Notice(notice) => self.lock().note(notice),
            _ => {}
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.end();
        Ok(())
    }
}

const MOST_NOTICES: usize = 100;
