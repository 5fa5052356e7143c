//! What the page shows at one moment, as plain data.

use super::super::protocol::Protocol;
use posewire::stats::{SampleCounts, ServerStatistics, StreamStatistics, Tracking, Transit};
use posewire_motion::{Frame, Subject, Timecode};
use posewire_mxtp::MessageType;
use std::sync::Arc;
use std::time::Duration;

/// What the page shows at one moment.
#[derive(Clone, Debug, Default)]
pub(super) struct View {
    pub(super) protocol: Protocol,
    pub(super) listening: String,
    /// What is said until something comes.
    pub(super) opening: String,
    pub(super) elapsed: Duration,
    pub(super) datagrams: u64,
    pub(super) datagrams_per_second: f64,
    pub(super) bytes_per_second: f64,
    /// What went wrong with the stream as a whole.
    pub(super) troubles: Troubles,
    /// The last word of the source about its connection, as "connected to ...".
    pub(super) notice: Option<String>,
    /// What the source has remarked lately.
    pub(super) remarks: Vec<String>,
    /// What to check, when nothing has come for a while.
    pub(super) hint: Option<String>,
    /// The server, for protocols that have one.
    pub(super) server: Option<ServerStatistics>,
    /// By number.
    pub(super) characters: Vec<Character>,
}

/// What went wrong with a stream as a whole.
#[derive(Clone, Debug, Default)]
pub(super) struct Troubles {
    pub(super) kernel_dropped: u64,
    pub(super) malformed: u64,
    pub(super) last_malformed: Option<String>,
    pub(super) skipped_bytes: u64,
    pub(super) characters_refused: u64,
}

/// One character.
#[derive(Clone, Debug)]
pub(super) struct Character {
    pub(super) subject: Arc<Subject>,
    /// Its newest sample.
    pub(super) frame: Option<Arc<Frame>>,
    /// How long ago that was new.
    pub(super) age: Duration,
    pub(super) timecode: Option<Timecode>,
    /// By number.
    pub(super) types: Vec<StreamStatistics>,
    /// What became of its samples, where they are its own.
    pub(super) samples: Option<SampleCounts>,
    /// How long they were on their way, where they are its own.
    pub(super) transit: Option<Transit>,
    /// How much of it is tracked, where the protocol says.
    pub(super) tracking: Option<Tracking>,
}

/// Whether a character still moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Heard of, but no sample of it has come.
    Waiting,
    Live,
    /// It comes, but not all of it is tracked.
    Partial,
    Stale,
    Lost,
}

impl View {
    /// The numbers of the characters, in order.
    pub(super) fn ids(&self) -> Vec<u32> {
        self.characters.iter().map(|character| character.subject.id).collect()
    }

    /// The character with this number, else the first.
    pub(super) fn character(&self, id: Option<u32>) -> Option<&Character> {
        let wanted = |character: &&Character| Some(character.subject.id) == id;
        self.characters.iter().find(wanted).or(self.characters.first())
    }
}

impl Character {
    pub(super) fn state(&self) -> State {
        match &self.frame {
            None => State::Waiting,
            Some(_) if self.age > LOST_AFTER => State::Lost,
            Some(_) if self.age > STALE_AFTER => State::Stale,
            Some(frame) if self.tracking.is_some() => tracked_state(frame),
            Some(_) => State::Live,
        }
    }

    /// Whether it still comes, tracked or not.
    pub(super) fn comes(&self) -> bool {
        self.frame.is_some() && self.age <= STALE_AFTER
    }

    /// How many of its segments are tracked in its newest sample.
    pub(super) fn tracked(&self) -> usize {
        self.frame.as_deref().map_or(0, tracked)
    }

    /// The type that comes most often: its rate and stride are the character's.
    pub(super) fn fastest(&self) -> Option<&StreamStatistics> {
        self.types
            .iter()
            .max_by(|one, other| one.rate_hz.total_cmp(&other.rate_hz))
    }

    pub(super) fn has_type(&self, message_type: MessageType) -> bool {
        self.types.iter().any(|row| row.kind == message_type.into())
    }
}

fn tracked(frame: &Frame) -> usize {
    frame.position.iter().flatten().count()
}

fn tracked_state(frame: &Frame) -> State {
    match tracked(frame) {
        0 => State::Lost,
        some if some < frame.subject.skeleton.segments.len() => State::Partial,
        _ => State::Live,
    }
}

const STALE_AFTER: Duration = Duration::from_millis(250);
const LOST_AFTER: Duration = Duration::from_secs(2);
