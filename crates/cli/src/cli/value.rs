//! What arguments have for values.

use posewire::capture;
use posewire::endpoint::FileFormat;
use posewire::file::RATES;
use posewire_motion::Section;
use posewire_natnet::Version;
use std::time::Duration;

/// A time from the beginning on, which may be the beginning.
pub(super) fn moment(text: &str) -> Result<Duration, String> {
    let expected = || "expected a number of seconds from 0 on, as in 2.5".to_owned();
    let seconds = text.parse().map_err(|_| expected())?;
    Duration::try_from_secs_f64(seconds).map_err(|_| expected())
}

/// A version of which the layout is known.
pub(super) fn bitstream(text: &str) -> Result<Version, String> {
    let version = text.parse().ok().filter(|version: &Version| version.is_known());
    let [oldest, ..] = Version::LAYOUTS;
    version.ok_or_else(|| format!("expected a version from {oldest} to {}", Version::LATEST))
}

/// The number of a sample, as `inspect` shows it.
pub(super) fn sample(text: &str) -> Result<u32, String> {
    text.parse()
        .map_err(|_| format!("expected the number of a sample, from 0 to {}", u32::MAX))
}

/// A rate to write at.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(rate) if RATES.contains(&rate) => Ok(rate),
        _ => Err("expected a rate from 0.001 Hz and below 1,000,000 Hz, as in 120".to_owned()),
    }
}

/// What is written: takes, or captures with every datagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Take(FileFormat),
    Capture(capture::Format),
}

impl Format {
    /// How the names of files of each format end.
    pub(crate) fn endings() -> impl Iterator<Item = &'static str> {
        let takes = FileFormat::ALL.iter().map(|format| format.ending());
        takes.chain(CAPTURES.map(capture::Format::ending))
    }
}

/// The ending of a format's names, in either case.
pub(super) fn format(text: &str) -> Result<Format, String> {
    let is_named = |known: &capture::Format| text.eq_ignore_ascii_case(known.ending());
    let of_captures = CAPTURES.into_iter().find(is_named).map(Format::Capture);
    let format = of_captures.or_else(|| text.parse().ok().map(Format::Take));
    format.ok_or_else(|| {
        let endings: Vec<_> = Format::endings().collect();
        format!("expected one of {}", endings.join(", "))
    })
}

/// The name of a section, in either case.
pub(super) fn section(text: &str) -> Result<Section, String> {
    text.trim().to_ascii_lowercase().parse().map_err(|_| {
        let names: Vec<_> = Section::ALL.iter().map(|section| section.name()).collect();
        format!("expected the name of a section: {}", names.join(", "))
    })
}

/// What of an input is used: the name of a section, or else a source of a capture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Only {
    Section(Section),
    /// By its number or a part of its name. Which there are, the capture says.
    Source(String),
}

pub(super) fn only(text: &str) -> Result<Only, String> {
    match section(text) {
        Ok(section) => Ok(Only::Section(section)),
        Err(expected) if text.trim().is_empty() => Err(expected),
        Err(_) => Ok(Only::Source(text.trim().to_owned())),
    }
}

pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text
        .parse()
        .map_err(|_| "expected a number of seconds, as in 2.5".to_owned())?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(duration) if !duration.is_zero() => Ok(duration),
        _ => Err("expected more than 0 seconds".to_owned()),
    }
}

const CAPTURES: [capture::Format; 3] = [capture::Format::Mcap, capture::Format::PcapNg, capture::Format::Pcap];
