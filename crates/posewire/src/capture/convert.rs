//! Captures from one kind of file to another.

use super::{Capture, CaptureOptions, Counts, PcapWriter};
use crate::Result;
use std::path::Path;

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

/// Writes every datagram of a capture, with its time, to a file of the kind that its name says.
///
/// # Errors
/// Those of [`Capture::open`] and of the writer.
pub fn convert(from: &Path, to: &Path, overwrite: bool) -> Result<Converted> {
    let mut capture = Capture::open(from, &CaptureOptions::default())?;
    let mut writer = PcapWriter::create(to, overwrite)?;
    let mut datagrams = 0;
    for captured in capture.by_ref() {
        writer.write(&captured?.datagram)?;
        datagrams += 1;
    }
    writer.finish()?;
    Ok(Converted {
        datagrams,
        counts: capture.counts(),
        damage: capture.damage().map(str::to_owned),
    })
}
