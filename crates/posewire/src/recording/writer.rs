//! A recording, being written: one file, or several that follow each other.

use super::briefing::Briefing;
use super::description::describe;
use super::format::{self, keys};
use super::names::{Names, SubjectId};
use super::part::{Message, Part};
use super::poses;
use super::reminder::Reminder;
use crate::{Datagram, Error, Result, SourceId, Wire, clock};
use posewire_motion::{Frame, Stamp, Subject};
use std::collections::{BTreeMap, HashMap};
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a recording is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriterOptions {
    /// Begins a new file, `take-002.mcap` after `take.mcap`, as soon as one has about so many bytes.
    pub split: Option<u64>,
    /// Replaces a file that is there. Otherwise that is an error for the first file, and further ones skip its number.
    pub overwrite: bool,
}

/// Writes datagrams and poses into an MCAP file, as `docs/recording.md` describes it.
///
/// ```
/// use posewire::recording::{Survey, Writer, WriterOptions};
/// use posewire::{Datagram, SourceId, Wire};
/// use posewire_motion::Stamp;
/// use std::sync::Arc;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("take.mcap");
/// let mut writer = Writer::create(&path, &["mxtp://0.0.0.0:9763".to_owned()], WriterOptions::default())?;
/// let datagram = Datagram {
///     wire: Wire::MxtpUdp,
///     from: "192.168.1.20:50123".parse()?,
///     to: "0.0.0.0:9763".parse()?,
///     received: Stamp(1_700_000_000_123_456_789),
///     bytes: (*b"MXTP02").into(),
/// };
/// writer.datagram(SourceId(0), &Arc::new(datagram))?;
/// writer.finish()?;
///
/// let survey = Survey::of(&path)?;
/// assert_eq!(survey.sources[0].senders[0].datagrams, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Writer {
    first: PathBuf,
    options: WriterOptions,
    endpoints: Vec<String>,
    started: Stamp,
    part: Option<Part>,
    number: u32,
    /// The file numbers tried, which go on over those that are taken.
    suffix: u32,
    names: Names,
    reminder: Reminder,
    senders: HashMap<Sender, u16>,
    sender_counts: BTreeMap<SourceId, usize>,
    sequences: BTreeMap<SourceId, u32>,
    subjects: BTreeMap<SubjectId, Known>,
    message: Vec<u8>,
    counts: PartCounts,
    finished_bytes: u64,
    descriptions_left_out: u64,
}

type Sender = (SourceId, Wire, SocketAddr, SocketAddr);

/// A subject that was heard of.
struct Known {
    subject: Arc<Subject>,
    /// What it is called, and its segments' frame ids; absent when there are too many names.
    named: Option<Named>,
    /// How often it was described in the present file.
    told: u32,
}

struct Named {
    name: String,
    frames: Vec<String>,
    channel: Option<u16>,
}

/// What is in the present file.
#[derive(Clone, Copy, Debug, Default)]
struct PartCounts {
    datagrams: u64,
    frames: u64,
    bytes: u64,
    /// Bytes of subjects' descriptions.
    descriptions: usize,
}

impl Writer {
    /// Subjects that are known; more, as only a broken sender has, are counted and have no poses in the file.
    pub const MOST_SUBJECTS: usize = 16_384;

    /// Creates the first file. `endpoints` are those of the sources, in the order of their [`SourceId`]s.
    ///
    /// # Errors
    /// [`Error::Exists`] when the file is there, and [`Error::Write`] when it cannot be created.
    pub fn create(path: &Path, endpoints: &[String], options: WriterOptions) -> Result<Self> {
        let mut writer = Self {
            part: Some(Part::create(path, options.overwrite)?),
            first: path.to_owned(),
            options,
            endpoints: endpoints.to_vec(),
            started: clock::now(),
            number: 1,
            suffix: 1,
            names: Names::default(),
            reminder: Reminder::default(),
            senders: HashMap::new(),
            sender_counts: BTreeMap::new(),
            sequences: BTreeMap::new(),
            subjects: BTreeMap::new(),
            message: Vec::new(),
            counts: PartCounts::default(),
            finished_bytes: 0,
            descriptions_left_out: 0,
        };
        writer.introduce()?;
        Ok(writer)
    }

