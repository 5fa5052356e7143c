//! The poses of a recording, read back as frames.

use super::described::subject_of;
use super::format::{self, Keys};
use super::poses;
use super::records::Records;
use crate::Result;
use mcap::records::Record;
use posewire_motion::{Frame, Stamp, Subject};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// The poses of one source of a recording, in the order in which they were written: positions and orientations, which is all
/// that is in them. Those of subjects that are not described are left out.
pub(crate) struct Posed {
    files: Vec<PathBuf>,
    /// Which of the files is being read.
    place: usize,
    records: Records,
    source: u16,
    /// By their numbers at the source.
    subjects: BTreeMap<u32, Described>,
    /// Whose poses a channel of the present file has.
    channels: BTreeMap<u16, u32>,
    began: Option<Stamp>,
    damage: Option<String>,
}

struct Described {
    subject: Arc<Subject>,
    /// The segments' frame ids.
    names: Vec<String>,
}

impl Posed {
    /// Opens the files of a recording, one after the other.
    pub(crate) fn open(files: &[PathBuf], source: u16) -> Result<Self> {
        let first = files.first().map_or(Path::new(""), PathBuf::as_path);
        Ok(Self {
            files: files.to_vec(),
            place: 0,
            records: Records::open(first)?,
            source,
            subjects: BTreeMap::new(),
            channels: BTreeMap::new(),
            began: None,
            damage: None,
        })
    }

    /// The next sample of a subject; `None` at the end, or where nothing more can be read.
    pub(crate) fn next(&mut self) -> Result<Option<Frame>> {
        loop {
            let mut found = None;
            let Self {
                records,
                subjects,
                channels,
                source,
                ..
            } = self;
            let mut noted = Noted {
                source: *source,
                subjects,
                channels,
            };
            let goes_on = records.next(|record| {
                found = noted.take(&record);
                Ok(())
            })?;
            if let Some((at, mut frame)) = found {
                frame.time = self.time(at, &frame);
                return Ok(Some(frame));
            }
            if !goes_on && !self.begin_next_file()? {
                return Ok(None);
            }
        }
    }

    /// What ended the poses before their end.
    pub(crate) fn damage(&self) -> Option<&str> {
        self.damage.as_deref()
    }

    /// The source's clock, which poses do not tell: by the number of the sample at a rate that is known, else by when they came.
    fn time(&mut self, at: Stamp, frame: &Frame) -> Duration {
        let began = *self.began.get_or_insert(at);
        match frame.subject.rate {
            Some(rate) => Duration::try_from_secs_f64(f64::from(frame.sample) / rate).unwrap_or_default(),
            None => at.since(began),
        }
    }

    fn begin_next_file(&mut self) -> Result<bool> {
        if !self.records.is_complete() {
            let problem = match self.records.damage() {
                Some(problem) if !self.records.is_cut_off() => problem,
                _ => "the recording was cut off",
            };
            self.damage.get_or_insert_with(|| problem.to_owned());
        }
        let Some(next) = self.files.get(self.place + 1) else {
            return Ok(false);
        };
        self.records = Records::open(next)?;
        self.place += 1;
        self.channels.clear();
        Ok(true)
    }
}

/// What records say of subjects.
struct Noted<'a> {
    source: u16,
    subjects: &'a mut BTreeMap<u32, Described>,
    channels: &'a mut BTreeMap<u16, u32>,
}

impl Noted<'_> {
    /// Keeps what a record says of the source's subjects, or gives the sample that it is.
    fn take(&mut self, record: &Record<'_>) -> Option<(Stamp, Frame)> {
        match record {
            Record::Metadata(metadata) if metadata.name == format::SUBJECT_RECORD => {
                self.subject(&metadata.metadata);
                None
            }
            Record::Channel(channel) => {
                let is_poses = channel
                    .metadata
                    .get(format::KIND)
                    .is_some_and(|kind| kind == format::POSES);
                if let Some(id) = self.id(&channel.metadata).filter(|_| is_poses) {
                    self.channels.insert(channel.id, id);
                }
                None
            }
            Record::Message { header, data } => {
                let described = self.subjects.get(self.channels.get(&header.channel_id)?)?;
                let at = Stamp(i64::try_from(header.log_time).unwrap_or(i64::MAX));
                let frame = described.frame(header.sequence, at, data)?;
                Some((at, frame))
            }
            _ => None,
        }
    }

    fn subject(&mut self, keys: &Keys) {
        let subject = keys.get("description").and_then(|text| subject_of(text));
        let (Some(id), Some(mut subject), Some(name)) = (self.id(keys), subject, keys.get("frame")) else {
            return;
        };
        subject.id = id;
        let segments = subject.skeleton.segments.iter();
        let described = Described {
            names: segments.map(|segment| format!("{name}/{}", segment.name)).collect(),
            subject: Arc::new(subject),
        };
        self.subjects.insert(id, described);
    }

    /// The number of a subject of the source that is meant.
    fn id(&self, keys: &Keys) -> Option<u32> {
        let source: u16 = keys.get(format::SOURCE)?.parse().ok()?;
        let id = keys.get(format::SUBJECT)?.parse().ok()?;
        (source == self.source).then_some(id)
    }
}

impl Described {
    fn frame(&self, sample: u32, at: Stamp, message: &[u8]) -> Option<Frame> {
        let mut frame = Frame::new(Arc::clone(&self.subject));
        (frame.sample, frame.received) = (sample, Some(at));
        frame.position = vec![None; self.names.len()];
        frame.orientation = vec![None; self.names.len()];
        let mut segment = 0;
        for (name, pose) in poses::decode(message)? {
            // They are in the order of the segments, without those that were not tracked.
            let ahead = self.names.get(segment..)?.iter().position(|known| known == name);
            let Some(ahead) = ahead else { continue };
            segment += ahead;
            frame.position[segment] = Some(pose.position);
            frame.orientation[segment] = Some(pose.orientation);
            segment += 1;
        }
        Some(frame)
    }
}

impl std::fmt::Debug for Posed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Posed")
            .field("files", &self.files)
            .field("source", &self.source)
            .finish_non_exhaustive()
    }
}
