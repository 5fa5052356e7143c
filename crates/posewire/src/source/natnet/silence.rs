//! When a server that answers sends no frames.

use std::time::{Duration, Instant};

use super::sockets::Sockets;
use crate::Error;

/// How long a server that answers has sent no frame, and what may be the reason.
#[derive(Debug, Default)]
pub(super) struct Silence {
    /// Since when it answers, as long as no frame has come.
    since: Option<Instant>,
    /// Since when it answers, or when its last frame came.
    quiet_since: Option<Instant>,
    /// Since when it answers.
    connected: Option<Instant>,
    /// When anything came from it.
    answered: Option<Instant>,
    told: bool,
    /// Whether its data port was listened at.
    pub(super) listened: bool,
    /// What has kept us from that.
    pub(super) taken: Option<Error>,
}

impl Silence {
    /// The server begins to answer.
    pub(super) fn begin() -> Self {
        let since = Some(Instant::now());
        Self {
            since,
            quiet_since: since,
            connected: since,
            answered: since,
            ..Self::default()
        }
    }

    /// Something has come from the server.
    pub(super) fn note_answer(&mut self) {
        self.answered = Some(Instant::now());
    }

    /// People know already why no frame comes.
    pub(super) fn note_explained(&mut self) {
        self.told = true;
    }

    /// A frame has come.
    pub(super) fn broken(&mut self) {
        self.since = None;
        self.quiet_since = self.quiet_since.map(|_| Instant::now());
        self.told = false;
    }

    /// Whether it has answered for so long.
    pub(super) fn answers_for(&self, time: Duration) -> bool {
        self.connected.is_some_and(|since| since.elapsed() >= time)
    }

    /// Whether not one frame has come for so long.
    pub(super) fn lasts(&self, time: Duration) -> bool {
        self.since.is_some_and(|since| since.elapsed() >= time)
    }

    /// Whether people are to be told, once of each silence.
    pub(super) fn is_to_be_told(&mut self) -> bool {
        let long = self.quiet_since.is_some_and(|since| since.elapsed() >= REMARK_AFTER);
        // A server that is gone is told of when it is lost.
        let answers = self
            .answered
            .is_some_and(|answered| answered.elapsed() < ANSWERS_WITHIN);
        long && answers && !std::mem::replace(&mut self.told, true)
    }

    /// What to tell them.
    pub(super) fn text(&self, sockets: &Sockets) -> String {
        match (self.since, sockets.joined(), &self.taken) {
            (None, ..) => "the server answers, but no more frames come: is it paused?".to_owned(),
            (_, Some((group, on)), _) => format!(
                "the server answers, but no frames come to {group} on {on}: is it streaming? Multicast may need \
                 interface=NAME, and is often held back by Wi-Fi and switches"
            ),
            (_, None, Some(error)) => format!(
                "the server answers, but no frames come: is it streaming? It may send them to its data port, but: {error}"
            ),
            (_, None, None) => "the server answers, but no frames come: is it streaming?".to_owned(),
        }
    }
}

/// How long nothing may come before people are told.
pub(super) const REMARK_AFTER: Duration = Duration::from_secs(3);
/// A server is asked something at least once a second.
const ANSWERS_WITHIN: Duration = Duration::from_millis(1500);
