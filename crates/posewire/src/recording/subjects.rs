//! The subjects of a recording: what they are called, described as, and which channels their poses have.

use super::description::describe;
use super::format::{self, keys};
use super::names::{Names, SubjectId};
use super::part::{Message, Part};
use super::poses;
use crate::{Result, SourceId, clock};
use posewire_motion::{Frame, Stamp, Subject};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// The subjects that were heard of, in all files of a recording.
#[derive(Debug, Default)]
pub(super) struct Subjects {
    known: BTreeMap<SubjectId, Known>,
    names: Names,
    /// Bytes of descriptions in the present file.
    described: usize,
    left_out: u64,
    message: Vec<u8>,
    /// Samples that wait for the names of their subjects.
    waiting: usize,
}

/// A subject that was heard of.
#[derive(Debug)]
struct Known {
    subject: Arc<Subject>,
    /// What it is called, and its segments' frame ids; absent when there are too many names.
    named: Option<Named>,
    /// How often it was described in the present file.
    told: u32,
    /// Samples from before it had a name, if it has none yet.
    waiting: Vec<(Stamp, Frame)>,
    /// Whether it has none although it was waited for.
    is_nameless: bool,
}

#[derive(Debug)]
struct Named {
    name: String,
    frames: Vec<String>,
    channel: Option<u16>,
}

impl Subjects {
    /// Subjects that are known; more are counted and have no poses.
    pub(super) const MOST: usize = 16_384;

    /// Descriptions that were not written.
    pub(super) fn left_out(&self) -> u64 {
        self.left_out
    }

    /// Samples of a subject that wait for its name.
    pub(super) fn held(&self, id: SubjectId) -> u64 {
        self.known.get(&id).map_or(0, |known| known.waiting.len() as u64)
    }

    /// Describes a subject, if that is news, and writes the poses that have waited for its name. Gives how many samples it wrote.
    pub(super) fn note(&mut self, part: &mut Part, source: SourceId, subject: &Arc<Subject>) -> Result<u64> {
        let id = (source, subject.id);
        let known = self.known.get(&id).map(|known| &known.subject);
        if known.is_some_and(|known| Arc::ptr_eq(known, subject) || known == subject) {
            return Ok(0);
        }
        if self.known.len() >= Self::MOST && !self.known.contains_key(&id) {
            self.left_out += 1;
            return Ok(0);
        }
        let name = self.names.name(id, subject);
        let named = name.map(|name| Named::new(name, subject));
        let known = self.known.entry(id).or_insert_with(|| Known::new(subject));
        (known.subject, known.named) = (Arc::clone(subject), named);
        self.tell(part, id)?;
        if is_nameless(subject) {
            Ok(0)
        } else {
            self.release_one(part, id)
        }
    }

    /// Writes the poses of a subject that was noted, or lets them wait for its name. Gives how many samples it wrote: none when the
    /// subject has no poses in the file.
    pub(super) fn poses(&mut self, part: &mut Part, source: SourceId, frame: &Frame) -> Result<u64> {
        let id = (source, frame.subject.id);
        let at = frame.received.unwrap_or_else(clock::now);
        if self.lets_wait(id, at, frame) {
            return Ok(0);
        }
        let waited = self.release_one(part, id)?;
        Ok(waited + u64::from(self.write(part, id, at, frame)?))
    }

    /// Writes all poses that wait. Gives how many samples that were.
    pub(super) fn release(&mut self, part: &mut Part) -> Result<u64> {
        let waiting = self.known.iter().filter(|(_, known)| !known.waiting.is_empty());
        let ids: Vec<_> = waiting.map(|(id, _)| *id).collect();
        let mut written = 0;
        for id in ids {
            written += self.release_one(part, id)?;
        }
        Ok(written)
    }

    /// Keeps a sample whose subject has no name yet, as when the stream ran before it was recorded. MVN says the names once a second.
    fn lets_wait(&mut self, id: SubjectId, at: Stamp, frame: &Frame) -> bool {
        let Some(known) = self.known.get_mut(&id).filter(|known| !known.is_nameless) else {
            return false;
        };
        let since = known.waiting.first().map_or(at, |(first, _)| *first);
        let is_long = at.since(since) >= LONGEST_WAIT || self.waiting >= MOST_WAITING;
        if is_long || known.named.is_none() || !is_nameless(&frame.subject) {
            known.is_nameless = is_long;
            return false;
        }
        known.waiting.push((at, frame.clone()));
        self.waiting += 1;
        true
    }

