//! From frames to samples of named subjects.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use posewire_motion::{Frame, Stamp, Subject};
use posewire_natnet::client::ReceivedFrame;
use posewire_natnet::motion::{Settings, Subjects};

/// Makes samples of frames, and knows which subjects were told of.
///
/// The names are in the descriptions, and the rate is in an answer, which come a moment after the first frames. Those wait,
/// so that no subject begins under a number and goes on under a name; but not for ever, as some servers describe nothing.
#[derive(Debug)]
pub(super) struct Naming {
    pub(super) subjects: Subjects,
    told: BTreeMap<u32, Arc<Subject>>,
    samples: Vec<Frame>,
    waiting: Option<Waiting>,
}

/// A frame and when it arrived.
pub(super) type Arrived = (ReceivedFrame, Stamp);

#[derive(Debug, Default)]
struct Waiting {
    frames: Vec<Arrived>,
    since: Option<Instant>,
    has_model: bool,
    has_rate: bool,
}

impl Naming {
    pub(super) fn new(settings: Settings) -> Self {
        Self {
            subjects: Subjects::new(settings),
            told: BTreeMap::new(),
            samples: Vec::new(),
            waiting: Some(Waiting::default()),
        }
    }

    /// Lets frames wait, as at the beginning.
    pub(super) fn wait(&mut self) {
        self.waiting.get_or_insert_default();
    }

    /// Keeps a frame back if it is to wait.
    pub(super) fn hold(&mut self, frame: Arrived) -> Option<Arrived> {
        let Some(waiting) = &mut self.waiting else {
            return Some(frame);
        };
        waiting.begin();
        waiting.frames.push(frame);
        None
    }

    pub(super) fn note_model(&mut self) {
        if let Some(waiting) = &mut self.waiting {
            waiting.begin();
            waiting.has_model = true;
        }
    }

    pub(super) fn note_rate(&mut self) {
        if let Some(waiting) = &mut self.waiting {
            waiting.has_rate = true;
        }
    }

    /// Whether something is still waited for.
    pub(super) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// The frames that have waited, as soon as there is nothing more to wait for, or at once at the `end`.
    pub(super) fn release(&mut self, end: bool) -> Option<Vec<Arrived>> {
        let waiting = self.waiting.take_if(|waiting| end || waiting.is_over())?;
        Some(waiting.frames)
    }

    /// The samples that a frame holds. Give them back with [`reuse`](Self::reuse).
    pub(super) fn read(&mut self, frame: &posewire_natnet::frame::Frame) -> Vec<Frame> {
        let mut samples = std::mem::take(&mut self.samples);
        self.subjects.read(frame, &mut samples);
        samples
    }

    pub(super) fn reuse(&mut self, samples: Vec<Frame>) {
        self.samples = samples;
    }

    /// Whether a subject is new or not what it was, so that it has to be told of now.
    pub(super) fn is_news(&mut self, subject: &Arc<Subject>) -> bool {
        let known = self.told.get(&subject.id);
        let is_news = known.is_none_or(|known| !Arc::ptr_eq(known, subject));
        if is_news {
            self.told.insert(subject.id, Arc::clone(subject));
        }
        is_news
    }

    /// The subjects that there are, by number.
    pub(super) fn all(&self) -> Vec<Arc<Subject>> {
        let mut all: Vec<_> = self.subjects.subjects().map(Arc::clone).collect();
        all.sort_unstable_by_key(|subject| subject.id);
        all
    }
}

impl Waiting {
    fn begin(&mut self) {
        self.since.get_or_insert_with(Instant::now);
    }

    fn is_over(&self) -> bool {
        let is_late = self.since.is_some_and(|since| since.elapsed() >= PATIENCE);
        (self.has_model && self.has_rate) || is_late || self.frames.len() >= MAX_WAITING
    }
}

/// A server that has not described anything by then does not.
const PATIENCE: Duration = Duration::from_secs(1);
const MAX_WAITING: usize = 256;
