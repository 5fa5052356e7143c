//! A recording, being written: one file, or several that follow each other.

use super::briefing::Briefing;
use super::format::{self, keys};
use super::lock::Whereabouts;
use super::part::{Message, Part};
use super::reminder::Reminder;
use super::senders::Senders;
use super::subjects::Subjects;
use crate::{Datagram, Error, Result, SourceId, clock};
use posewire_motion::{Frame, Stamp, Subject};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a recording is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriterOptions {
    /// Begins a new file, `take-002.mcap` after `take.mcap`, before one has more bytes than these. A [`Writer`] looks whenever it is
    /// flushed, a [`RecordSink`](crate::sink::RecordSink) before each item.
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
    reminder: Reminder,
    senders: Senders,
    sequences: BTreeMap<SourceId, u32>,
    subjects: Subjects,
    counts: PartCounts,
    finished_bytes: u64,
    /// How much of the present file repeats earlier ones.
    beginning: u64,
}

/// What is in the present file.
#[derive(Clone, Copy, Debug, Default)]
struct PartCounts {
    datagrams: u64,
    frames: u64,
    bytes: u64,
}

impl Writer {
    /// Subjects that are known; more, as only a broken sender has, are counted and have no poses in the file.
    pub const MOST_SUBJECTS: usize = Subjects::MOST;

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
            reminder: Reminder::default(),
            senders: Senders::default(),
            sequences: BTreeMap::new(),
            subjects: Subjects::default(),
            counts: PartCounts::default(),
            finished_bytes: 0,
            beginning: 0,
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
        self.subjects.left_out()
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
        let (senders, part) = (&mut self.senders, open(&mut self.part, &self.first)?);
        let channel = senders.channel(part, source, datagram)?;
        part.message(Message {
            channel,
            sequence: number,
            at: datagram.received,
            data: &datagram.bytes,
        })
    }

    /// Writes who a subject is, if that is news, and counts instead what is too much for one file: descriptions of a subject
    /// beyond the 256th, of subjects beyond [`MOST_SUBJECTS`](Self::MOST_SUBJECTS), and those beyond 64 MiB in all.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram).
    pub fn subject(&mut self, source: SourceId, subject: &Arc<Subject>) -> Result<()> {
        let part = open(&mut self.part, &self.first)?;
        self.counts.frames += self.subjects.note(part, source, subject)?;
        Ok(())
    }

    /// Writes a sample's poses. One that does not say when it was received is given the present time. Those of a subject that has
    /// no name yet wait for it, but not for longer than 1.5 s of the stream, so that they are on one channel with the rest.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram).
    pub fn frame(&mut self, source: SourceId, frame: &Frame) -> Result<()> {
        let (subjects, part) = (&mut self.subjects, open(&mut self.part, &self.first)?);
        self.counts.frames += subjects.note(part, source, &frame.subject)?;
        self.counts.frames += subjects.poses(part, source, frame)?;
        Ok(())
    }

    /// Hands everything to the system, so that it outlives this program, and begins a new file if this one is long enough.
    ///
    /// # Errors
    /// As for [`datagram`](Self::datagram), and those of creating a file.
    pub fn flush(&mut self) -> Result<()> {
        self.hand_over()?;
        self.split(0).map(drop)
    }

    /// Whether the file stays within its limit with so many more bytes. Where those that it must begin with leave hardly any room
    /// it has some nevertheless.
    pub(crate) fn has_room_for(&self, bytes: u64) -> bool {
        let (Some(limit), Some(part)) = (self.options.split, &self.part) else {
            return true;
        };
        let is_little = part.length().saturating_sub(self.beginning) < limit / 4;
        is_little || part.whole_length() + bytes <= limit
    }

    /// Whether the present file still has its name; `None` after its end.
    pub(crate) fn whereabouts(&self) -> Option<Whereabouts> {
        self.part.as_ref().map(Part::whereabouts)
    }

    /// Samples of a subject whose poses wait for its name.
    pub(crate) fn held(&self, source: SourceId, subject: u32) -> u64 {
        self.subjects.held((source, subject))
    }

    /// Hands everything to the system.
    pub(crate) fn hand_over(&mut self) -> Result<()> {
        self.write(Part::flush)
    }

    /// Begins a new file if this one is long enough, and says whether it was. `lost` is for the end of this one, as in
    /// [`close`](Self::close).
    pub(crate) fn split(&mut self, lost: u64) -> Result<bool> {
        let limit = self.options.split.unwrap_or(u64::MAX);
        if self.part.as_ref().is_none_or(|part| part.whole_length() < limit) {
            return Ok(false);
        }
        self.go_on(lost).map(|()| true)
    }

    /// Begins a new file.
    pub(crate) fn go_on(&mut self, lost: u64) -> Result<()> {
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
        self.release()?;
        self.end(lost, false)
    }

    /// Writes the poses that wait for the names of their subjects.
    pub(crate) fn release(&mut self) -> Result<()> {
        let part = open(&mut self.part, &self.first)?;
        self.counts.frames += self.subjects.release(part)?;
        Ok(())
    }

    /// Completes the file, which may be `continued` in another.
    fn end(&mut self, lost: u64, continued: bool) -> Result<()> {
        let (counts, left_out) = (self.counts, self.subjects.left_out());
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

    /// Gives up after a failure: what was flushed stays, and can be read. Unless the file `is_gone`, in which it is.
    pub(crate) fn abandon(&mut self, is_gone: bool) {
        if let Some(part) = self.part.take() {
            let length = part.abandon();
            self.finished_bytes += if is_gone { 0 } else { length };
        }
    }

    /// Begins the next file.
    fn begin(&mut self, part: Part) -> Result<()> {
        self.part = Some(part);
        self.number += 1;
        self.counts = PartCounts::default();
        self.senders = Senders::default();
        self.introduce()?;
        self.subjects.tell_all(open(&mut self.part, &self.first)?)?;
        self.repeat()?;
        self.beginning = self.part.as_ref().map_or(0, Part::length);
        Ok(())
    }

    fn next_part(&mut self) -> Result<Part> {
        loop {
            self.suffix += 1;
            let path = numbered(&self.first, self.suffix);
            match Part::create(&path, self.options.overwrite) {
                Err(Error::Exists { .. } | Error::BeingRecorded { .. }) => {}
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

    fn write<T>(&mut self, write: impl FnOnce(&mut Part) -> Result<T>) -> Result<T> {
        open(&mut self.part, &self.first).and_then(write)
    }
}

impl std::fmt::Debug for Writer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Writer")
            .field("path", &self.path())
            .finish_non_exhaustive()
    }
}

/// The present file; only a caller who goes on after an error finds that there is none.
fn open<'a>(part: &'a mut Option<Part>, first: &Path) -> Result<&'a mut Part> {
    part.as_mut().ok_or_else(|| {
        let error = std::io::Error::other("the recording has ended");
        Error::write(first.display().to_string(), &error)
    })
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
