//! The subjects of a recording: what they are called, described as, and which channels their poses have.

use super::description::describe;
use super::format::{self, keys};
use super::names::{Names, SubjectId};
use super::part::{Message, Part};
use super::poses;
use crate::{Result, SourceId, clock};
use posewire_motion::{Frame, Subject};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The subjects that were heard of, in all files of a recording.
#[derive(Debug, Default)]
pub(super) struct Subjects {
    known: BTreeMap<SubjectId, Known>,
    names: Names,
    /// Bytes of descriptions in the present file.
    described: usize,
    left_out: u64,
    message: Vec<u8>,
}

/// A subject that was heard of.
#[derive(Debug)]
struct Known {
    subject: Arc<Subject>,
    /// What it is called, and its segments' frame ids; absent when there are too many names.
    named: Option<Named>,
    /// How often it was described in the present file.
    told: u32,
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

    /// Describes a subject, if that is news.
    pub(super) fn note(&mut self, part: &mut Part, source: SourceId, subject: &Arc<Subject>) -> Result<()> {
        let id = (source, subject.id);
        let known = self.known.get(&id).map(|known| &known.subject);
        if known.is_some_and(|known| Arc::ptr_eq(known, subject) || known == subject) {
            return Ok(());
        }
        if self.known.len() >= Self::MOST && !self.known.contains_key(&id) {
            self.left_out += 1;
            return Ok(());
        }
        let name = self.names.name(id, subject);
        let named = name.map(|name| Named::new(name, subject));
        let told = self.known.get(&id).map_or(0, |known| known.told);
        let subject = Arc::clone(subject);
        self.known.insert(id, Known { subject, named, told });
        self.tell(part, id)
    }

    /// Writes the poses of a subject that was noted; `false` when it has none in the file.
    pub(super) fn poses(&mut self, part: &mut Part, source: SourceId, frame: &Frame) -> Result<bool> {
        let id = (source, frame.subject.id);
        let Some(Known {
            subject,
            named: Some(named),
            ..
        }) = self.known.get_mut(&id)
        else {
            return Ok(false);
        };
        let at = frame.received.unwrap_or_else(clock::now);
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
        let Some(Known { subject, named, told }) = self.known.get_mut(&id) else {
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

/// Descriptions of one subject in one file: a performer is measured anew a few times a day.
const MOST_TOLD: u32 = 256;
/// Bytes of all descriptions in one file, beyond which there are no more.
const MOST_DESCRIBED: usize = 64 << 20;