    fn release_one(&mut self, part: &mut Part, id: SubjectId) -> Result<u64> {
        let waiting = self.known.get_mut(&id).map(|known| std::mem::take(&mut known.waiting));
        let mut written = 0;
        for (at, frame) in waiting.unwrap_or_default() {
            self.waiting -= 1;
            written += u64::from(self.write(part, id, at, &frame)?);
        }
        Ok(written)
    }

    /// Writes a sample; `false` when its subject has no poses in the file.
    fn write(&mut self, part: &mut Part, id: SubjectId, at: Stamp, frame: &Frame) -> Result<bool> {
        let Some(Known {
            subject,
            named: Some(named),
            ..
        }) = self.known.get_mut(&id)
        else {
            return Ok(false);
        };
        poses::encode(frame, &named.frames, at, &mut self.message);
        let channel = named.channel(part, id, subject)?;
        part.message(Message {
            channel,
            sequence: frame.sample,
            at,
            data: &self.message,
        })?;
        Ok(true)
    }

    /// Describes all of them again, at the beginning of another file.
    pub(super) fn tell_all(&mut self, part: &mut Part) -> Result<()> {
        self.described = 0;
        for known in self.known.values_mut() {
            known.told = 0;
            if let Some(named) = &mut known.named {
                named.channel = None;
            }
        }
        let ids: Vec<_> = self.known.keys().copied().collect();
        ids.into_iter().try_for_each(|id| self.tell(part, id))
    }

    /// Writes the description of a subject, or counts it when there are too many.
    fn tell(&mut self, part: &mut Part, id: SubjectId) -> Result<()> {
        let Some(Known {
            subject, named, told, ..
        }) = self.known.get_mut(&id)
        else {
            return Ok(());
        };
        if *told >= MOST_TOLD || self.described >= MOST_DESCRIBED {
            self.left_out += 1;
            return Ok(());
        }
        *told += 1;
        let description = describe(subject);
        self.described += description.len();
        let frame = named.as_ref().map_or_else(String::new, |named| named.name.clone());
        let record = [
            (format::SOURCE, id.0.0.to_string()),
            (format::SUBJECT, id.1.to_string()),
            (format::NAME, subject.name.clone()),
            ("frame", frame),
            ("description", description),
        ];
        part.metadata(format::SUBJECT_RECORD, keys(record))
    }
}

impl Known {
    fn new(subject: &Arc<Subject>) -> Self {
        Self {
            subject: Arc::clone(subject),
            named: None,
            told: 0,
            waiting: Vec::new(),
            is_nameless: false,
        }
    }
}

impl Named {
    fn new(name: String, subject: &Subject) -> Self {
        let segments = subject.skeleton.segments.iter();
        Self {
            frames: segments.map(|segment| format!("{name}/{}", segment.name)).collect(),
            name,
            channel: None,
        }
    }

    fn channel(&mut self, part: &mut Part, id: SubjectId, subject: &Subject) -> Result<u16> {
        if let Some(channel) = self.channel {
            return Ok(channel);
        }
        let keys = keys([
            (format::KIND, format::POSES.to_owned()),
            (format::SOURCE, id.0.0.to_string()),
            (format::SUBJECT, id.1.to_string()),
            (format::NAME, subject.name.clone()),
        ]);
        let channel = part.pose_channel(&format!("/{}/{}/tf", id.0.0, self.name), &keys)?;
        self.channel = Some(channel);
        Ok(channel)
    }
}

fn is_nameless(subject: &Subject) -> bool {
    subject.name.trim().is_empty()
}

/// For how long of a stream the name of a subject is waited for.
const LONGEST_WAIT: Duration = Duration::from_millis(1500);
/// Samples that wait, of all subjects: more than 16 people give in that time.
const MOST_WAITING: usize = 8192;
/// Descriptions of one subject in one file: a performer is measured anew a few times a day.
const MOST_TOLD: u32 = 256;
/// Bytes of all descriptions in one file, beyond which there are no more.
const MOST_DESCRIBED: usize = 64 << 20;
