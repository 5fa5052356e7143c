//! `posewire stream`: a source to MXTP targets.

use super::End;
use crate::cli::{Playback, Revision, Stream};
use crate::context::{self, Teller, end_progress, say, show_progress};
use crate::error::Usage;
use crate::plain::plural;
use crate::{json, render};
use posewire::endpoint::{Endpoint, Host};
use posewire::sink::{MxtpSink, MxtpSinkOptions, Progress};
use posewire::source::{PlaybackOptions, Preview};
use posewire::{Session, Sink, Source};
use posewire_mxtp::MessageType;
use posewire_mxtp::motion::{MessageTypes, lacks};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

pub(super) fn run(arguments: &Stream) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    let from: Endpoint = arguments.source.parse()?;
    let targets = arguments
        .to
        .iter()
        .map(|url| url.parse())
        .collect::<posewire::Result<Vec<Endpoint>>>()?;
    let source = Source::open(&from, &playback_options(&arguments.playback))?;
    let types = choose_types(&arguments.types, source.preview())?;
    if source.is_live() {
        refuse_playback(&arguments.playback)?;
        context::stop_after(&stop, arguments.playback.duration);
    }
    let options = MxtpSinkOptions {
        types,
        revision: match arguments.revision {
            Revision::N => posewire_mxtp::Revision::N,
            Revision::J => posewire_mxtp::Revision::J,
        },
        split: arguments.split.map(|bytes| bytes as usize),
        character: arguments.character,
        name: arguments.name.clone(),
    };
    refuse_too_many(&source, &options)?;
    refuse_loop(source.endpoint(), &targets)?;
    let sink = MxtpSink::open(&targets, options.clone())?;
    let progress = sink.progress();
    announce(&source, &options, &read(&progress));
    if !source.is_live() && !sink.is_ready() {
        say("waiting for somebody to connect");
        sink.wait_until_ready(&stop);
    }
    let teller = Teller::default();
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(sink), Box::new(teller.clone())];
    let session = Session::start(source, sinks, stop.clone());
    let mut peers = peers_of(&read(&progress));
    while !stop.wait(Duration::from_millis(200)) && session.is_running() {
        let progress = read(&progress);
        tell_of_peers(&mut peers, &progress);
        show_progress(render::progress_line(&progress));
    }
    let outcome = session.wait();
    end_progress();
    let progress = read(&progress);
    let unsent = teller.kernel_dropped() + outcome.as_ref().map_or(0, |outcome| outcome.dropped);
    if arguments.json {
        json::print(&json::StreamRecord::new(&progress, unsent))?;
    } else {
        say(render::stream_summary(&progress, unsent));
    }
    outcome?;
    Ok(End::with_lost(progress.lost() + unsent))
}

/// A live stream comes as it comes: options that would be ignored are refused.
fn refuse_playback(arguments: &Playback) -> Result<(), Usage> {
    let given = [
        ("--rate", arguments.rate.is_some()),
        ("--speed", arguments.speed.to_bits() != 1_f64.to_bits()),
        ("--loop", arguments.looped),
        ("--salvage", arguments.salvage),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!("{option} is for takes and the walker, and the source is a live stream"),
            help: format!("leave {option} out"),
        }),
    }
}

/// Every subject needs a character number that fits into a byte.
fn refuse_too_many(source: &Source, options: &MxtpSinkOptions) -> posewire::Result<()> {
    let last = source
        .preview()
        .and_then(|preview| preview.subjects.iter().map(|subject| subject.id).max());
    let found = u32::from(options.character).saturating_add(last.unwrap_or(0));
    if found > u32::from(u8::MAX) {
        return Err(posewire::Error::Character { found });
    }
    Ok(())
}

/// What is received on a port and sent to the same port of this machine comes back for ever.
fn refuse_loop(source: &Endpoint, targets: &[Endpoint]) -> Result<(), Usage> {
    let Endpoint::MxtpUdp(source) = source else {
        return Ok(());
    };
    let comes_back = |target: &&Endpoint| match target {
        Endpoint::MxtpUdp(target) => {
            let here = matches!(&target.host, Host::Address(address) if address.is_loopback());
            target.port == source.port && (here || target.host == source.host)
        }
        _ => false,
    };
    match targets.iter().find(comes_back) {
        None => Ok(()),
        Some(target) => Err(Usage {
            problem: format!(
                "what comes in on port {} would be sent to itself, {target}",
                source.port
            ),
            help: "name another target with --to".to_owned(),
        }),
    }
}

/// How many peers each target has.
fn peers_of(progress: &Progress) -> Vec<usize> {
    progress.targets.iter().map(|target| target.peers).collect()
}

/// Says where a peer has come or gone since `known`.
fn tell_of_peers(known: &mut Vec<usize>, progress: &Progress) {
    for (before, target) in known.iter().zip(&progress.targets) {
        if *before != target.peers {
            let peers = plural(target.peers as u64, "peer");
            end_progress();
            say(format_args!("{}: {peers} connected", target.endpoint));
        }
    }
    *known = peers_of(progress);
}

fn playback_options(arguments: &Playback) -> PlaybackOptions {
    PlaybackOptions {
        rate_hz: arguments.rate,
        speed: arguments.speed,
        looped: arguments.looped,
        duration: arguments.duration,
        salvage: arguments.salvage,
    }
}

fn read(progress: &Mutex<Progress>) -> Progress {
    progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn announce(source: &Source, options: &MxtpSinkOptions, progress: &Progress) {
    let who = source.preview().map_or_else(String::new, render::who);
    say(format_args!(
        "streaming {}{who}, types {}",
        source.endpoint(),
        options.types
    ));
    for target in &progress.targets {
        say(format_args!("  to {}", target.endpoint));
    }
    if let Some(preview) = source.preview() {
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

/// The types asked for. `all` leaves out what the source cannot give and says so; a type asked for by number is refused
/// when the source cannot give it.
fn choose_types(text: &str, preview: Option<&Preview>) -> anyhow::Result<MessageTypes> {
    let wanted = parse_types(text)?;
    let mut types = MessageTypes::NONE;
    for message_type in wanted.iter() {
        let why = preview.and_then(|preview| preview.first.iter().find_map(|frame| lacks(frame, message_type)));
        match why {
            None => types = types.with(message_type),
            Some(why) if text == "all" => say(format_args!("leaving out {}: it has {why}", describe(message_type))),
            Some(why) => return Err(cannot_give(message_type, why)),
        }
    }
    Ok(types)
}

fn describe(message_type: MessageType) -> String {
    format!("type {message_type} ({})", message_type.name())
}

fn cannot_give(message_type: MessageType, why: &str) -> anyhow::Error {
    let problem = format!("cannot send {}: the source has {why}", describe(message_type));
    let help = format!("leave {message_type} out of --types, or use --types all to send whatever there is");
    Usage { problem, help }.into()
}

fn parse_types(text: &str) -> Result<MessageTypes, Usage> {
    let types = text.parse().unwrap_or(MessageTypes::NONE);
    let unknown = types
        .iter()
        .any(|message_type| !MessageTypes::ALL.contains(message_type));
    if types.is_empty() || unknown {
        return Err(Usage {
            problem: format!("expected datagram types with two digits and commas as --types, found {text:?}"),
            help: format!("use all, or some of {}", MessageTypes::ALL),
        });
    }
    Ok(types)
}
