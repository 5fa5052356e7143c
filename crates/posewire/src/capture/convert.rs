//! Captures from one kind of file to another.

use super::survey::holds_poses;
use super::{Capture, CaptureOptions, Captured, Counts, Format, PcapWriter, Survey};
use crate::beside::{beside, give_name, is_same_file};
use crate::recording::{Writer, WriterOptions};
use crate::stop::Stop;
use crate::{Error, Result, SourceId};
use std::path::Path;
use std::sync::Arc;

/// What became of a capture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Converted {
    /// Datagrams that were written.
    pub datagrams: u64,
    /// What of the capture was read, and what could not be.
    pub counts: Counts,
    /// What ended the capture before its end, if something did.
    pub damage: Option<String>,
}

/// What of a capture is converted, and how.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ConvertOptions {
    /// Only this source, by its number or a part of its name.
    pub only: Option<String>,
    /// Whether a file that is there is replaced.
    pub overwrite: bool,
}

/// Writes every datagram of a capture, with its time, to a file of the kind that its name says: `.mcap`, `.pcap`, or else pcapng.
///
/// A recording that was split becomes one file. A recording gets the raw datagrams alone; poses come into one when a capture is played to a
/// [`RecordSink`](crate::sink::RecordSink). Which source a datagram is of is kept between recordings; otherwise it follows from its
/// addresses. The file has a hidden name until it is whole.
///
/// # Errors
/// Those of [`Survey::of`], of [`Survey::choose`] and of the writer; [`Error::OntoItself`] when the file is one of those that are
/// read, [`Error::Exists`] when it is there and is not to be overwritten, and [`Error::Stopped`] after `stop`. None of them leaves
/// a file, nor takes one away.
pub fn convert(from: &Path, to: &Path, options: &ConvertOptions, stop: &Stop) -> Result<Converted> {
    let mut capture = Capture::open(from, &CaptureOptions::default())?;
    if capture.files().iter().any(|file| is_same_file(file, to)) {
        return Err(Error::OntoItself { path: to.to_owned() });
    }
    if !options.overwrite && to.exists() {
        return Err(Error::Exists { path: to.to_owned() });
    }
    let chosen = chosen(from, options.only.as_deref())?;
    let hidden = beside(to).map_err(|error| Error::write(to.display().to_string(), &error))?;
    let mut output = Output::create(from, to, hidden.path())?;
    let mut datagrams = 0;
    for captured in capture.by_ref() {
        if stop.is_stopped() {
            let what = "a capture was converted".to_owned();
            return Err(Error::Stopped { what });
        }
        let captured = captured?;
        if chosen.is_none_or(|chosen| chosen == captured.source) {
            output.write(captured)?;
            datagrams += 1;
        }
    }
    if datagrams == 0 && capture.format() == Format::Mcap && holds_poses(capture.files())? {
        let path = from.to_owned();
        return Err(Error::PosesAlone { path });
    }
    output.finish()?;
    give_name(hidden, to, options.overwrite)?;
    Ok(Converted {
        datagrams,
        counts: capture.counts(),
        damage: capture.damage().map(str::to_owned),
    })
}

/// The number of the source that is named, if one is.
fn chosen(path: &Path, only: Option<&str>) -> Result<Option<u16>> {
    let Some(only) = only else { return Ok(None) };
    let survey = Survey::of(path, &CaptureOptions::default())?;
    survey.choose(path, Some(only)).map(|source| Some(source.number))
}

/// The file that is written.
enum Output {
    Packets(PcapWriter),
    Recording(Box<Writer>),
}

impl Output {
    /// Over the `hidden` file, which is to be called `to`.
    fn create(from: &Path, to: &Path, hidden: &Path) -> Result<Self> {
        let is_recording = to.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"));
        if !is_recording {
            return PcapWriter::create(hidden, true).map(Self::Packets);
        }
        // A recording names its sources at the beginning.
        let survey = Survey::of(from, &CaptureOptions::default())?;
        let names: Vec<_> = survey.sources.into_iter().map(|source| source.name).collect();
        let options = WriterOptions {
            overwrite: true,
            ..WriterOptions::default()
        };
        let writer = Writer::create(hidden, &names, options)?;
        Ok(Self::Recording(Box::new(writer)))
    }

    fn write(&mut self, captured: Captured) -> Result<()> {
        match self {
            Self::Packets(writer) => writer.write(&captured.datagram),
            Self::Recording(writer) => writer.datagram(SourceId(captured.source), &Arc::new(captured.datagram)),
        }
    }

    fn finish(self) -> Result<()> {
        match self {
            Self::Packets(writer) => writer.finish(),
            Self::Recording(writer) => writer.finish(),
        }
    }
}
