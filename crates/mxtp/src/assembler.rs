//! From datagrams as they arrive to the samples of each character.

mod aside;
mod character;
mod counters;
mod events;
mod sample;

use crate::{Datagram, DatagramCounter, Error, Header, MessageType};
use character::Character;
pub use counters::{Counters, QuirkCounts, SampleCounts};
use events::Events;
use posewire_motion::{Frame, Stamp, Subject};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// Puts datagrams together to one [`Frame`] per character and sample, and keeps count of what goes wrong.
///
/// It has no socket and no clock: hand it every datagram with the time of its arrival, then take what follows with
/// [`poll`](Self::poll). UDP and TCP streams are treated alike.
///
/// A sample is complete, and its frame there, with the last of the message types that the character's samples have had
/// of late; what these are shows when a character's second sample begins. When one of them does not come, the frame
/// follows without it: as soon as more than four samples are open, after [`AssemblerOptions::close_after`], or with
/// [`finish`](Self::finish). Frames of a character come in the order of their samples, except for a sample of which
/// nothing had arrived when a newer one was done: that is [`late`](Frame::late).
///
/// A sample that does not fit is put aside. Eight that fit each other begin a session, and their frames come then, in their
/// order; one that nothing follows is counted and gives no frame.
///
/// Memory is bounded whatever arrives: 64 characters, four open samples for each of them with 256 KiB of parts of split
/// messages, 256 KiB put aside for each, and 1024 events that wait to be polled for.
///
/// ```
/// use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Stamp, Subject};
/// use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions};
/// use posewire_mxtp::{Assembler, Event};
/// use std::sync::Arc;
///
/// let mut sent = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
/// sent.position = vec![Some(DVec3::new(0.25, 0.5, 1.0)); 23];
/// sent.orientation = vec![Some(DQuat::IDENTITY); 23];
/// let mut datagrams = Datagrams::new();
/// let mut encoder = Encoder::new(EncoderOptions::default());
/// encoder.encode_subject(&sent.subject, &mut datagrams);
/// encoder.encode_frame(&sent, &mut datagrams);
///
/// let mut assembler = Assembler::new();
/// for bytes in datagrams.iter() {
///     assembler.handle(Stamp(0), bytes);
/// }
/// assembler.finish();
/// let frame = std::iter::from_fn(|| assembler.poll()).find_map(|event| match event {
///     Event::Frame(frame) => Some(frame),
///     _ => None,
/// });
/// let frame = frame.expect("one sample was sent");
/// assert_eq!((frame.subject.name.as_str(), &frame.position), ("Ada", &sent.position));
/// ```
#[derive(Debug)]
pub struct Assembler {
    options: AssemblerOptions,
    characters: Vec<Character>,
    events: Events,
    malformed: BTreeMap<&'static str, u64>,
    refused: u64,
}

/// How an [`Assembler`] works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AssemblerOptions {
    /// How long a sample that a newer one waits for waits for what it lacks, from its first datagram on; 100 ms unless
    /// set. The newest sample, which delays nothing, waits ten times as long.
    pub close_after: Duration,
    /// Whether samples that are complete and wait for an older one are also given at once, as [`Event::Ahead`].
    pub ahead: bool,
}

impl Default for AssemblerOptions {
    fn default() -> Self {
        Self {
            close_after: Duration::from_millis(100),
            ahead: false,
        }
    }
}

/// What follows from the datagrams handled so far.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A sample is done. Its lists have the lengths that its subject's skeleton asks for.
    Frame(Arc<Frame>),
    /// A sample is complete and the newest of its character, while an older one is still waited for: only with
    /// [`AssemblerOptions::ahead`]. It comes in its turn too, as the same `Frame` unless something of it came in between.
    Ahead(Arc<Frame>),
    /// A new character, or a new description of a known one. The frames that follow refer to it.
    Subject(Arc<Subject>),
    /// A whole message has come, duplicates left out: what rates and intervals are measured by.
    Message {
        /// The character's number, from 0.
        character: u8,
        /// What the message carries.
        message_type: MessageType,
        /// The number of its sample; 0 for meta data and scale.
        sample: u32,
    },
    /// A datagram of type 04, 10 or 11, or of a type that the specification does not have.
    Opaque {
        /// The character's number, from 0.
        character: u8,
        /// What the datagram claims to carry.
        message_type: MessageType,
        /// The number of its sample.
        sample: u32,
        /// Which part of a message it is.
        counter: DatagramCounter,
        /// The bytes after the header.
        payload: Vec<u8>,
    },
    /// A datagram that does not decode.
    Malformed {
        /// Its header, where that can be read.
        header: Option<Header>,
        /// What is wrong with it.
        error: Error,
    },
}

impl Assembler {
    /// An assembler with the usual options.
    pub fn new() -> Self {
        Self::with_options(AssemblerOptions::default())
    }

