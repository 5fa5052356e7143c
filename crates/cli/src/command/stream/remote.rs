//! Remote control of a stream.

use super::sinks::Sinks;
use crate::context;
use posewire::Source;
use posewire::endpoint::Endpoint;
use posewire::remote::{PlayingControl, Remote};
use posewire::stop::Stop;
use std::net::SocketAddr;
use std::thread::JoinHandle;

/// Takes commands for a stream until `stop` is set. A take waits at its end for what comes next.
pub(super) fn serve(
    address: SocketAddr,
    sources: &[Source],
    sinks: &Sinks,
    stop: &Stop,
) -> posewire::Result<JoinHandle<()>> {
    let remote = Remote::bind(address)?;
    context::announce_remote(&remote);
    let mut control = PlayingControl::new();
    control.targets = sinks.targets();
    control.sources = sources.iter().map(|source| source.endpoint().clone()).collect();
    control.live = sources
        .iter()
        .any(|source| source.is_live() || matches!(source.endpoint(), Endpoint::Synthetic(_)));
    if let [source] = sources {
        control.playback = source.control();
    }
    if let Some(playback) = &control.playback {
        playback.stay_at_end();
    }
    let tell = Box::new(context::tell_of_remote);
    Ok(remote.serve(context::REMOTE_NAME, Box::new(control), tell, stop.clone()))
}
