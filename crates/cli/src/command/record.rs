//! `posewire record`: every datagram of live sources, and the poses in them, into a file.

mod takes;

use super::End;
use super::monitor::{endpoints_of, hint};
use crate::browser::Browser;
use crate::cli::Record;
use crate::context::{self, Teller, end_progress, say, show_progress, shows_progress};
use crate::error::Usage;
use crate::{json, render};
use posewire::endpoint::Endpoint;
use posewire::recording::check_ending;
use posewire::sink::{RecordOptions, RecordProgress, RecordSink};
use posewire::source::PlaybackOptions;
use posewire::stats::Statistics;
use posewire::stop::Stop;
use posewire::{Outcome, Session, Sink, Source};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

pub(super) fn run(arguments: &Record) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    check_ending(&arguments.output)?;
    let sources = open(&arguments.urls)?;
    if let Some(address) = arguments.remote {
        return takes::run(arguments, address, sources, &stop);
    }
    let endpoints = endpoints_of(&sources);
    let options = RecordOptions {
        split: arguments.split_size.map(|megabytes| megabytes * MEGABYTE),
        overwrite: arguments.overwrite,
    };
    let sink = RecordSink::create(&arguments.output, &endpoints, options, stop.clone())?;
    let progress = sink.progress();
    for endpoint in &endpoints {
        say(format_args!("recording {endpoint}"));
    }
    say(format_args!("  into {}", arguments.output.display()));
    let browser = Browser::beside(arguments.beside.view, &endpoints)?;
    context::stop_after(&stop, arguments.duration);
    let teller = Teller::default();
    let mut sinks: Vec<Box<dyn Sink>> = vec![Box::new(sink), Box::new(teller.clone())];
    sinks.extend(browser.as_ref().map(Browser::sink));
    let session = Session::start(sources, sinks, stop.clone());
    let begun = Instant::now();
    watch(&session, &progress, arguments.json, &stop)?;
    let outcome = session.wait();
    end_progress();
    let progress = read(&progress);
    if arguments.json {
        json::print(&json::RecordingRecord::new(&progress, begun.elapsed(), None))?;
    } else {
        say(render::recorded(&progress, begun.elapsed()));
    }
    end(&progress, outcome, &teller)
}

/// Opens live sources; what is no live source is not recorded.
fn open(urls: &[String]) -> anyhow::Result<Vec<Source>> {
    let mut sources = Vec::new();
    for url in urls {
        let endpoint: Endpoint = url.parse()?;
        if let Endpoint::File { .. } = endpoint {
            return Err(Usage {
                problem: format!("expected a live stream to record, as mxtp://0.0.0.0:9763, found {endpoint}"),
                help: format!("posewire inspect {endpoint} says what it holds, posewire stream sends it"),
            }
            .into());
        }
        sources.extend(Source::open_all(&endpoint, &PlaybackOptions::default())?);
    }
    Ok(sources)
}

/// Shows how far the recording has come, and shouts when something is lost.
fn watch(session: &Session, progress: &Mutex<RecordProgress>, json: bool, stop: &Stop) -> anyhow::Result<()> {
    let begun = Instant::now();
    let mut rate = Rate::new(begun);
    let mut next = begun + EVERY;
    let mut line = (!json && !shows_progress()).then_some(begun + LINE_EVERY);
    let mut shouts = Shouts::default();
    let mut warnings = Warnings::default();
    let mut quiet = Some(begun + QUIET);
    while session.is_running() && !stop.wait(LOOK_EVERY) {
        let mut progress = read(progress);
        // A recorder that is stuck in a write says nothing itself.
        progress.dropped = progress.dropped.max(session.dropped(RECORDER));
        let now = Instant::now();
        rate.note(now, progress.datagrams());
        let shown = render::recording_line(&progress, rate.per_second, begun.elapsed());
        if let Some(due) = line.as_mut().filter(|due| now >= **due) {
            *due = now + LINE_EVERY;
            say(&shown);
        }
        show_progress(shown);
        shouts.heed(now, &progress);
        warnings.heed(&progress);
        if quiet.is_some_and(|quiet| now >= quiet) {
            quiet = None;
            end_progress();
            tell_of_silence(&progress);
        }
        if json && now >= next {
            next += EVERY;
            let record = json::RecordingRecord::new(&progress, begun.elapsed(), Some(rate.per_second));
            json::print(&record)?;
        }
    }
    Ok(())
}