    /// An assembler with other options.
    pub fn with_options(options: AssemblerOptions) -> Self {
        Self {
            options,
            characters: Vec::new(),
            events: Events::default(),
            malformed: BTreeMap::new(),
            refused: 0,
        }
    }

    /// Takes in one datagram, whole and alone, that arrived at `now`.
    pub fn handle(&mut self, now: Stamp, bytes: &[u8]) {
        match Datagram::decode(bytes) {
            Ok(datagram) => {
                if let Some(place) = self.admit(datagram.header.character, now) {
                    self.characters[place].handle(now, bytes, &datagram, &mut self.events);
                    if self.options.ahead {
                        self.characters[place].give_ahead(&mut self.events);
                    }
                }
            }
            Err(error) => self.reject(now, bytes, error),
        }
    }

    /// Closes the samples that have waited for too long. Due when [`timeout`](Self::timeout) says.
    pub fn handle_timeout(&mut self, now: Stamp) {
        for character in &mut self.characters {
            character.handle_timeout(now, self.options.close_after, &mut self.events);
            if self.options.ahead {
                character.give_ahead(&mut self.events);
            }
        }
    }

    /// The next event. Call it until it returns `None`, after every other call that changes the assembler.
    pub fn poll(&mut self) -> Option<Event> {
        self.events.pop()
    }

    /// When [`handle_timeout`](Self::handle_timeout) is next due; `None` while no sample is open.
    pub fn timeout(&self) -> Option<Stamp> {
        let close_after = self.options.close_after;
        let due = self
            .characters
            .iter()
            .filter_map(|character| character.first_due(close_after));
        due.min()
    }

    /// Closes all open samples: the source has ended.
    pub fn finish(&mut self) {
        for character in &mut self.characters {
            character.finish(&mut self.events);
        }
    }

    /// What was counted, by character and message type in ascending order.
    pub fn counters(&self) -> impl Iterator<Item = (u8, MessageType, &Counters)> {
        let mut characters: Vec<_> = self.characters.iter().collect();
        characters.sort_by_key(|character| character.id());
        characters.into_iter().flat_map(Character::counters)
    }

    /// What became of the samples of each character, in ascending order.
    pub fn samples(&self) -> impl Iterator<Item = (u8, SampleCounts)> {
        let characters = self.characters.iter();
        let mut counts: Vec<_> = characters
            .map(|character| (character.id(), character.sample_counts()))
            .collect();
        counts.sort_by_key(|(id, _)| *id);
        counts.into_iter()
    }

    /// The characters of the stream as they are described at present.
    pub fn subjects(&self) -> impl Iterator<Item = &Arc<Subject>> {
        self.characters.iter().map(Character::subject)
    }

    /// Datagrams that did not decode, by what was wrong with them; those whose header could be read are in
    /// [`counters`](Self::counters) as well.
    pub fn malformed(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.malformed.iter().map(|(kind, count)| (*kind, *count))
    }

    /// Datagrams ignored because their character would have been one too many.
    pub const fn refused(&self) -> u64 {
        self.refused
    }

    /// Events lost because nobody polled for them.
    pub const fn events_dropped(&self) -> u64 {
        self.events.dropped()
    }

    /// Bytes held of split messages that are not whole yet, and of samples that may begin a session.
    pub fn buffered(&self) -> usize {
        self.characters.iter().map(Character::buffered).sum()
    }

    /// The place of a character. When there are too many, the one that has been silent longest goes, if it was so for
    /// long; else the new one is refused.
    fn admit(&mut self, id: u8, now: Stamp) -> Option<usize> {
        let known = self.characters.iter().position(|character| character.id() == id);
        if known.is_some() {
            return known;
        }
        if self.characters.len() < MAX_CHARACTERS {
            self.characters.push(Character::new(id));
            return Some(self.characters.len() - 1);
        }
        let place = self.longest_silent(now);
        match place {
            Some(place) => {
                self.characters[place].finish(&mut self.events);
                self.characters[place] = Character::new(id);
            }
            None => self.refused += 1,
        }
        place
    }

    fn longest_silent(&self, now: Stamp) -> Option<usize> {
        let characters = self.characters.iter().enumerate();
        let (place, character) = characters.min_by_key(|(_, character)| character.heard())?;
        (now.since(character.heard()) > FORGET_AFTER).then_some(place)
    }

    #[cold]
    fn reject(&mut self, now: Stamp, bytes: &[u8], error: Error) {
        *self.malformed.entry(counters::kind(&error)).or_default() += 1;
        let header = Header::decode(bytes).ok();
        if let Some(header) = &header
            && let Some(place) = self.admit(header.character, now)
        {
            self.characters[place].note_malformed(now, header.message_type);
        }
        self.events.push(Event::Malformed { header, error });
    }
}

impl Default for Assembler {
    fn default() -> Self {
        Self::new()
    }
}

const MAX_CHARACTERS: usize = 64;
const MAX_OPEN: usize = 4;
const FORGET_AFTER: Duration = Duration::from_secs(10);
