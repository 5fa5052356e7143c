//! A capture, read as if its datagrams arrived now.

mod decoder;

use self::decoder::Decoder;
use super::playback::PlaybackOptions;
use super::posed;
use super::report::TICK;
use crate::capture::{CaptureOptions, CapturedSource, Due, Opening, Playlist, Protocol, Selection, Survey};
use crate::pacer::Pacer;
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Error, Item, Notice, Result};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// One source of a capture, to be played at the pace of the day, together with the others that were opened with it.
#[derive(Debug)]
pub(super) struct CapturePlayback {
    path: PathBuf,
    /// From its first datagram to its last.
    lasts: Duration,
    options: PlaybackOptions,
    /// The datagrams of all that are played together, by which each knows when its own are due.
    playlist: Playlist,
    source: CapturedSource,
    opening: Option<Opening>,
    together: Together,
    /// What is said at the beginning, by one of those that are played together.
    notice: Option<Notice>,
}

/// What sources have in common that are played together.
#[derive(Clone, Debug)]
struct Together {
    /// When the first of them began.
    began: Arc<OnceLock<Instant>>,
    /// All of them read the same file, and one says what is wrong with it.
    damage_told: Arc<OnceLock<()>>,
    count: usize,
}

impl CapturePlayback {
    /// Opens the one source that is meant.
    pub(super) fn open(path: &Path, options: &PlaybackOptions) -> Result<Self> {
        let survey = survey(path, options, &Stop::new())?;
        let source = survey.choose(path, options.only.as_deref())?;
        let mut capture = Self::of((path, survey.lasts()), options, source, &Together::of(1))?;
        capture.notice = left_out(path, options, &survey)?;
        Ok(capture)
    }

    /// Opens each source that is meant; all of them if none is named. `stop` ends the reading that this takes.
    pub(super) fn open_all(path: &Path, options: &PlaybackOptions, stop: &Stop) -> Result<Vec<Self>> {
        let survey = survey(path, options, stop)?;
        let sources = survey.chosen(path, options.only.as_deref())?;
        if sources.len() > MOST_TOGETHER {
            // It names them all, and asks for one.
            survey.choose(path, None)?;
        }
        let together = Together::of(sources.len());
        let open = |source| Self::of((path, survey.lasts()), options, source, &together);
        let mut captures = sources.into_iter().map(open).collect::<Result<Vec<_>>>()?;
        if let Some(first) = captures.first_mut() {
            first.notice = left_out(path, options, &survey)?;
        }
        Ok(captures)
    }

    fn of(
        (path, lasts): (&Path, Duration),
        options: &PlaybackOptions,
        source: &CapturedSource,
        together: &Together,
    ) -> Result<Self> {
        let reading = reading(options);
        let selection = Selection {
            source: (together.count == 1).then_some(source.number),
            ..options.selection()
        };
        let opening = match source.protocol {
            Some(Protocol::NatNet) => Some(Opening::find(path, &reading, source)?),
            _ => None,
        };
        Ok(Self {
            path: path.to_owned(),
            lasts,
            options: options.clone(),
            playlist: Playlist::open(path, &reading, selection)?,
            source: source.clone(),
            opening,
            together: together.clone(),
            notice: None,
        })
    }

    /// What is played.
    pub(super) fn source(&self) -> &CapturedSource {
        &self.source
    }

    pub(super) fn run(mut self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        if let Some(notice) = self.notice.take() {
            outlet.push(Item::Notice(notice));
        }
        let began = *self.together.began.get_or_init(Instant::now);
        let mut pacer = Pacer::new(began, self.options.speed, stop.clone())?;
        let Some(first) = self.next()? else {
            return self.end_without_any(outlet);
        };
        if self.is_over(first.offset) || !pacer.wait(first.offset) {
            return Ok(());
        }
        // A copy from a file before is older than what is played.
        let own = self.source.span.filter(|_| first.captured.is_repeated);
        let start = own.map_or(first.captured.datagram.received, |(first, _)| first);
        let opening = self.opening.take();
        let mut decoder = Decoder::new(start, opening.as_ref(), outlet);
        let played = self.play(first, &mut pacer, &mut decoder);
        if let Some(problem) = self.playlist.damage()
            && self.together.damage_told.set(()).is_ok()
        {
            decoder.notice(Notice::Damaged {
                file: self.path.display().to_string(),
                problem: problem.to_owned(),
            });
        }
        decoder.finish();
        played
    }

