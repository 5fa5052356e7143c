//! Requests in text, one after the other: an answer does not say which request it is for.

use std::collections::VecDeque;
use std::time::Duration;

use posewire_motion::Stamp;

use crate::retry::Retry;

/// Requests that wait for their answers; the first of them is asked.
#[derive(Debug)]
pub(super) struct Requests {
    waiting: VecDeque<Request>,
    retry: Retry,
    tries: u32,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) text: String,
    /// Whether the caller asked, and not the client on its own.
    pub(super) is_callers: bool,
}

/// What is to be done about the first request.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Step {
    Ask(String),
    GiveUp(Request),
}

impl Requests {
    pub(super) fn new(retry: Duration) -> Self {
        Self {
            waiting: VecDeque::new(),
            retry: Retry::new(retry, retry * 4),
            tries: 0,
        }
    }

    /// Puts a request behind the others. False when there are too many.
    pub(super) fn push(&mut self, now: Stamp, text: &str, is_callers: bool) -> bool {
        if self.waiting.len() == MAX_WAITING {
            return false;
        }
        let text = text.to_owned();
        self.waiting.push_back(Request { text, is_callers });
        if self.waiting.len() == 1 {
            self.begin(now);
        }
        true
    }

    /// What is due: call it until it gives nothing.
    pub(super) fn step(&mut self, now: Stamp) -> Option<Step> {
        if !self.retry.is_due(now) {
            return None;
        }
        if self.tries < MAX_TRIES {
            self.tries += 1;
            return self.waiting.front().map(|request| Step::Ask(request.text.clone()));
        }
        self.answered(now).map(Step::GiveUp)
    }

    /// The request that an answer is for.
    pub(super) fn answered(&mut self, now: Stamp) -> Option<Request> {
        if self.tries == 0 {
            return None;
        }
        let request = self.waiting.pop_front();
        self.begin(now);
        request
    }

    /// Forgets the client's own requests; the caller's are asked again.
    pub(super) fn restart(&mut self, now: Stamp) {
        self.waiting.retain(|request| request.is_callers);
        self.begin(now);
    }

    pub(super) const fn next(&self) -> Option<Stamp> {
        self.retry.next()
    }

    fn begin(&mut self, now: Stamp) {
        self.tries = 0;
        if self.waiting.is_empty() {
            self.retry.stop();
        } else {
            self.retry.start(now);
        }
    }
}

const MAX_TRIES: u32 = 3;
const MAX_WAITING: usize = 16;
