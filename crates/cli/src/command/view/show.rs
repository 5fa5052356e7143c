//! What is shown, until Ctrl-C.

use super::takes;
use crate::browser::Browser;
use crate::cli::View;
use crate::command::End;
use crate::context::{self, Teller, say};
use crate::error::Usage;
use posewire::endpoint::Endpoint;
use posewire::sink::TakesSink;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Sink, Source};
use posewire_viewer::{Options, Recorder};
use std::path::Path;
use std::time::Duration;

pub(super) fn run(arguments: &View) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    let endpoints = arguments.sources.iter().map(|source| source.parse());
    let endpoints = endpoints.collect::<posewire::Result<Vec<Endpoint>>>()?;
    refuse_mixed(&endpoints)?;
    if endpoints.iter().all(is_take) {
        show_takes(&endpoints, arguments, &stop)
    } else {
        show_live(&endpoints, arguments, &stop)
    }
}

fn show_takes(endpoints: &[Endpoint], arguments: &View, stop: &Stop) -> anyhow::Result<End> {
    if arguments.record_dir.is_some() {
        return Err(Usage {
            problem: "--record-dir is for live streams, found takes".to_owned(),
            help: "leave --record-dir out".to_owned(),
        }
        .into());
    }
    let takes = takes::load(endpoints, stop)?;
    let browser = Browser::takes(takes, &options(arguments, None))?;
    announce(&browser, endpoints, arguments);
    while !stop.wait(Duration::from_hours(1)) {}
    Ok(End::Done)
}

fn show_live(endpoints: &[Endpoint], arguments: &View, stop: &Stop) -> anyhow::Result<End> {
    let playback = PlaybackOptions::default();
    let sources = endpoints.iter().map(|endpoint| Source::open(endpoint, &playback));
    let sources = sources.collect::<posewire::Result<Vec<_>>>()?;
    let endpoints: Vec<_> = sources.iter().map(|source| source.endpoint().clone()).collect();
    let recording = arguments
        .record_dir
        .as_deref()
        .map(|folder| recording(folder, &endpoints));
    let recording = recording.transpose()?;
    let recorder = recording.as_ref().map(|(_, recorder)| recorder.clone());
    let browser = Browser::live(&options(arguments, recorder), &endpoints)?;
    announce(&browser, &endpoints, arguments);
    let teller = Teller::default();
    let mut sinks: Vec<Box<dyn Sink>> = vec![browser.sink(), Box::new(teller.clone())];
    let takes = recording.as_ref().map(|(sink, _)| sink.takes());
    sinks.extend(recording.map(|(sink, _)| Box::new(sink) as Box<dyn Sink>));
    let outcome = Session::start(sources, sinks, stop.clone()).wait()?;
    let unwritten = takes.map_or(0, |takes| takes.progress().lost);
    Ok(End::with_lost(outcome.dropped + teller.lost_here() + unwritten))
}

/// What writes the takes that pages begin and end.
fn recording(folder: &Path, endpoints: &[Endpoint]) -> Result<(TakesSink, Recorder), Usage> {
    if !folder.is_dir() {
        return Err(Usage {
            problem: format!("expected a folder for the takes, found {}", folder.display()),
            help: "make the folder first, or name one that is there".to_owned(),
        });
    }
    let sink = TakesSink::new(folder, endpoints, None);
    let recorder = Recorder::new(sink.takes(), folder);
    Ok((sink, recorder))
}

fn options(arguments: &View, recorder: Option<Recorder>) -> Options {
    Options {
        listen: arguments.listen,
        token: arguments.token,
        recorder,
        ..Options::default()
    }
}

fn announce(browser: &Browser, endpoints: &[Endpoint], arguments: &View) {
    for endpoint in endpoints {
        say(format_args!("showing {endpoint}"));
    }
    browser.announce();
    if arguments.open {
        browser.open();
    }
}

/// Whether it is a file, which a page plays itself.
fn is_take(endpoint: &Endpoint) -> bool {
    matches!(endpoint, Endpoint::File { .. } | Endpoint::Capture { .. })
}

/// What is played and what comes now share no timeline.
fn refuse_mixed(endpoints: &[Endpoint]) -> Result<(), Usage> {
    let file = endpoints.iter().find(|endpoint| is_take(endpoint));
    let live = endpoints.iter().find(|endpoint| !is_take(endpoint));
    match (file, live) {
        (Some(file), Some(live)) => Err(Usage {
            problem: format!("expected files or live streams, found both: {file} and {live}"),
            help: format!("view {file} by itself with another --listen, or send it live: posewire stream {file}"),
        }),
        _ => Ok(()),
    }
}
