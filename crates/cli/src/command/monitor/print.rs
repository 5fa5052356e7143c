//! A stream printed as text or JSON.

use super::board::QUEUED_ITEMS;
use crate::context::say;
use crate::plain::printable;
use crate::{json, render};
use posewire::json::{ReceiverRecord, ServerRecord};
use posewire::queue::Policy;
use posewire::stats::Statistics;
use posewire::{Error, Item, Result, Sink, Source, SourceId};
use posewire_motion::Frame;
use serde::Serialize;
use std::io::{BufWriter, Stdout, Write};

/// How a stream is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::command) enum Format {
    /// A table each second.
    Plain,
    /// JSON: the statistics each second and, with `frames`, every sample.
    Json { frames: bool },
}

/// How each of several sources of a capture is told from the others; empty when there is one.
#[derive(Clone, Debug, Default)]
pub(super) struct Names(Vec<(u16, String)>);

impl Names {
    pub(super) fn of(sources: &[Source]) -> Self {
        let captured = sources.iter().filter_map(Source::captured);
        let names: Vec<_> = captured.map(|source| (source.number, source.name.clone())).collect();
        Self(if names.len() > 1 { names } else { Vec::new() })
    }

    /// What stands above the table of a source.
    pub(super) fn heading(&self, source: SourceId) -> Option<String> {
        let (number, name) = self.0.get(usize::from(source.0))?;
        Some(format!("source {number} {}", printable(name)))
    }

    fn number(&self, source: SourceId) -> Option<u16> {
        self.0.get(usize::from(source.0)).map(|(number, _)| *number)
    }
}

/// Prints streams to the standard output.
pub(super) struct Printer {
    format: Format,
    names: Names,
    /// How many samples are still to be printed; `None` is all that come.
    left: Option<u64>,
    out: BufWriter<Stdout>,
}

impl Printer {
    pub(super) fn new(format: Format, count: Option<u64>, names: Names) -> Self {
        Self {
            format,
            names,
            left: count,
            out: BufWriter::new(std::io::stdout()),
        }
    }

    fn write(&mut self, source: SourceId, record: &impl Serialize) -> Result<()> {
        match self.names.number(source) {
            Some(source) => json::write(&mut self.out, &json::OfSource { record, source }),
            None => json::write(&mut self.out, record),
        }
    }

    fn frame(&mut self, source: SourceId, frame: &Frame) -> Result<()> {
        if self.format != (Format::Json { frames: true }) || self.left == Some(0) {
            return Ok(());
        }
        self.left = self.left.map(|left| left - 1);
        self.write(source, &json::FrameRecord::new(frame))?;
        // Who reads the samples as they come wants each one now.
        self.flush()
    }

    fn statistics(&mut self, source: SourceId, statistics: &Statistics) -> Result<()> {
        match self.format {
            Format::Plain => write_plain(&mut self.out, statistics, self.names.heading(source))?,
            Format::Json { .. } => {
                self.write(source, &ReceiverRecord::new(statistics))?;
                if let Some(server) = ServerRecord::new(statistics) {
                    self.write(source, &server)?;
                }
                posewire::json::statistics(statistics).try_for_each(|object| self.write(source, &object))?;
            }
        }
        self.flush()
    }

    fn flush(&mut self) -> Result<()> {
        self.out.flush().map_err(|error| broken(&error))
    }
}

impl Sink for Printer {
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, QUEUED_ITEMS)
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        match item {
            Item::Frame { frame, .. } => self.frame(source, frame),
            Item::Subject(subject) if self.format == (Format::Json { frames: true }) => {
                self.write(source, &json::SubjectRecord::new(subject))
            }
            Item::Statistics(statistics) => self.statistics(source, statistics),
            Item::Notice(notice) => {
                say(notice);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn finish(&mut self) -> Result<()> {
        self.flush()
    }
}

/// Prints the table of a stream, below its heading if it has one.
pub(super) fn print_plain(statistics: &Statistics, heading: Option<String>) -> Result<()> {
    write_plain(&mut std::io::stdout().lock(), statistics, heading)
}

fn write_plain(out: &mut impl Write, statistics: &Statistics, heading: Option<String>) -> Result<()> {
    let heading = heading.map_or_else(String::new, |heading| heading + "\n");
    writeln!(out, "{heading}{}", render::statistics(statistics)).map_err(|error| broken(&error))
}

fn broken(error: &std::io::Error) -> Error {
    Error::write("the standard output", error)
}
