//! The newest sample of each subject.

use crate::frame::Frame;
use posewire::SourceId;
use std::collections::BTreeMap;
use std::time::Instant;

/// The newest sample of each subject, and which of them is the newest of all.
///
/// Of one subject it is the one that was put in last, and between subjects the one that arrived last.
#[derive(Default)]
pub(super) struct Newest {
    frames: BTreeMap<Of, Frame>,
    last: Option<Of>,
}

/// A subject: its source, and its number there.
type Of = (SourceId, u32);

impl Newest {
    pub(super) fn put(&mut self, source: SourceId, frame: &Frame) {
        let of = (source, frame.frame.subject.id);
        let last = self.last.and_then(|last| self.frames.get(&last));
        if last.is_none_or(|last| arrived(last) <= arrived(frame)) {
            self.last = Some(of);
        }
        self.frames.insert(of, frame.clone());
        if self.frames.len() > MOST {
            self.forget_oldest();
        }
    }

    /// The newest of all.
    pub(super) fn of_all(&self) -> Option<&Frame> {
        self.frames.get(self.last.as_ref()?)
    }

    /// The newest of the subjects with this name.
    pub(super) fn of(&self, subject: &str) -> Option<&Frame> {
        let of_name = |frame: &&Frame| frame.frame.subject.name == subject;
        self.frames.values().filter(of_name).max_by_key(|frame| arrived(frame))
    }

    /// The names of the subjects.
    pub(super) fn subjects(&self) -> impl Iterator<Item = &str> {
        self.frames.values().map(|frame| frame.frame.subject.name.as_str())
    }

    fn forget_oldest(&mut self) {
        let oldest = self.frames.iter().min_by_key(|(_, frame)| arrived(frame));
        if let Some(of) = oldest.map(|(of, _)| *of) {
            self.frames.remove(&of);
        }
    }
}

fn arrived(frame: &Frame) -> Option<Instant> {
    frame.arrival.map(|arrival| arrival.at)
}

/// More than any sender has; whoever makes up ever new ones does not fill the memory.
const MOST: usize = 4096;
