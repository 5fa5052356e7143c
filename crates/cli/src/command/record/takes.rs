//! `posewire record --remote`: takes that somebody else begins and ends.

use super::{EVERY, LOOK_EVERY, MEGABYTE, QUIET, RECORDER, Rate, Shouts, Warnings, say_silent, tell_failure};
use crate::cli::Record;
use crate::command::End;
use crate::context::{self, Teller, end_progress, say, show_progress};
use crate::error::Usage;
use crate::{json, render};
use posewire::endpoint::Endpoint;
use posewire::remote::{RecordingControl, Remote};
use posewire::sink::{TakeProgress, Takes, TakesProgress, TakesSink};
use posewire::stop::Stop;
use posewire::{Session, Source};
use std::fs;
use std::net::SocketAddr;
use std::time::Instant;

/// Records takes of the sources until it is stopped.
pub(super) fn run(arguments: &Record, address: SocketAddr, sources: Vec<Source>, stop: &Stop) -> anyhow::Result<End> {
    refuse(arguments)?;
    let remote = Remote::bind(address)?;
    let folder = &arguments.output;
    fs::create_dir_all(folder).map_err(|error| posewire::Error::write(folder.display().to_string(), &error))?;
    let endpoints: Vec<_> = sources.iter().map(|source| source.endpoint().clone()).collect();
    let split = arguments.split_size.map(|megabytes| megabytes * MEGABYTE);
    let sink = TakesSink::new(&arguments.output, &endpoints, split);
    let takes = sink.takes();
    for endpoint in &endpoints {
        say(format_args!("recording {endpoint}"));
    }
    say(format_args!("  takes into {}", arguments.output.display()));
    context::announce_remote(&remote);
    context::stop_after(stop, arguments.duration);
    let session = Session::start(sources, vec![Box::new(sink), Box::new(Teller::default())], stop.clone());
    let json = arguments.json;
    let control = RecordingControl::new(takes.clone(), Box::new(move |take| ended(take, json)));
    let tell = Box::new(context::tell_of_remote);
    let serving = remote.serve(context::REMOTE_NAME, Box::new(control), tell, stop.clone());
    watch(&session, &takes, json, stop)?;
    stop.stop();
    // One that is being ended is told of by who ends it.
    _ = serving.join();
    let outcome = session.wait();
    end_progress();
    let progress = takes.progress();
    if let Some(take) = &progress.cut_short {
        ended(take, json);
    }
    say(format_args!(
        "{} in all",
        crate::plain::plural(progress.takes.into(), "take")
    ));
    outcome?;
    Ok(End::with_lost(progress.lost))
}

fn refuse(arguments: &Record) -> Result<(), Usage> {
    if arguments.overwrite {
        return Err(Usage {
            problem: "--overwrite and --remote do not go together: takes never replace a file".to_owned(),
            help: "leave --overwrite out".to_owned(),
        });
    }
    if arguments.output.exists() && !arguments.output.is_dir() {
        return Err(Usage {
            problem: format!("expected a folder for the takes, found {}", arguments.output.display()),
            help: "with --remote, -o names a folder; each take is a file in it".to_owned(),
        });
    }
    Ok(())
}

/// Tells how a take went.
fn ended(take: &TakeProgress, json: bool) {
    end_progress();
    if json {
        // Whoever read it has gone, which the next line of this program will show.
        _ = json::print(&json::RecordingRecord::new(&take.recorded, take.lasted, None));
    } else {
        say(render::recorded(&take.recorded, take.lasted));
    }
    if let Some(failure) = &take.recorded.failure {
        tell_failure(failure);
    }
}

/// Shows what is recorded, and shouts when something is lost.
fn watch(session: &Session, takes: &Takes, json: bool, stop: &Stop) -> anyhow::Result<()> {
    let begun = Instant::now();
    let mut next = begun + EVERY;
    let mut quiet = Some(begun + QUIET);
    let mut recording = Recording::new(0);
    while session.is_running() && !stop.wait(LOOK_EVERY) {
        let mut progress = takes.progress();
        if recording.number != progress.takes {
            recording = Recording::new(progress.takes);
            recording.dropped_before = session.dropped(RECORDER);
        }
        let now = Instant::now();
        show_progress(recording.line(now, &mut progress, session));
        if quiet.is_some_and(|quiet| now >= quiet) {
            quiet = None;
            end_progress();
            tell_of_silence(&progress);
        }
        if json && now >= next {
            next += EVERY;
            if let Some(take) = &progress.recording {
                let rate = recording.rate.per_second;
                json::print(&json::RecordingRecord::new(&take.recorded, take.lasted, Some(rate)))?;
            }
        }
    }
    Ok(())
}

/// What is known of the take that is recorded.
struct Recording {
    number: u32,
    rate: Rate,
    shouts: Shouts,
    warnings: Warnings,
    dropped_before: u64,
}

impl Recording {
    fn new(number: u32) -> Self {
        Self {
            number,
            rate: Rate::new(Instant::now()),
            shouts: Shouts::default(),
            warnings: Warnings::default(),
            dropped_before: 0,
        }
    }

    fn line(&mut self, now: Instant, progress: &mut TakesProgress, session: &Session) -> String {
        let Some(take) = &mut progress.recording else {
            return format!("no take, {} so far", progress.takes);
        };
        // A recorder that is stuck in a write says nothing itself.
        let dropped = session.dropped(RECORDER).saturating_sub(self.dropped_before);
        take.recorded.dropped = take.recorded.dropped.max(dropped);
        self.rate.note(now, take.recorded.datagrams());
        self.shouts.heed(now, &take.recorded);
        self.warnings.heed(&take.recorded);
        render::recording_line(&take.recorded, self.rate.per_second, take.lasted)
    }
}

/// Says which sources nothing has come from.
fn tell_of_silence(progress: &TakesProgress) {
    for (endpoint, datagrams) in &progress.sources {
        if *datagrams == 0 && !matches!(endpoint, Endpoint::Synthetic(_)) {
            say_silent(endpoint, None);
        }
    }
}