    /// Plays from the first datagram on, whose time has come.
    fn play(&mut self, first: Due, pacer: &mut Pacer, decoder: &mut Decoder<'_>) -> Result<()> {
        let mut past = first.offset;
        let mut next = Some(first);
        while let Some(due) = next {
            if self.is_over(due.offset) || !pass(pacer, past..due.offset, decoder, &self.options) {
                break;
            }
            past = due.offset;
            if !decoder.take(&due.captured.datagram, pacer.deadline(past)) {
                break;
            }
            next = self.next()?;
        }
        Ok(())
    }

    /// The next datagram of this source.
    fn next(&mut self) -> Result<Option<Due>> {
        loop {
            match self.playlist.next()? {
                Some(due) if due.captured.source != self.source.number => {}
                next => return Ok(next),
            }
        }
    }

    /// The part that is played may have datagrams of others alone; to have none at all is an error.
    fn end_without_any(self, outlet: &mut Outlet) -> Result<()> {
        if self.playlist.is_empty() {
            return Err(Error::NothingInTime {
                path: self.path,
                lasts: self.lasts,
            });
        }
        let text = format!("{} has no datagram in that time", self.source.name);
        outlet.push(Item::Notice(Notice::Remark { text }));
        outlet.finish();
        Ok(())
    }

    fn is_over(&self, offset: Duration) -> bool {
        let wall = offset.as_secs_f64() / self.options.speed;
        self.options
            .duration
            .is_some_and(|duration| wall >= duration.as_secs_f64())
    }
}

impl Together {
    fn of(count: usize) -> Self {
        Self {
            began: Arc::default(),
            damage_told: Arc::default(),
            count,
        }
    }
}

fn survey(path: &Path, options: &PlaybackOptions, stop: &Stop) -> Result<Survey> {
    Pacer::new(Instant::now(), options.speed, Stop::new())?;
    if let Some(rate) = options.rate_hz {
        return Err(Error::CaptureRate {
            found: rate.to_string(),
        });
    }
    Survey::of_until(path, &reading(options), stop)
}

/// The sources that have poses alone, unless one was named.
fn left_out(path: &Path, options: &PlaybackOptions, survey: &Survey) -> Result<Option<Notice>> {
    if options.only.is_some() {
        return Ok(None);
    }
    let sources = posed::unheard(path, survey)?;
    let file = path.display().to_string();
    Ok((!sources.is_empty()).then_some(Notice::PosesLeftOut { file, sources }))
}

fn reading(options: &PlaybackOptions) -> CaptureOptions {
    CaptureOptions {
        protocol: options.protocol,
    }
}

/// Lets the time between two datagrams pass, and what is due in it happen; `false` when asked to stop. However long it is by
/// the clock of the capture, the reader is looked after when it has something to do and, as time passes here, each [`TICK`].
fn pass(
    pacer: &mut Pacer,
    time: std::ops::Range<Duration>,
    decoder: &mut Decoder<'_>,
    options: &PlaybackOptions,
) -> bool {
    let tick = tick_at(options.speed);
    let mut at = time.start;
    loop {
        let step = decoder.next_due().map_or(tick, |due| due.min(tick));
        if time.end.saturating_sub(at) <= step {
            return pacer.wait(time.end);
        }
        at += step;
        if !pacer.wait(at) || !decoder.tick(step, pacer.deadline(at)) {
            return false;
        }
    }
}

/// How much time of a capture passes in a [`TICK`] of the day.
fn tick_at(speed: f64) -> Duration {
    Duration::try_from_secs_f64(TICK.as_secs_f64() * speed.max(SLOWEST)).unwrap_or(Duration::MAX)
}

/// So that a tick is some time even where next to none passes.
const SLOWEST: f64 = 1e-3;
/// Each has a thread that reads the capture. So many sources are several systems; more of them are a network.
const MOST_TOGETHER: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Writer, WriterOptions};
    use crate::{Datagram, SourceId, Wire};
    use posewire_motion::Stamp;

    #[test]
    fn opening_a_long_capture_ends_when_it_is_stopped() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("take.mcap");
        let mut writer = Writer::create(&path, &["mxtp://h:9763".to_owned()], WriterOptions::default()).unwrap();
        let datagram = Datagram {
            wire: Wire::MxtpUdp,
            from: ([10, 0, 0, 1], 1).into(),
            to: ([10, 0, 0, 2], 9763).into(),
            received: Stamp(1),
            bytes: (*b"MXTP02").into(),
        };
        writer.datagram(SourceId(0), &Arc::new(datagram)).unwrap();
        writer.finish().unwrap();
        let (options, stop) = (PlaybackOptions::default(), Stop::new());
        assert_eq!(CapturePlayback::open_all(&path, &options, &stop).unwrap().len(), 1);
        stop.stop();
        let refused = CapturePlayback::open_all(&path, &options, &stop).unwrap_err();
        assert!(matches!(refused, Error::Stopped { .. }), "{refused}");
    }
}
