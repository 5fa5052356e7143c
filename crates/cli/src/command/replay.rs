//! `posewire replay`: the datagrams of a capture sent again.

mod shown;

use super::End;
use super::stream::{announce_faults, peers::Peers};
use crate::cli::Replay;
use crate::context::{self, end_progress, say, show_progress};
use crate::plain::{grouped, plural};
use crate::{json, render};
use posewire::capture::CapturedSource;
use posewire::endpoint::Endpoint;
use posewire::faults::FaultPlan;
use posewire::replay::{self, ReplayOptions, Replayed};
use posewire::sink::Progress;
use posewire::stop::Stop;
use shown::Shown;
use std::fmt::Write;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

pub(super) fn run(arguments: &Replay) -> anyhow::Result<End> {
    arguments.again.capture.part.check()?;
    let stop = context::stop_on_interrupt()?;
    let targets = arguments.to.iter().map(|url| url.parse());
    let targets = targets.collect::<posewire::Result<Vec<Endpoint>>>()?;
    let plan = arguments.faults.as_deref().map(str::parse::<FaultPlan>).transpose()?;
    let replay = replay::Replay::open(&arguments.file, &targets, &options(arguments, plan.clone()))?;
    announce(arguments, &replay);
    if let Some(plan) = &plan {
        announce_faults(plan, &targets);
    }
    if !arguments.no_wait && !replay.is_ready() {
        say("waiting for somebody to connect");
        replay.wait_until_ready(&stop);
    }
    context::stop_after(&stop, arguments.duration);
    let shown = Shown::begin(arguments, &stop)?;
    let replayed = run_and_show(replay, &stop);
    shown.map_or(Ok(()), Shown::end)?;
    end_progress();
    let replayed = replayed?;
    if let Some(damage) = &replayed.damage {
        say(format_args!(
            "{}: the file is damaged: {damage}",
            arguments.file.display()
        ));
    }
    if arguments.json {
        json::print(&json::ReplayRecord::new(&replayed, plan.as_ref()))?;
    } else {
        say(summary(&replayed));
    }
    let is_damaged = replayed.damage.is_some();
    Ok(End::with_lost(replayed.lost() + u64::from(is_damaged)))
}

fn options(arguments: &Replay, faults: Option<FaultPlan>) -> ReplayOptions {
    ReplayOptions {
        speed: arguments.again.speed,
        looped: arguments.again.looped,
        from: arguments.again.capture.part.from.unwrap_or_default(),
        until: arguments.again.capture.part.until,
        only: arguments.again.capture.part.only.clone(),
        protocol: arguments.again.capture.protocol(),
        faults,
    }
}

fn announce(arguments: &Replay, replay: &replay::Replay) {
    let more = match replay.survey().files.len() {
        0 | 1 => String::new(),
        files => format!(" and {} after it", plural(files as u64 - 1, "file")),
    };
    say(format_args!("replaying {}{more}", arguments.file.display()));
    replay.sources().for_each(announce_source);
    let progress = replay.progress();
    let progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
    for target in &progress.targets {
        say(format_args!("  to {}", target.endpoint));
    }
    if let Some(words) = render::unread(&replay.survey().counts) {
        say(format_args!("of the capture could not be used: {words}"));
    }
}

fn announce_source(source: &CapturedSource) {
    let datagrams = plural(source.datagrams, "datagram");
    let seconds = source.span.map_or(0.0, |(first, last)| last.since(first).as_secs_f64());
    say(format_args!(
        "  {} {}: {datagrams} in {seconds:.3} s",
        source.number, source.name
    ));
}

/// Replays on a thread of its own and shows how far it is.
fn run_and_show(replay: replay::Replay, stop: &Stop) -> posewire::Result<Replayed> {
    let progress = replay.progress();
    let at_work = stop.clone();
    let running = thread::spawn(move || replay.run(&at_work));
    let mut peers = Peers::of(&targets(&progress));
    while !running.is_finished() {
        peers.tell(&targets(&progress));
        show_progress(line(&progress));
        // Also when asked to stop it has something to bring to its end.
        thread::sleep(LOOK_EVERY);
    }
    peers.tell(&targets(&progress));
    running.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// The targets, as those of a stream are told of.
fn targets(progress: &Mutex<Replayed>) -> Progress {
    let progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
    Progress {
        targets: progress.targets.clone(),
        ..Progress::default()
    }
}

fn line(progress: &Arc<Mutex<Replayed>>) -> String {
    let progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
    let seconds = progress.position.as_secs_f64();
    format!("{seconds:.1} s, {} datagrams", grouped(progress.datagrams))
}

fn summary(replayed: &Replayed) -> String {
    let mut text = format!(
        "replayed {}, lateness {}",
        plural(replayed.datagrams, "datagram"),
        replayed.lateness
    );
    for (count, why) in [
        (replayed.without_target, "left out: no target of their protocol"),
        (
            replayed.asked,
            "left out: questions of NatNet clients and their answers",
        ),
    ] {
        if count > 0 {
            _ = write!(text, "\n  {} {why}", plural(count, "datagram"));
        }
    }
    for target in &replayed.targets {
        text += &render::target_line(target);
    }
    if let Some(faults) = &replayed.faults {
        _ = write!(text, "\n{}", render::made(faults));
    }
    text
}

const LOOK_EVERY: Duration = Duration::from_millis(50);
