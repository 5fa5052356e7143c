//! Takes to be viewed: files of takes, and what recordings and captures hold.

use crate::context::{Teller, end_progress, say, show_progress};
use crate::error::Failure;
use crate::plain::plural;
use posewire::endpoint::Endpoint;
use posewire::file::{Progress, ReadOptions, Recording, read};
use posewire::sink::TakeSink;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Sink, Source};
use posewire_motion::Take;
use posewire_viewer::Takes;
use std::path::Path;
use std::time::Duration;

/// Loads every take of these files.
pub(super) fn load(endpoints: &[Endpoint], stop: &Stop) -> anyhow::Result<Takes> {
    let mut takes = Vec::new();
    for endpoint in endpoints {
        let (path, found) = match endpoint {
            Endpoint::File { path, format } => {
                format.check_readable(path)?;
                (path, vec![read_take(path)?])
            }
            Endpoint::Capture { path } => (path, play(path, endpoint, stop)?),
            _ => continue,
        };
        let name = name(path, endpoints);
        takes.extend(found.into_iter().map(|take| (name.clone(), take)));
    }
    if stop.is_stopped() {
        let what = "reading".to_owned();
        return Err(posewire::Error::Stopped { what }.into());
    }
    Ok(Takes::new(takes))
}

/// The name of a file, with its folder where another file is called the same.
fn name(path: &Path, endpoints: &[Endpoint]) -> String {
    let is_same = |endpoint: &&Endpoint| file(endpoint).is_some_and(|other| other.file_name() == path.file_name());
    let plain = path
        .file_name()
        .filter(|_| endpoints.iter().filter(is_same).count() == 1);
    plain.unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn file(endpoint: &Endpoint) -> Option<&Path> {
    match endpoint {
        Endpoint::File { path, .. } | Endpoint::Capture { path } => Some(path),
        _ => None,
    }
}

/// A damaged file is shown up to the damage.
fn read_take(path: &Path) -> anyhow::Result<Take> {
    let options = ReadOptions {
        salvage: true,
        ..ReadOptions::default()
    };
    let recording = read(path, options, &Progress::default())?;
    if let Some(damage) = &recording.damage {
        say(format_args!("{} is shown up to its damage: {damage}", path.display()));
    }
    Ok(recording.take)
}

/// The takes of every source of a capture, which is read as fast as it can be.
fn play(path: &Path, endpoint: &Endpoint, stop: &Stop) -> anyhow::Result<Vec<Take>> {
    let options = PlaybackOptions {
        speed: PlaybackOptions::AT_ONCE,
        ..PlaybackOptions::default()
    };
    let takes = play_sources(Source::open_all(endpoint, &options)?, path, stop)?;
    if takes.is_empty() {
        return Err(Failure {
            problem: format!("{}: expected poses, found none", path.display()),
            help: format!("posewire inspect {} says what it holds", path.display()),
        }
        .into());
    }
    Ok(takes)
}

fn play_sources(sources: Vec<Source>, path: &Path, stop: &Stop) -> anyhow::Result<Vec<Take>> {
    let takes = TakeSink::default();
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(takes.clone()), Box::new(Teller::default())];
    let reading = Stop::new();
    let session = Session::start(sources, sinks, reading.clone());
    while session.is_running() {
        if stop.wait(LOOK_EVERY) {
            reading.stop();
            break;
        }
        let frames = plural(takes.frames() as u64, "frame");
        show_progress(format_args!("reading {}: {frames}", path.display()));
    }
    session.wait()?;
    end_progress();
    // Samples that came late stand where they belong.
    let takes = takes.take().into_iter();
    Ok(takes.map(|take| Recording::from(take).take).collect())
}

const LOOK_EVERY: Duration = Duration::from_millis(50);
