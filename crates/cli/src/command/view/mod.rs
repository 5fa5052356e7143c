//! `posewire view`: live streams or takes in a browser.

mod takes;

use super::End;
use crate::cli;
use crate::context::{self, Teller, say};
use crate::error::Usage;
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use posewire_viewer::{Content, Feed, Options, Server, ViewerSink};
use std::time::Duration;

pub(super) fn run(arguments: &cli::View) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    let endpoints = arguments.sources.iter().map(|source| source.parse());
    let endpoints = endpoints.collect::<posewire::Result<Vec<Endpoint>>>()?;
    refuse_mixed(&endpoints)?;
    if endpoints.iter().all(is_take) {
        let takes = takes::load(&endpoints, &stop)?;
        let server = serve(Content::Takes(takes), &arguments.page)?;
        while !stop.wait(Duration::from_hours(1)) {}
        server.stop();
        return Ok(End::Done);
    }
    show_live(&endpoints, &arguments.page, &stop)
}

fn show_live(endpoints: &[Endpoint], page: &cli::Page, stop: &Stop) -> anyhow::Result<End> {
    let options = PlaybackOptions::default();
    let sources = endpoints.iter().map(|endpoint| Source::open(endpoint, &options));
    let sources = sources.collect::<posewire::Result<Vec<_>>>()?;
    let endpoints: Vec<_> = sources.iter().map(|source| source.endpoint().clone()).collect();
    let feed = Feed::new(&endpoints);
    let server = serve(Content::Live(feed.clone()), page)?;
    for endpoint in &endpoints {
        say(format_args!("showing {endpoint}"));
    }
    let teller = Teller::default();
    let sinks: Vec<Box<dyn posewire::Sink>> = vec![Box::new(ViewerSink::new(&feed)), Box::new(teller.clone())];
    Session::start(sources, sinks, stop.clone()).wait()?;
    server.stop();
    Ok(End::with_lost(teller.lost_here()))
}

/// Serves the page and says where.
fn serve(content: Content, page: &cli::Page) -> anyhow::Result<Server> {
    let options = Options { listen: page.listen };
    let server = Server::start(content, &options)?;
    say(format_args!("open {}", server.url(page.listen.ip())));
    Ok(server)
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
            problem: format!("expected takes or live streams, found both: {file} and {live}"),
            help: format!(
                "view them apart; or posewire stream {file} and posewire view mxtp://127.0.0.1 beside the live stream"
            ),
        }),
        _ => Ok(()),
    }
}
