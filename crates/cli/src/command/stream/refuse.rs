//! What cannot be streamed, found before anything is sent.

use crate::cli::{Capture, Playback, Revision, Stream};
use crate::error::Usage;
use posewire::Source;
use posewire::endpoint::{Endpoint, Host, NatNetAddress};
use posewire::sink::MxtpSinkOptions;
use posewire_natnet::client::Mode;

/// A live stream comes as it comes: options that would be ignored are refused.
pub(super) fn playback(arguments: &Playback) -> Result<(), Usage> {
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

/// What is no capture has no sources to choose from, and no part ends before it begins.
pub(in crate::command) fn capture(arguments: &Capture, source: &Endpoint) -> Result<(), Usage> {
    if matches!(source, Endpoint::Capture { .. }) {
        return arguments.part.check();
    }
    match arguments.given().into_iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!("{option} is for recordings and captures, found {source}"),
            help: format!("leave {option} out"),
        }),
    }
}

/// Options of MXTP that no target would heed are refused as well.
pub(super) fn mxtp_options(arguments: &Stream) -> Result<(), Usage> {
    let given = [
        ("--types", arguments.types != Stream::TYPES),
        ("--character", arguments.character != 0),
        ("--revision", !matches!(arguments.revision, Revision::N)),
        ("--split", arguments.split.is_some()),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!("{option} is for MXTP targets, and there is none"),
            help: format!("leave {option} out, or name an MXTP target with --to"),
        }),
    }
}

/// Only a server that sends to each client has clients to drop.
pub(super) fn silence(arguments: &Stream, targets: &[&NatNetAddress]) -> Result<(), Usage> {
    let has_clients = targets.iter().any(|target| target.mode == Mode::Unicast);
    if arguments.silence.is_none() || has_clients {
        return Ok(());
    }
    Err(Usage {
        problem: "--silence is for unicast NatNet targets, and there is none".to_owned(),
        help: "leave --silence out, or name a target such as natnet://0.0.0.0 with --to".to_owned(),
    })
}

/// The frames of a NatNet server have one numbering, and sources have one each.
pub(super) fn several(sources: &[Source], targets: &[&NatNetAddress]) -> Result<(), Usage> {
    let captured = sources.iter().filter_map(Source::captured);
    let found: Vec<_> = captured
        .map(|source| format!("{} {}", source.number, source.name))
        .collect();
    if targets.is_empty() || found.len() < 2 {
        return Ok(());
    }
    Err(Usage {
        problem: format!("a natnet:// target takes one source, found {}", found.join(", ")),
        help: "choose one by number or name, as in --only 0; mxtp:// targets take all of them".to_owned(),
    })
}

/// Every subject needs a character number that fits into a byte.
pub(super) fn too_many(source: &Source, options: &MxtpSinkOptions) -> posewire::Result<()> {
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
pub(super) fn endless(source: &Endpoint, targets: &[Endpoint]) -> Result<(), Usage> {
    match targets.iter().find(|target| comes_back(source, target)) {
        None => Ok(()),
        Some(target) => Err(Usage {
            problem: format!("what comes in from {source} would be sent to itself, {target}"),
            help: "name another target with --to".to_owned(),
        }),
    }
}

fn comes_back(source: &Endpoint, target: &Endpoint) -> bool {
    let is_here = |host: &Host| matches!(host, Host::Address(address) if address.is_loopback());
    match (source, target) {
        (Endpoint::MxtpUdp(source), Endpoint::MxtpUdp(target)) => {
            target.port == source.port && (is_here(&target.host) || target.host == source.host)
        }
        (Endpoint::NatNet(source), Endpoint::NatNet(target)) => {
            target.port == source.port && (is_here(&source.host) || target.host == source.host)
        }
        _ => false,
    }
}
