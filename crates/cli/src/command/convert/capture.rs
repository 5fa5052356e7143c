//! Takes of what is no file of a take: the walker, live streams, and captures, which are played.

use crate::context::{self, Stops, Teller, end_progress, say, show_progress};
use crate::error::Failure;
use crate::plain::plural;
use posewire::endpoint::{Endpoint, Walk};
use posewire::file::Recording;
use posewire::sink::TakeSink;
use posewire::source::PlaybackOptions;
use posewire::source::synthetic;
use posewire::{Session, Sink, Source};
use std::time::Duration;

/// The walker's people, for so long by their own clock.
pub(super) fn walk(walk: &Walk, duration: Option<Duration>, stops: &Stops) -> anyhow::Result<Vec<Recording>> {
    let walk = synthetic::Walk::new(&walk.into());
    let takes = walk.takes(duration.unwrap_or_default(), &stops.work)?;
    Ok(takes.into_iter().map(Recording::from).collect())
}

/// A live stream until it is stopped or the time is over, or a whole capture: a take for each subject; and how much of it was
/// lost on this side. What ended a file before its end is the takes' damage.
pub(super) fn live(
    endpoint: &Endpoint,
    only: Option<&str>,
    duration: Option<Duration>,
    stops: &Stops,
) -> anyhow::Result<(Vec<Recording>, u64)> {
    let options = PlaybackOptions {
        speed: PlaybackOptions::AT_ONCE,
        only: only.map(str::to_owned),
        computes: false,
        ..PlaybackOptions::default()
    };
    let sources = Source::open_all(endpoint, &options)?;
    sources.iter().for_each(announce);
    let stop = stops.begin_capture();
    context::stop_after(&stop, duration);
    let (takes, teller) = (TakeSink::default(), Teller::default());
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(takes.clone()), Box::new(teller.clone())];
    let session = Session::start(sources, sinks, stop.clone());
    while !stop.wait(Duration::from_millis(200)) && session.is_running() {
        let frames = plural(takes.frames() as u64, "frame");
        show_progress(format_args!("receiving, Ctrl-C ends it: {frames}"));
    }
    let outcome = session.wait();
    end_progress();
    stops.end_capture();
    let lost = outcome?.dropped + teller.lost_here();
    if lost > 0 {
        say(format_args!("{} were lost on this machine", plural(lost, "datagram")));
    }
    let takes = takes.take();
    if takes.is_empty() {
        return Err(Failure {
            problem: format!("nothing came from {endpoint}"),
            help: "posewire monitor shows what arrives".to_owned(),
        }
        .into());
    }
    let damage = teller.damage();
    let recording = |take| {
        let mut recording = Recording::from(take);
        recording.damage.clone_from(&damage);
        recording
    };
    Ok((takes.into_iter().map(recording).collect(), lost))
}

fn announce(source: &Source) {
    match source.captured() {
        Some(captured) => say(format_args!("playing {}, {}", source.endpoint(), captured.name)),
        None if source.is_live() => say(format_args!("receiving from {}", source.endpoint())),
        None => say(format_args!("playing the poses of {}", source.endpoint())),
    }
}
