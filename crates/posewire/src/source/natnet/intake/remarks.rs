//! What people should know of a server, said once each.

use super::Intake;
use crate::Notice;
use crate::source::natnet::advice;
use crate::source::natnet::silence::REMARK_AFTER;
use crate::source::natnet::sockets::Sockets;
use posewire_natnet::model::Model;
use std::time::Duration;

/// What was last said of each.
#[derive(Debug, Default)]
pub(super) struct Told {
    no_answer: Option<String>,
    version: Option<String>,
    model: Option<String>,
    sets: bool,
}

impl Intake<'_> {
    /// Says what the server describes that is of no use.
    pub(super) fn remark_on_model(&mut self, model: &Model) {
        let text = advice::of_model(model);
        let news = text.and_then(|text| news(&mut self.told.model, text));
        self.remark(news);
    }

    /// Says once that there is nothing to show, and to count, of frames with `only_sets` in them.
    pub(super) fn remark_on_sets(&mut self, only_sets: bool) {
        if only_sets && !std::mem::replace(&mut self.told.sets, true) {
            self.remark(Some(advice::of_marker_sets()));
        }
    }

    pub(super) fn remark_on_silence(&mut self, sockets: &Sockets) {
        if self.silence.is_to_be_told() {
            let text = self.silence.text(sockets);
            self.remark(Some(text));
        }
    }

    /// Says what a server is like that has never answered.
    pub(super) fn remark_on_no_answer(&mut self) {
        if !self.tally.is_nameless() || self.begun.elapsed() < REMARK_AFTER {
            return;
        }
        let counts = self.client.counts();
        let text = match (self.client.version(), counts.early, counts.received) {
            (None, 1.., _) => advice::of_unread_frames(),
            (_, 0, 0) => advice::of_nobody(self.server),
            _ => return,
        };
        let news = news(&mut self.told.no_answer, text);
        self.remark(news);
    }

    /// Says that another version comes than was asked for, as soon as that is settled.
    pub(super) fn remark_on_version(&mut self) {
        let is_settled = self.client.server_info().is_some() && self.silence.answers_for(SETTLED_AFTER);
        let sent = self.client.version().filter(|_| is_settled);
        let text = sent.and_then(|sent| advice::of_version(&self.address, sent));
        let news = text.and_then(|text| news(&mut self.told.version, text));
        self.remark(news);
    }

    fn remark(&mut self, text: Option<String>) {
        if let Some(text) = text {
            self.notice(Notice::Remark { text });
        }
    }
}

/// A text that was not the last one said.
fn news(last: &mut Option<String>, text: String) -> Option<String> {
    if last.as_ref() == Some(&text) {
        return None;
    }
    *last = Some(text.clone());
    Some(text)
}

/// How long a server may take to grant a version.
const SETTLED_AFTER: Duration = Duration::from_secs(1);
