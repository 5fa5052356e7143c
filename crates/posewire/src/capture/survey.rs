//! What a capture holds, from reading it once.

use super::{Capture, CaptureOptions, Captured, Counts, Format, Protocol};
use crate::endpoint::Endpoint;
use crate::recording;
use crate::stop::Stop;
use crate::{Error, Result, Wire};
use posewire_motion::Stamp;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What a capture holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    /// The kind of file.
    pub format: Format,
    /// The files that were read: several of a recording that was split.
    pub files: Vec<PathBuf>,
    /// Its sources, by number. Some may be without a datagram.
    pub sources: Vec<CapturedSource>,
    /// What was read, and what could not be.
    pub counts: Counts,
    /// What ended the capture before its end, if something did.
    pub damage: Option<String>,
}

/// A source of a capture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CapturedSource {
    /// Its number, which [`Captured::source`] gives.
    pub number: u16,
    /// Its endpoint.
    pub name: String,
    /// The protocol of its first datagram; `None` if it has none.
    pub protocol: Option<Protocol>,
    /// How many datagrams, without copies from a file before.
    pub datagrams: u64,
    /// Their payloads together.
    pub bytes: u64,
    /// When the first and the last of them came.
    pub span: Option<(Stamp, Stamp)>,
}

impl Survey {
    /// Reads a capture to its end.
    ///
    /// # Errors
    /// Those of [`Capture::open`], [`Error::Read`] when reading fails later, [`Error::NoDatagrams`] when there is none, and
    /// [`Error::PosesAlone`] when there are poses instead.
    pub fn of(path: &Path, options: &CaptureOptions) -> Result<Self> {
        Self::of_until(path, options, &Stop::new())
    }

    /// The same until `stop` is set.
    pub(crate) fn of_until(path: &Path, options: &CaptureOptions, stop: &Stop) -> Result<Self> {
        let survey = Self::of_any(path, options, stop)?;
        if survey.heard().next().is_some() {
            return Ok(survey);
        }
        let path = path.to_owned();
        if survey.format == Format::Mcap && holds_poses(&survey.files)? {
            return Err(Error::PosesAlone { path });
        }
        Err(Error::NoDatagrams {
            path,
            found: nothing(&survey.counts),
        })
    }

    /// Reads a capture to its end or until `stop` is set, also one without a datagram that posewire speaks.
    ///
    /// # Errors
    /// Those of [`Capture::open`], [`Error::Read`] when reading fails later, [`Error::Stopped`].
    pub fn of_any(path: &Path, options: &CaptureOptions, stop: &Stop) -> Result<Self> {
        let mut capture = Capture::open(path, options)?;
        let mut sources = Vec::new();
        for captured in capture.by_ref() {
            note(&mut sources, &captured?);
            if stop.is_stopped() {
                let what = "a capture was read".to_owned();
                return Err(Error::Stopped { what });
            }
        }
        for (source, name) in sources.iter_mut().zip(capture.sources()) {
            source.name.clone_from(name);
        }
        Ok(Self {
            format: capture.format(),
            files: capture.files().to_vec(),
            sources,
            counts: capture.counts(),
            damage: capture.damage().map(str::to_owned),
        })
    }