    /// The file that is written now.
    pub fn path(&self) -> &Path {
        self.part.as_ref().map_or(&self.first, Part::path)
    }

    /// How many files there are.
    pub fn files(&self) -> u32 {
        self.number
    }

    /// The bytes of all files, with what is not in the last one yet.
    pub fn length(&self) -> u64 {
        self.finished_bytes + self.part.as_ref().map_or(0, Part::length)
    }

    /// Descriptions of subjects that were not written, because there were more than any that is not broken sends. The datagrams
    /// that they were read from are in the file all the same.
    pub fn descriptions_left_out(&self) -> u64 {
        self.descriptions_left_out
    }

    /// Writes who is there already, at the beginning of a recording.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram).
    pub(crate) fn brief(&mut self, briefing: &Briefing) -> Result<()> {
        self.reminder = briefing.reminder.clone();
        self.repeat()?;
        for (id, subject) in &briefing.subjects {
            self.subject(id.0, subject)?;
        }
        self.flush()
    }

    /// The present file as it is open, to see it onto the disk from another thread.
    pub(crate) fn handle(&self) -> Option<std::fs::File> {
        self.part.as_ref().and_then(Part::handle)
    }

    /// Writes a datagram as it arrived.
    ///
    /// # Errors
    /// [`Error::Write`]. Nothing more can be written after any error.
    pub fn datagram(&mut self, source: SourceId, datagram: &Arc<Datagram>) -> Result<()> {
        let sequence = self.sequences.entry(source).or_default();
        let number = *sequence;
        *sequence = number.wrapping_add(1);
        self.reminder.note(source, number, datagram);
        self.counts.datagrams += 1;
        self.counts.bytes += datagram.bytes.len() as u64;
        let channel = self.sender(source, datagram)?;
        self.write(|part| {
            part.message(Message {
                channel,
                sequence: number,
                at: datagram.received,
                data: &datagram.bytes,
            })
        })
    }

    /// Writes who a subject is, if that is news, and counts instead what is too much for one file: descriptions of a subject
    /// beyond the 256th, of subjects beyond [`MOST_SUBJECTS`](Self::MOST_SUBJECTS), and those beyond 64 MiB in all.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram).
    pub fn subject(&mut self, source: SourceId, subject: &Arc<Subject>) -> Result<()> {
        let id = (source, subject.id);
        let known = self.subjects.get(&id).map(|known| &known.subject);
        if known.is_some_and(|known| Arc::ptr_eq(known, subject) || known == subject) {
            return Ok(());
        }
        if self.subjects.len() >= Self::MOST_SUBJECTS && !self.subjects.contains_key(&id) {
            self.descriptions_left_out += 1;
            return Ok(());
        }
        let name = self.names.name(id, subject);
        let named = name.map(|name| Named::new(name, subject));
        let told = self.subjects.get(&id).map_or(0, |known| known.told);
        let subject = Arc::clone(subject);
        self.subjects.insert(id, Known { subject, named, told });
        self.tell(id)
    }

    /// Writes a sample's poses. One that does not say when it was received is given the present time.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram).
    pub fn frame(&mut self, source: SourceId, frame: &Frame) -> Result<()> {
        self.subject(source, &frame.subject)?;
        let Self {
            subjects,
            part: Some(part),
            message,
            ..
        } = self
        else {
            return Err(self.is_over());
        };
        let id = (source, frame.subject.id);
        let Some(known) = subjects.get_mut(&id) else {
            return Ok(());
        };
        let Some(named) = &mut known.named else { return Ok(()) };
        let at = frame.received.unwrap_or_else(clock::now);
        poses::encode(frame, &named.frames, at, message);
        let channel = named.channel(part, id, &known.subject)?;
        part.message(Message {
            channel,
            sequence: frame.sample,
            at,
            data: message,
        })?;
        self.counts.frames += 1;
        Ok(())
    }

