//! A stream printed as text or JSON.

use super::board::QUEUED_ITEMS;
use crate::context::say;
use crate::{json, render};
use posewire::queue::Policy;
use posewire::stats::Statistics;
use posewire::{Error, Item, Result, Sink};
use posewire_motion::Frame;
use std::io::{BufWriter, Stdout, Write};

/// How a stream is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::command) enum Format {
    /// A table each second.
    Plain,
    /// JSON: the statistics each second and, with `frames`, every sample.
    Json { frames: bool },
}

/// Prints a stream to the standard output.
pub(super) struct Printer {
    format: Format,
    /// How many samples are still to be printed; `None` is all that come.
    left: Option<u64>,
    out: BufWriter<Stdout>,
}

impl Printer {
    pub(super) fn new(format: Format, count: Option<u64>) -> Self {
        Self {
            format,
            left: count,
            out: BufWriter::new(std::io::stdout()),
        }
    }

    fn frame(&mut self, frame: &Frame) -> Result<()> {
        if self.format != (Format::Json { frames: true }) || self.left == Some(0) {
            return Ok(());
        }
        self.left = self.left.map(|left| left - 1);
        json::write(&mut self.out, &json::FrameRecord::new(frame))?;
        // Who reads the samples as they come wants each one now.
        self.flush()
    }

    fn statistics(&mut self, statistics: &Statistics) -> Result<()> {
        match self.format {
            Format::Plain => write_plain(&mut self.out, statistics)?,
            Format::Json { .. } => {
                json::write(&mut self.out, &json::ReceiverRecord::new(statistics))?;
                if let Some(server) = json::ServerRecord::new(statistics) {
                    json::write(&mut self.out, &server)?;
                }
                json::statistics(statistics).try_for_each(|object| json::write(&mut self.out, &object))?;
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

    fn accept(&mut self, item: &Item) -> Result<()> {
        match item {
            Item::Frame { frame, .. } => self.frame(frame),
            Item::Subject(subject) if self.format == (Format::Json { frames: true }) => {
                json::write(&mut self.out, &json::SubjectRecord::new(subject))
            }
            Item::Statistics(statistics) => self.statistics(statistics),
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

/// Prints the table of a stream.
pub(super) fn print_plain(statistics: &Statistics) -> Result<()> {
    write_plain(&mut std::io::stdout().lock(), statistics)
}

fn write_plain(out: &mut impl Write, statistics: &Statistics) -> Result<()> {
    writeln!(out, "{}", render::statistics(statistics)).map_err(|error| broken(&error))
}

fn broken(error: &std::io::Error) -> Error {
    Error::write("the standard output", error)
}
