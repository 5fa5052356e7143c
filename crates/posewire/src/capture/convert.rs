//! Captures from one kind of file to another.

use super::{Capture, CaptureOptions, Captured, Counts, PcapWriter, Survey};
use crate::recording::{Writer, WriterOptions};
use crate::{Result, SourceId};
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

/// Writes every datagram of a capture, with its time, to a file of the kind that its name says: `.mcap`, `.pcap`, or else pcapng.
///
/// A recording gets the raw datagrams alone; poses come into one when a capture is played to a
/// [`RecordSink`](crate::sink::RecordSink). Which source a datagram is of is kept between recordings; otherwise it follows from its
/// addresses.
///
/// # Errors
/// Those of [`Survey::of`] and of the writer.
pub fn convert(from: &Path, to: &Path, overwrite: bool) -> Result<Converted> {
    let options = CaptureOptions::default();
    let mut output = Output::create(from, to, overwrite)?;
    let mut capture = Capture::open(from, &options)?;
    let mut datagrams = 0;
    for captured in capture.by_ref() {
        output.write(captured?)?;
        datagrams += 1;
    }
    output.finish()?;
    Ok(Converted {
        datagrams,
        counts: capture.counts(),
        damage: capture.damage().map(str::to_owned),
    })
}

/// The file that is written.
enum Output {
    Packets(PcapWriter),
    Recording(Box<Writer>),
}

impl Output {
    fn create(from: &Path, to: &Path, overwrite: bool) -> Result<Self> {
        let is_recording = to.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"));
        if !is_recording {
            return PcapWriter::create(to, overwrite).map(Self::Packets);
        }
        // A recording names its sources at the beginning.
        let survey = Survey::of(from, &CaptureOptions::default())?;
        let names: Vec<_> = survey.sources.into_iter().map(|source| source.name).collect();
        let options = WriterOptions {
            overwrite,
            ..WriterOptions::default()
        };
        let writer = Writer::create(to, &names, options)?;
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
