//! What is shown, until Ctrl-C.

use super::takes;
use crate::browser::Browser;
use crate::cli::View;
use crate::command::End;
use crate::context::{self, Teller, say};
use crate::error::Usage;
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use posewire_viewer::Options;
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
    let takes = takes::load(endpoints, stop)?;
    let browser = Browser::takes(takes, &options(arguments))?;
    announce(&browser, endpoints, arguments);
    while !stop.wait(Duration::from_hours(1)) {}
    Ok(End::Done)
}

fn show_live(endpoints: &[Endpoint], arguments: &View, stop: &Stop) -> anyhow::Result<End> {
    let playback = PlaybackOptions::default();
    let sources = endpoints.iter().map(|endpoint| Source::open(endpoint, &playback));
    let sources = sources.collect::<posewire::Result<Vec<_>>>()?;
    let endpoints: Vec<_> = sources.iter().map(|source| source.endpoint().clone()).collect();
    let browser = Browser::live(&options(arguments), &endpoints)?;
    announce(&browser, &endpoints, arguments);
    let teller = Teller::default();
    let session = Session::start(sources, vec![browser.sink(), Box::new(teller.clone())], stop.clone());
    let outcome = session.wait()?;
    Ok(End::with_lost(outcome.dropped + teller.lost_here()))
}

fn options(arguments: &View) -> Options {
    Options {
        listen: arguments.listen,
        token: arguments.token,
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
