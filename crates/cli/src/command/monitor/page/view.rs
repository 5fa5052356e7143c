//! What the page shows at one moment, as plain data.

use posewire::histogram::Summary;
use posewire::stats::{DatagramKind, Quirk};
use posewire_motion::{Frame, Subject, Timecode};
use posewire_mxtp::MessageType;
use std::sync::Arc;
use std::time::Duration;

/// What the page shows at one moment.
#[derive(Clone, Debug, Default)]
pub(super) struct View {
    pub(super) listening: String,
    pub(super) elapsed: Duration,
    pub(super) datagrams: u64,
    pub(super) datagrams_per_second: f64,
    pub(super) bytes_per_second: f64,
    /// What went wrong with the stream as a whole.
    pub(super) troubles: Troubles,
    /// The last word of the source, as "connected to ...".
    pub(super) notice: Option<String>,
    /// What to check, when nothing has come for a while.
    pub(super) hint: Option<String>,
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
    pub(super) types: Vec<TypeRow>,
}

/// One datagram type of a character.
#[derive(Clone, Debug)]
pub(super) struct TypeRow {
    pub(super) kind: DatagramKind,
    pub(super) rate_hz: f64,
    pub(super) stride: Option<u32>,
    pub(super) received: u64,
    pub(super) missing: u64,
    pub(super) duplicate: u64,
    pub(super) late: u64,
    pub(super) reset: u64,
    pub(super) incomplete: u64,
    pub(super) malformed: u64,
    pub(super) quirks: Vec<(Quirk, u64)>,
    pub(super) interval: Summary,
}

/// Whether a character still moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Heard of, but no sample of it has come.
    Waiting,
    Live,
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
            Some(_) => State::Live,
        }
    }

    /// The type that comes most often: its rate and stride are the character's.
    pub(super) fn fastest(&self) -> Option<&TypeRow> {
        self.types
            .iter()
            .max_by(|one, other| one.rate_hz.total_cmp(&other.rate_hz))
    }

    pub(super) fn has_type(&self, message_type: MessageType) -> bool {
        self.types.iter().any(|row| row.kind == message_type.into())
    }
}

const STALE_AFTER: Duration = Duration::from_millis(250);
const LOST_AFTER: Duration = Duration::from_secs(2);