/// What is said of losses: at once, and then no more often than once a second.
#[derive(Default)]
struct Shouts {
    lost: u64,
    last: Option<Instant>,
}

impl Shouts {
    fn heed(&mut self, now: Instant, progress: &RecordProgress) {
        let is_early = self.last.is_some_and(|last| now < last + EVERY);
        if progress.lost() > self.lost && !is_early {
            (self.lost, self.last) = (progress.lost(), Some(now));
            end_progress();
            say(render::losses(progress));
        }
    }
}

/// What is said once, as soon as it is so.
#[derive(Default)]
struct Warnings {
    moved: bool,
    two_senders: BTreeSet<String>,
}

impl Warnings {
    fn heed(&mut self, progress: &RecordProgress) {
        if progress.moved && !self.moved {
            end_progress();
            say(render::moved(progress));
        }
        self.moved = progress.moved;
        for said in progress.sources.iter().flat_map(|source| &source.two_senders) {
            if self.two_senders.len() < MOST_WARNINGS && self.two_senders.insert(said.clone()) {
                end_progress();
                say(render::two_senders(said));
            }
        }
    }
}

/// Says which sources nothing has come from.
fn tell_of_silence(progress: &RecordProgress) {
    for source in render::silent(progress) {
        say_silent(&source.endpoint, source.statistics.as_deref());
    }
}

fn say_silent(endpoint: &Endpoint, statistics: Option<&Statistics>) {
    say(hint::of(endpoint, false, statistics));
}

/// A recording that could not be written any more has lost data; it did not fail before it began.
fn end(progress: &RecordProgress, outcome: posewire::Result<Outcome>, teller: &Teller) -> anyhow::Result<End> {
    match (outcome, &progress.failure) {
        (Err(error), Some(failure)) if error == *failure => {
            tell_failure(failure);
            Ok(End::LostData)
        }
        (outcome, _) => {
            outcome?;
            let is_incomplete = progress.moved || teller.is_damaged();
            Ok(End::with_lost(progress.lost() + u64::from(is_incomplete)))
        }
    }
}

/// Says why a recording could not be written to its end.
fn tell_failure(failure: &posewire::Error) {
    say(format_args!("error: {failure}"));
    let help = failure.help().unwrap_or_default();
    let left = match failure {
        posewire::Error::Removed { .. } => "",
        _ => "; what was written can be read, posewire inspect --recover completes it",
    };
    say(format_args!("help: {help}{left}"));
}

fn read(progress: &Mutex<RecordProgress>) -> RecordProgress {
    progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Datagrams a second, over the last second or so.
struct Rate {
    since: Instant,
    count: u64,
    per_second: f64,
    is_first: bool,
}

impl Rate {
    fn new(now: Instant) -> Self {
        Self {
            since: now,
            count: 0,
            per_second: 0.0,
            is_first: true,
        }
    }

    fn note(&mut self, now: Instant, count: u64) {
        let elapsed = now.saturating_duration_since(self.since);
        // Until there is a whole second, what there is of the first.
        if elapsed >= EVERY || self.is_first {
            self.per_second = count.saturating_sub(self.count) as f64 / elapsed.as_secs_f64().max(1e-3);
        }
        if elapsed >= EVERY {
            (self.since, self.count, self.is_first) = (now, count, false);
        }
    }
}

const MEGABYTE: u64 = 1_000_000;
const LOOK_EVERY: Duration = Duration::from_millis(100);
const EVERY: Duration = Duration::from_secs(1);
/// Between lines where they cannot be shown in place, as in the log of a service.
const LINE_EVERY: Duration = Duration::from_secs(10);
/// The place of the recorder among the sinks.
const RECORDER: usize = 0;
const QUIET: Duration = Duration::from_secs(3);
/// Warnings of one kind; a network in which there are more is known to be wrong.
const MOST_WARNINGS: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_told_from_the_first_moment_and_then_each_second() {
        let begun = Instant::now();
        let mut rate = Rate::new(begun);
        let mut told = |milliseconds, count| {
            rate.note(begun + Duration::from_millis(milliseconds), count);
            rate.per_second.round() as u64
        };
        assert_eq!(told(100, 24), 240);
        assert_eq!(told(500, 60), 120);
        assert_eq!(told(1000, 240), 240);
        assert_eq!(told(1500, 999), 240);
        assert_eq!(told(2000, 300), 60);
    }
}