    /// Hands everything to the system, so that it outlives this program, and begins a new file if this one is long enough.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram), and those of creating a file.
    pub fn flush(&mut self) -> Result<()> {
        self.hand_over()?;
        self.split(0)
    }

    /// Hands everything to the system.
    pub(crate) fn hand_over(&mut self) -> Result<()> {
        self.write(Part::flush)
    }

    /// Begins a new file if this one is long enough. `lost` is for the end of this one, as in [`close`](Self::close).
    pub(crate) fn split(&mut self, lost: u64) -> Result<()> {
        let limit = self.options.split.unwrap_or(u64::MAX);
        if self.part.as_ref().is_none_or(|part| part.length() < limit) {
            return Ok(());
        }
        // A file says that it goes on in another only when there is one.
        let next = self.next_part();
        self.end(lost, next.is_ok())?;
        self.begin(next?)
    }

    /// Completes the file with its index and sees it onto the disk.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram).
    pub fn finish(mut self) -> Result<()> {
        self.close(0)
    }

    /// As [`finish`](Self::finish), and notes how many items were `lost` before they came here.
    pub(crate) fn close(&mut self, lost: u64) -> Result<()> {
        self.end(lost, false)
    }

    /// Completes the file, which may be `continued` in another.
    fn end(&mut self, lost: u64, continued: bool) -> Result<()> {
        let (counts, left_out) = (self.counts, self.descriptions_left_out);
        self.write(|part| {
            let end = [
                ("datagrams", counts.datagrams.to_string()),
                ("frames", counts.frames.to_string()),
                ("bytes", counts.bytes.to_string()),
                ("lost", lost.to_string()),
                ("descriptions_left_out", left_out.to_string()),
                (format::CONTINUED, continued.to_string()),
            ];
            part.metadata(format::END, keys(end))
        })?;
        if let Some(part) = self.part.take() {
            self.finished_bytes += part.finish()?;
        }
        Ok(())
    }

    /// Gives up after a failure: what was flushed stays, and can be read.
    pub(crate) fn abandon(&mut self) {
        if let Some(part) = self.part.take() {
            part.abandon();
        }
    }

    /// Begins the next file.
    fn begin(&mut self, part: Part) -> Result<()> {
        self.part = Some(part);
        self.number += 1;
        self.counts = PartCounts::default();
        self.senders.clear();
        self.sender_counts.clear();
        for known in self.subjects.values_mut() {
            known.told = 0;
            if let Some(named) = &mut known.named {
                named.channel = None;
            }
        }
        self.introduce()?;
        let ids: Vec<_> = self.subjects.keys().copied().collect();
        for id in ids {
            self.tell(id)?;
        }
        self.repeat()
    }

    fn next_part(&mut self) -> Result<Part> {
        loop {
            self.suffix += 1;
            let path = numbered(&self.first, self.suffix);
            match Part::create(&path, self.options.overwrite) {
                Err(Error::Exists { .. }) => {}
                created => return created,
            }
        }
    }

