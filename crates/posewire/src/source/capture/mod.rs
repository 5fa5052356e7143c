//! A capture, read as if its datagrams arrived now.

mod decoder;

use self::decoder::Decoder;
use super::playback::PlaybackOptions;
use super::report::TICK;
use crate::capture::{CaptureOptions, CapturedSource, Opening, Playlist, Protocol, Selection, Survey};
use crate::pacer::Pacer;
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Error, Notice, Result};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// One source of a capture, to be played at its own pace.
#[derive(Debug)]
pub(super) struct CapturePlayback {
    path: PathBuf,
    options: PlaybackOptions,
    playlist: Playlist,
    source: CapturedSource,
    opening: Option<Opening>,
}

impl CapturePlayback {
    pub(super) fn open(path: &Path, options: &PlaybackOptions) -> Result<Self> {
        Pacer::new(Instant::now(), options.speed, Stop::new())?;
        if let Some(rate) = options.rate_hz {
            return Err(Error::CaptureRate {
                found: rate.to_string(),
            });
        }
        let reading = CaptureOptions {
            protocol: options.protocol,
        };
        let survey = Survey::of(path, &reading)?;
        let source = survey.choose(path, options.only.as_deref())?.clone();
        let selection = Selection {
            source: Some(source.number),
            ..options.selection()
        };
        let opening = match source.protocol {
            Some(Protocol::NatNet) => Some(Opening::find(path, &reading, &source)?),
            _ => None,
        };
        Ok(Self {
            path: path.to_owned(),
            options: options.clone(),
            playlist: Playlist::open(path, &reading, selection)?,
            source,
            opening,
        })
    }

    /// What is played.
    pub(super) fn source(&self) -> &CapturedSource {
        &self.source
    }

    pub(super) fn run(mut self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        let Some(mut next) = self.playlist.next()? else {
            return Err(Error::NoDatagrams {
                path: self.path,
                found: "none in that time".to_owned(),
            });
        };
        // A copy from a file before is older than what is played.
        let own = self.source.span.filter(|_| next.captured.is_repeated);
        let start = own.map_or(next.captured.datagram.received, |(first, _)| first);
        let mut pacer = Pacer::new(Instant::now(), self.options.speed, stop.clone())?;
        let mut decoder = Decoder::new(start, self.opening.as_ref(), outlet);
        let mut past = Duration::ZERO;
        let played = loop {
            if self.is_over(next.offset) || !pass(&mut pacer, past..next.offset, &mut decoder, &self.options) {
                break Ok(());
            }
            past = next.offset;
            let due = pacer.deadline(past);
            if !decoder.take(&next.captured.datagram, due) {
                break Ok(());
            }
            match self.playlist.next() {
                Ok(Some(due)) => next = due,
                Ok(None) => break Ok(()),
                Err(error) => break Err(error),
            }
        };
        if let Some(problem) = self.playlist.damage() {
            let problem = problem.to_owned();
            decoder.notice(Notice::Damaged { problem });
        }
        decoder.finish();
        played
    }

    fn is_over(&self, offset: Duration) -> bool {
        let wall = offset.as_secs_f64() / self.options.speed;
        self.options
            .duration
            .is_some_and(|duration| wall >= duration.as_secs_f64())
    }
}

/// Lets the time between two datagrams pass, and what is due in it happen; `false` when asked to stop.
fn pass(
    pacer: &mut Pacer,
    time: std::ops::Range<Duration>,
    decoder: &mut Decoder<'_>,
    options: &PlaybackOptions,
) -> bool {
    let step = TICK.mul_f64(options.speed.clamp(1e-3, 1e3));
    let mut at = time.start;
    while time.end.saturating_sub(at) > step {
        at += step;
        if !pacer.wait(at) || !decoder.tick(step) {
            return false;
        }
    }
    pacer.wait(time.end)
}
