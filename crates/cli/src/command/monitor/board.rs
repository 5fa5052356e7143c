//! The newest of everything, for whoever shows it.

use super::hint;
use super::protocol::Protocol;
use posewire::endpoint::Endpoint;
use posewire::queue::Policy;
use posewire::stats::Statistics;
use posewire::stop::Stop;
use posewire::{Item, Notice, Result, Sink, SourceId};
use posewire_motion::Frame;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The newest of everything that a stream brought. Clones are the same board.
#[derive(Clone)]
pub(super) struct Board {
    endpoint: Arc<Endpoint>,
    listening: Arc<str>,
    is_played: bool,
    newest: Arc<Mutex<Newest>>,
    /// The samples of all boards that are shown together.
    counted: Arc<AtomicU64>,
    count: Option<u64>,
    stop: Stop,
}

#[derive(Default)]
struct Newest {
    /// Of each character, and when it arrived.
    frames: BTreeMap<u32, (Arc<Frame>, Instant)>,
    statistics: Option<Arc<Statistics>>,
    /// The newest word about the connection.
    notice: Option<Notice>,
    /// What the source has remarked, without repetitions, the newest last.
    remarks: Vec<Arc<str>>,
    samples: u64,
    /// Whether the file that is played ended before its end.
    is_damaged: bool,
}

impl Newest {
    fn remark(&mut self, text: &str) {
        self.remarks.retain(|known| **known != *text);
        self.remarks.push(text.into());
        if self.remarks.len() > MOST_REMARKS {
            self.remarks.remove(0);
        }
    }
}

impl Board {
    /// A board that sets `stop` after `count` samples.
    pub(super) fn new(endpoint: &Endpoint, count: Option<u64>, stop: Stop) -> Self {
        Self {
            endpoint: Arc::new(endpoint.clone()),
            listening: endpoint.to_string().into(),
            is_played: false,
            newest: Arc::default(),
            counted: Arc::default(),
            count,
            stop,
        }
    }

    /// The same board for a source of a file that is played.
    pub(super) fn playing(self, file: &Endpoint) -> Self {
        Self {
            listening: format!("{file}, {}", self.listening).into(),
            is_played: true,
            ..self
        }
    }

    /// The same board, one of several whose samples are counted together: `place` of `count`, from 0.
    pub(super) fn beside(self, first: &Self, place: usize, count: usize) -> Self {
        Self {
            listening: format!("{}, source {} of {count}", self.listening, place + 1).into(),
            counted: Arc::clone(&first.counted),
            ..self
        }
    }

    /// The same board, which a browser shows there too.
    pub(super) fn shown_at(self, url: &str) -> Self {
        Self {
            listening: format!("{}, page {url}", self.listening).into(),
            ..self
        }
    }

    /// The end that a session feeds: the board of each of its sources.
    pub(super) fn sink(boards: &[Self]) -> impl Sink + use<> {
        BoardSink(boards.to_vec())
    }

    pub(super) fn listening(&self) -> &str {
        &self.listening
    }

    pub(super) fn protocol(&self) -> Protocol {
        Protocol::of(&self.endpoint)
    }

    /// What to say when it begins.
    pub(super) fn opening(&self) -> String {
        if self.is_played {
            return format!("playing {}", self.listening);
        }
        hint::opening(&self.endpoint)
    }

    pub(super) fn statistics(&self) -> Option<Arc<Statistics>> {
        self.lock().statistics.clone()
    }

    /// The newest sample of each character, and how long ago it arrived.
    pub(super) fn frames(&self) -> Vec<(Arc<Frame>, Duration)> {
        let newest = self.lock();
        let frames = newest.frames.values();
        frames
            .map(|(frame, arrived)| (Arc::clone(frame), arrived.elapsed()))
            .collect()
    }

    /// Whether the file that is played ended before its end.
    pub(super) fn is_damaged(&self) -> bool {
        self.lock().is_damaged
    }

    pub(super) fn notice(&self) -> Option<Notice> {
        self.lock().notice.clone()
    }

    /// The newest remarks about the source.
    pub(super) fn remarks(&self) -> Vec<Arc<str>> {
        self.lock().remarks.clone()
    }

    /// How much has come that could be read, in no particular unit: what grows is heard. A server that answers and sends
    /// nothing of a subject is not heard.
    pub(super) fn heard(&self) -> u64 {
        let newest = self.lock();
        if self.protocol() == Protocol::NatNet {
            return newest.samples;
        }
        let statistics = newest.statistics.as_ref();
        newest.samples + statistics.map_or(0, |all| all.datagrams.saturating_sub(all.malformed))
    }

    /// What to check when nothing comes that can be read.
    pub(super) fn hint(&self) -> String {
        hint::of(&self.endpoint, self.heard() > 0, self.statistics().as_deref())
    }

    fn lock(&self) -> MutexGuard<'_, Newest> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A board for each source, in their order.
struct BoardSink(Vec<Board>);

impl Sink for BoardSink {
    /// Only the newest matters; but samples are counted, so none is to be lost in a burst.
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, QUEUED_ITEMS)
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        let Some(board) = self.0.get(usize::from(source.0)) else {
            return Ok(());
        };
        let mut newest = board.lock();
        match item {
            Item::Frame { frame, .. } => {
                newest
                    .frames
                    .insert(frame.subject.id, (Arc::clone(frame), item.arrived()));
                newest.samples += 1;
                let counted = board.counted.fetch_add(1, Ordering::Relaxed) + 1;
                if board.count.is_some_and(|count| counted >= count) {
                    board.stop.stop();
                }
            }
            Item::Statistics(statistics) => newest.statistics = Some(Arc::clone(statistics)),
            Item::Notice(Notice::Remark { text }) => newest.remark(text),
            Item::Notice(notice) => {
                newest.is_damaged |= matches!(notice, Notice::Damaged { .. });
                newest.notice = Some(notice.clone());
            }
            _ => {}
        }
        Ok(())
    }

    /// Nothing more will come: whoever shows the board is to end.
    fn finish(&mut self) -> Result<()> {
        self.0.iter().for_each(|board| board.stop.stop());
        Ok(())
    }
}

/// Four seconds of 16 people at 240 Hz.
pub(super) const QUEUED_ITEMS: usize = 16_384;

const MOST_REMARKS: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn what_cannot_be_read_is_told_from_what_does_not_come() {
        let board = Board::new(&"mxtp://127.0.0.1:9763".parse().unwrap(), None, Stop::new());
        let mut sink = Board::sink(std::slice::from_ref(&board));
        assert!(
            board
                .hint()
                .starts_with("nothing has come to mxtp://127.0.0.1:9763 yet")
        );
        let mut statistics = Statistics {
            elapsed: Duration::from_secs(3),
            datagrams: 5,
            bytes: 50,
            malformed: 5,
            last_malformed: Some("found \x1b[2J".to_owned()),
            ..Statistics::default()
        };
        sink.accept(SourceId(0), &Item::Statistics(Arc::new(statistics.clone())))
            .unwrap();
        assert_eq!(board.heard(), 0);
        let hint = board.hint();
        assert!(
            hint.contains("5 datagrams, none MXTP; the last: found \\u{1b}[2J"),
            "{hint}"
        );
        statistics.datagrams = 7;
        sink.accept(SourceId(0), &Item::Statistics(Arc::new(statistics)))
            .unwrap();
        assert_eq!(board.heard(), 2);
        assert!(board.hint().starts_with("nothing more comes"));
    }
}
