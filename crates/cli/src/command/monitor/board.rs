//! The newest of everything, for whoever shows it.

use crate::plain::{plural, printable};
use posewire::endpoint::{Endpoint, TcpMode};
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
    /// Whether it is we who connect to the sender.
    connects: bool,
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
    pub(super) fn new(endpoint: &Endpoint, count: Option<u64>, stop: Stop) -> Self {
        Self {
            listening: endpoint.to_string().into(),
            connects: matches!(endpoint, Endpoint::MxtpTcp(address) if address.mode == Some(TcpMode::Connect)),
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

    /// What to say when it begins.
    pub(super) fn opening(&self) -> String {
        let verb = if self.connects { "connecting to" } else { "listening on" };
        format!("{verb} {}", self.listening)
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

    /// How much has come that could be read, in no particular unit: what grows is heard.
    pub(super) fn heard(&self) -> u64 {
        let newest = self.lock();
        let statistics = newest.statistics.as_ref();
        newest.samples + statistics.map_or(0, |all| all.datagrams.saturating_sub(all.malformed))
    }

    /// What to check when nothing comes that can be read.
    pub(super) fn hint(&self) -> String {
        let listening = &self.listening;
        if self.heard() > 0 {
            return format!("nothing more comes to {listening}: is the sender paused, or gone?");
        }
        match self.statistics() {
            Some(all) if all.datagrams > 0 || all.skipped_bytes > 0 => unreadable(listening, &all),
            _ if self.connects => format!(
                "nothing has come from {listening} yet. Check that\n\
                 - a streamer listens there, as posewire stream does with ?mode=listen\n\
                 - no firewall keeps us away from that port"
            ),
            _ => format!(
                "nothing has come to {listening} yet. Check that\n\
                 - the sender streams to an address of this machine and to this port\n\
                 - no firewall keeps it away: UDP and TCP have rules of their own\n\
                 - both sides speak the same: mxtp:// is UDP, mxtp+tcp:// is TCP"
            ),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Newest> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What has come and cannot be read, and what to check.
fn unreadable(listening: &str, all: &Statistics) -> String {
    let what = match &all.last_malformed {
        Some(last) => format!(
            "{}, none MXTP; the last: {}",
            plural(all.datagrams, "datagram"),
            printable(last)
        ),
        None => format!("{} without an MXTP datagram in them", plural(all.skipped_bytes, "byte")),
    };
    format!(
        "what comes to {listening} cannot be read: {what}. Check that\n\
         - it is the Network Streamer of MVN that sends to this port\n\
         - no other program, as a broadcast, uses this port"
    )
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn what_cannot_be_read_is_told_from_what_does_not_come() {
        let board = Board::new(&"mxtp://127.0.0.1:9763".parse().unwrap(), None, Stop::new());
        let mut sink = board.sink();
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
        sink.accept(&Item::Statistics(Arc::new(statistics.clone()))).unwrap();
        assert_eq!(board.heard(), 0);
        let hint = board.hint();
        assert!(
            hint.contains("5 datagrams, none MXTP; the last: found \\u{1b}[2J"),
            "{hint}"
        );
        statistics.datagrams = 7;
        sink.accept(&Item::Statistics(Arc::new(statistics))).unwrap();
        assert_eq!(board.heard(), 2);
        assert!(board.hint().starts_with("nothing more comes"));
    }
}
