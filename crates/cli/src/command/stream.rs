//! `posewire stream`: a source to MXTP and NatNet targets.

pub(super) mod peers;
pub(super) mod refuse;
mod remote;
mod sinks;
mod types;

use super::End;
use super::monitor::endpoints_of;
use crate::browser::Browser;
use crate::cli::{Playback, Stream};
use crate::context::{self, Teller, end_progress, say, show_progress};
use crate::{json, render};
use peers::Peers;
use posewire::endpoint::Endpoint;
use posewire::faults::FaultPlan;
use posewire::json::StreamRecord;
use posewire::sink::Progress;
use posewire::source::{PlaybackOptions, Preview};
use posewire::{Session, Source};
use posewire_mxtp::motion::MessageTypes;
use sinks::Sinks;
use std::time::Duration;

pub(super) fn run(arguments: &Stream) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    let from: Endpoint = arguments.source.parse()?;
    let targets = arguments
        .to
        .iter()
        .map(|url| url.parse())
        .collect::<posewire::Result<Vec<Endpoint>>>()?;
    refuse::endless(&from, &targets)?;
    let plan = arguments.faults.as_deref().map(str::parse::<FaultPlan>).transpose()?;
    refuse::capture(&arguments.playback.capture, &from)?;
    let sources = Source::open_all(&from, &playback_options(&arguments.playback, &targets))?;
    let is_live = sources.iter().any(Source::is_live);
    if is_live {
        refuse::playback(&arguments.playback)?;
        context::stop_after(&stop, arguments.playback.duration);
    }
    for source in &sources {
        refuse::endless(source.endpoint(), &targets)?;
    }
    let sinks = Sinks::open(arguments, &sources, &targets, plan.as_ref())?;
    let progress = sinks.progress();
    announce(&sources, sinks.types, &progress.read());
    if let Some(plan) = &plan {
        announce_faults(plan, &targets);
    }
    let browser = Browser::beside(arguments.beside.view, &endpoints_of(&sources))?;
    if let Some(address) = arguments.remote {
        remote::serve(address, &sources, &sinks, &stop)?;
    }
    let mut peers = Peers::of(&progress.read());
    if !is_live && !arguments.no_wait && !sinks.is_ready() {
        say("waiting for somebody to connect");
        sinks.wait_until_ready(&stop);
    }
    let teller = Teller::default();
    let mut boxes = sinks.into_boxes();
    boxes.push(Box::new(teller.clone()));
    boxes.extend(browser.as_ref().map(Browser::sink));
    let session = Session::start(sources, boxes, stop.clone());
    while !stop.wait(Duration::from_millis(200)) && session.is_running() {
        let progress = progress.read();
        peers.tell(&progress);
        show_progress(render::progress_line(&progress));
    }
    let outcome = session.wait();
    end_progress();
    let progress = progress.read();
    peers.tell(&progress);
    let unsent = teller.lost_here() + outcome.as_ref().map_or(0, |outcome| outcome.dropped);
    if arguments.json {
        json::print(&StreamRecord::new(&progress, unsent, plan.as_ref()))?;
    } else {
        say(render::stream_summary(&progress, unsent));
    }
    outcome?;
    Ok(End::with_lost(
        progress.lost() + unsent + u64::from(teller.is_damaged()),
    ))
}

/// Says what is to go wrong, and what of it has no place at a target.
pub(super) fn announce_faults(plan: &FaultPlan, targets: &[Endpoint]) {
    say(format_args!("faults on purpose: {plan}"));
    let without: Vec<_> = [("drift", plan.drift_ppm), ("nan", plan.nan)]
        .into_iter()
        .filter(|(_, amount)| *amount != 0.0)
        .map(|(name, _)| name)
        .collect();
    let is_natnet = |target: &&Endpoint| matches!(target, Endpoint::NatNet(_));
    if let Some(target) = targets.iter().find(is_natnet).filter(|_| !without.is_empty()) {
        say(format_args!(
            "  {target}: without {}, which NatNet frames do not meet",
            without.join(" and ")
        ));
    }
}

fn playback_options(arguments: &Playback, targets: &[Endpoint]) -> PlaybackOptions {
    PlaybackOptions {
        rate_hz: arguments.rate,
        speed: arguments.speed,
        looped: arguments.looped,
        duration: arguments.duration,
        salvage: arguments.salvage,
        // NatNet has no place for any of it.
        computes: targets.iter().any(|target| !matches!(target, Endpoint::NatNet(_))),
        only: arguments.capture.part.only.clone(),
        from: arguments.capture.part.from.unwrap_or_default(),
        until: arguments.capture.part.until,
        protocol: arguments.capture.protocol(),
    }
}

fn announce(sources: &[Source], types: Option<MessageTypes>, progress: &Progress) {
    let types = types.map_or_else(String::new, |types| format!(", types {types}"));
    for source in sources {
        let who = source.preview().map_or_else(String::new, render::who);
        let who = source.captured().map_or(who, |captured| format!(", {}", captured.name));
        say(format_args!("streaming {}{who}{types}", source.endpoint()));
    }
    for target in &progress.targets {
        say(format_args!("  to {}", target.endpoint));
    }
    for preview in sources.iter().filter_map(Source::preview) {
        announce_guesses(preview);
    }
}

/// Says what of the stream is not from the take.
fn announce_guesses(preview: &Preview) {
    if !preview.states_rate {
        say(format_args!(
            "the take does not state its rate: {} Hz is assumed",
            preview.rate_hz
        ));
    }
    if !preview.computed.is_empty() {
        say(format_args!(
            "computed, as the take lacks it: {}",
            preview.computed.join(", ")
        ));
    }
}