    /// Writes whose recording this is.
    fn introduce(&mut self) -> Result<()> {
        let kernel = cfg!(target_os = "linux");
        let recording = [
            ("format", "1".to_owned()),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("host", host()),
            ("system", format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)),
            ("clock", if kernel { "kernel" } else { "program" }.to_owned()),
            ("started", self.started.nanoseconds().to_string()),
            ("part", self.number.to_string()),
        ];
        let endpoints = self.endpoints.clone();
        self.write(|part| {
            part.metadata(format::RECORDING, keys(recording))?;
            for (source, endpoint) in endpoints.into_iter().enumerate() {
                let source = source.to_string();
                part.metadata(
                    format::SOURCE_RECORD,
                    keys([(format::SOURCE, source), ("endpoint", endpoint)]),
                )?;
            }
            part.flush()
        })
    }

    /// Writes the description of a subject.
    fn tell(&mut self, id: SubjectId) -> Result<()> {
        let Some(Known { subject, named, told }) = self.subjects.get_mut(&id) else {
            return Ok(());
        };
        if *told >= MOST_TOLD || self.counts.descriptions >= MOST_DESCRIBED {
            self.descriptions_left_out += 1;
            return Ok(());
        }
        *told += 1;
        let description = describe(subject);
        self.counts.descriptions += description.len();
        let record = [
            (format::SOURCE, id.0.0.to_string()),
            (format::SUBJECT, id.1.to_string()),
            (format::NAME, subject.name.clone()),
            (
                "frame",
                named.as_ref().map_or_else(String::new, |named| named.name.clone()),
            ),
            ("description", description),
        ];
        self.write(|part| part.metadata(format::SUBJECT_RECORD, keys(record)))
    }

    /// Repeats what earlier files say of those who are in this one.
    fn repeat(&mut self) -> Result<()> {
        let all = self.reminder.all();
        self.write(|part| {
            for (source, said) in all {
                let datagram = &said.datagram;
                let (kind, wire) = (format::REPEATED, datagram.wire);
                let keys = format::raw_keys(kind, source, wire, datagram.from, datagram.to);
                let channel = part.raw_channel(&format::raw_topic(source, kind), wire, &keys)?;
                part.message(Message {
                    channel,
                    sequence: said.sequence,
                    at: datagram.received,
                    data: &datagram.bytes,
                })?;
            }
            part.flush()
        })
    }

    /// The channel of a datagram's sender.
    fn sender(&mut self, source: SourceId, datagram: &Datagram) -> Result<u16> {
        let known = (source, datagram.wire, datagram.from, datagram.to);
        if let Some(channel) = self.senders.get(&known) {
            return Ok(*channel);
        }
        let count = self.sender_counts.entry(source).or_default();
        let is_crowded = *count >= MOST_SENDERS;
        *count += usize::from(!is_crowded);
        let from = if is_crowded { ANYBODY } else { datagram.from };
        let kind = format::RAW;
        let keys = format::raw_keys(kind, source, datagram.wire, from, datagram.to);
        let channel = self.write(|part| part.raw_channel(&format::raw_topic(source, kind), datagram.wire, &keys))?;
        if !is_crowded {
            self.senders.insert(known, channel);
        }
        Ok(channel)
    }

    fn write<T>(&mut self, write: impl FnOnce(&mut Part) -> Result<T>) -> Result<T> {
        match &mut self.part {
            Some(part) => write(part),
            None => Err(self.is_over()),
        }
    }

    /// Only a caller who goes on after an error sees this.
    fn is_over(&self) -> Error {
        let error = std::io::Error::other("the recording has ended");
        Error::write(self.first.display().to_string(), &error)
    }
}

impl std::fmt::Debug for Writer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Writer")
            .field("path", &self.path())
            .finish_non_exhaustive()
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

/// `take-002.mcap` for the second file of `take.mcap`.
fn numbered(first: &Path, number: u32) -> PathBuf {
    let stem = first.file_stem().unwrap_or_default().to_string_lossy();
    let mut name = format!("{stem}-{number:03}");
    if let Some(extension) = first.extension() {
        name = format!("{name}.{}", extension.to_string_lossy());
    }
    first.with_file_name(name)
}

/// What this machine calls itself.
#[cfg(unix)]
fn host() -> String {
    let name = nix::unistd::gethostname().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

#[cfg(not(unix))]
fn host() -> String {
    std::env::var("COMPUTERNAME").unwrap_or_default()
}

/// Descriptions of one subject in one file: a performer is measured anew a few times a day.
const MOST_TOLD: u32 = 256;
/// Bytes of all descriptions in one file, beyond which there are no more.
const MOST_DESCRIBED: usize = 64 << 20;
/// Senders of a source that have channels of their own.
const MOST_SENDERS: usize = 1024;
/// Who the others share their channel under.
const ANYBODY: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::UNSPECIFIED), 0);
