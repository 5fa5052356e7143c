//! The newest of everything, for whoever shows it.

use posewire::queue::Policy;
use posewire::stats::Statistics;
use posewire::stop::Stop;
use posewire::{Item, Notice, Result, Sink};
use posewire_motion::Frame;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The newest of everything that a stream brought. Clones are the same board.
#[derive(Clone)]
pub(super) struct Board {
    listening: Arc<str>,
    newest: Arc<Mutex<Newest>>,
    count: Option<u64>,
    stop: Stop,
}

#[derive(Default)]
struct Newest {
    frames: BTreeMap<u32, Arc<Frame>>,
    statistics: Option<Arc<Statistics>>,
    notice: Option<Notice>,
    samples: u64,
}

impl Board {
    /// A board that sets `stop` after `count` samples.
    pub(super) fn new(listening: String, count: Option<u64>, stop: Stop) -> Self {
        Self {
            listening: listening.into(),
            newest: Arc::default(),
            count,
            stop,
        }
    }

    /// The end that a session feeds.
    pub(super) fn sink(&self) -> impl Sink + use<> {
        BoardSink(self.clone())
    }

    pub(super) fn listening(&self) -> &str {
        &self.listening
    }

    pub(super) fn statistics(&self) -> Option<Arc<Statistics>> {
        self.lock().statistics.clone()
    }

    /// The newest sample of each character.
    pub(super) fn frames(&self) -> Vec<Arc<Frame>> {
        self.lock().frames.values().cloned().collect()
    }

    pub(super) fn notice(&self) -> Option<Notice> {
        self.lock().notice.clone()
    }

    /// Whether any datagram has come yet, readable or not.
    pub(super) fn has_heard(&self) -> bool {
        let newest = self.lock();
        newest.samples > 0
            || newest
                .statistics
                .as_ref()
                .is_some_and(|statistics| statistics.datagrams > 0)
    }

    /// What to check when nothing comes.
    pub(super) fn hint(&self) -> String {
        let listening = &self.listening;
        format!(
            "nothing has come to {listening} yet. Check that\n\
             - the sender streams to an address of this machine and to this port\n\
             - no firewall keeps it away: UDP and TCP have rules of their own\n\
             - both sides speak the same: mxtp:// is UDP, mxtp+tcp:// is TCP"
        )
    }

    fn lock(&self) -> MutexGuard<'_, Newest> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct BoardSink(Board);

impl Sink for BoardSink {
    /// Only the newest matters; but samples are counted, so none is to be lost in a burst.
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, QUEUED_ITEMS)
    }

    fn accept(&mut self, item: &Item) -> Result<()> {
        let mut newest = self.0.lock();
        match item {
            Item::Frame { frame, .. } => {
                newest.frames.insert(frame.subject.id, Arc::clone(frame));
                newest.samples += 1;
                if self.0.count.is_some_and(|count| newest.samples >= count) {
                    self.0.stop.stop();
                }
            }
            Item::Statistics(statistics) => newest.statistics = Some(Arc::clone(statistics)),
            Item::Notice(notice) => newest.notice = Some(notice.clone()),
            _ => {}
        }
        Ok(())
    }

    /// Nothing more will come: whoever shows the board is to end.
    fn finish(&mut self) -> Result<()> {
        self.0.stop.stop();
        Ok(())
    }
}

/// Four seconds of 16 people at 240 Hz.
pub(super) const QUEUED_ITEMS: usize = 16_384;