    /// When the first datagram of all came and the last.
    pub fn span(&self) -> Option<(Stamp, Stamp)> {
        let spans = self.sources.iter().filter_map(|source| source.span);
        spans.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// The sources that have datagrams.
    pub fn heard(&self) -> impl Iterator<Item = &CapturedSource> {
        self.sources.iter().filter(|source| source.datagrams > 0)
    }

    /// The sources that are meant: the one that is named, as [`choose`](Self::choose) has it, else all that have datagrams.
    ///
    /// # Errors
    /// [`Error::CapturedSources`] when a name means none or several of them.
    pub fn chosen(&self, path: &Path, wanted: Option<&str>) -> Result<Vec<&CapturedSource>> {
        match wanted {
            Some(_) => self.choose(path, wanted).map(|source| vec![source]),
            None => Ok(self.heard().collect()),
        }
    }

    /// The source that is meant: by its number, or by a part of its name that no other has. The only one if none is named.
    ///
    /// # Errors
    /// [`Error::CapturedSources`] when none or several are meant.
    pub fn choose(&self, path: &Path, wanted: Option<&str>) -> Result<&CapturedSource> {
        let number: Option<u16> = wanted.and_then(|wanted| wanted.parse().ok());
        let is_meant = |source: &&CapturedSource| match (number, wanted) {
            (Some(number), _) => source.number == number,
            (None, Some(wanted)) => source.name.contains(wanted),
            (None, None) => true,
        };
        let mut meant = self.heard().filter(is_meant);
        match (meant.next(), meant.next()) {
            (Some(source), None) => Ok(source),
            _ => Err(self.not_one(path, wanted)),
        }
    }

    /// The sources of a protocol, of the chosen one or of all, that are sent to a target.
    ///
    /// # Errors
    /// [`Error::NothingForTarget`] when there is none.
    pub(crate) fn for_target(
        &self,
        path: &Path,
        chosen: Option<u16>,
        protocol: Protocol,
        target: &Endpoint,
    ) -> Result<Vec<&CapturedSource>> {
        let chosen: Vec<_> = self
            .heard()
            .filter(|source| chosen.is_none_or(|chosen| chosen == source.number))
            .collect();
        let of_protocol = chosen.iter().filter(|source| source.protocol == Some(protocol));
        let sources: Vec<_> = of_protocol.copied().collect();
        if !sources.is_empty() {
            return Ok(sources);
        }
        Err(Error::NothingForTarget {
            path: path.to_owned(),
            endpoint: target.to_string(),
            expected: match protocol {
                Protocol::Mxtp => "MXTP",
                Protocol::NatNet => "NatNet",
            },
            found: chosen.into_iter().map(CapturedSource::label).collect(),
        })
    }

    /// How long after the first datagram the last one came.
    pub(crate) fn lasts(&self) -> Duration {
        self.span().map_or(Duration::ZERO, |(first, last)| last.since(first))
    }

    fn not_one(&self, path: &Path, wanted: Option<&str>) -> Error {
        Error::CapturedSources {
            path: path.to_owned(),
            wanted: wanted.map(str::to_owned),
            found: self.heard().map(CapturedSource::label).collect(),
        }
    }
}

impl CapturedSource {
    /// Its number and endpoint, of which either chooses it.
    pub(crate) fn label(&self) -> String {
        format!("{} {}", self.number, self.name)
    }
}

fn note(sources: &mut Vec<CapturedSource>, captured: &Captured) {
    for number in sources.len()..=usize::from(captured.source) {
        sources.push(CapturedSource {
            number: number as u16,
            name: String::new(),
            protocol: None,
            datagrams: 0,
            bytes: 0,
            span: None,
        });
    }
    let Some(source) = sources.get_mut(usize::from(captured.source)) else {
        return;
    };
    source.protocol.get_or_insert(Protocol::of(captured.datagram.wire));
    if captured.is_repeated {
        return;
    }
    source.datagrams += 1;
    source.bytes += captured.datagram.bytes.len() as u64;
    let at = captured.datagram.received;
    let (first, last) = source.span.unwrap_or((at, at));
    source.span = Some((first.min(at), last.max(at)));
}

/// Whether samples stand in a recording.
pub(super) fn holds_poses(files: &[PathBuf]) -> Result<bool> {
    for file in files {
        let survey = recording::Survey::of(file)?;
        if survey.subjects.iter().any(|subject| subject.frames > 0) {
            return Ok(true);
        }
    }
    Ok(false)
}

fn nothing(counts: &Counts) -> String {
    match counts.packets {
        0 => "no packet".to_owned(),
        1 => "one packet of something else".to_owned(),
        packets => format!("{packets} packets of something else"),
    }
}

impl Protocol {
    /// As options and endpoints spell it: `mxtp`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mxtp => "mxtp",
            Self::NatNet => "natnet",
        }
    }

    /// The protocol of what came over a wire.
    pub const fn of(wire: Wire) -> Self {
        match wire {
            Wire::MxtpUdp | Wire::MxtpTcp => Self::Mxtp,
            Wire::NatNetCommand | Wire::NatNetData => Self::NatNet,
        }
    }
}
