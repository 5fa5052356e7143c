//! How a stream went that we sent.

use super::Spread;
use posewire::sink::Progress;
use serde::Serialize;

/// How a stream went that we sent.
#[derive(Serialize)]
pub(crate) struct StreamRecord<'a> {
    kind: &'static str,
    frames: u64,
    lost: u64,
    unsent: u64,
    lateness_ms: Spread,
    targets: Vec<TargetRecord<'a>>,
}

#[derive(Serialize)]
struct TargetRecord<'a> {
    endpoint: &'a str,
    peers: usize,
    datagrams: u64,
    congested: u64,
    failed: u64,
    dropped: u64,
}

impl<'a> StreamRecord<'a> {
    /// `unsent` is what of a live source was lost on this machine before it could be sent.
    pub(crate) fn new(progress: &'a Progress, unsent: u64) -> Self {
        let targets = progress.targets.iter().map(|target| TargetRecord {
            endpoint: &target.endpoint,
            peers: target.peers,
            datagrams: target.datagrams,
            congested: target.congested,
            failed: target.failed,
            dropped: target.dropped,
        });
        Self {
            kind: "stream",
            frames: progress.frames,
            lost: progress.lost() + unsent,
            unsent,
            lateness_ms: progress.lateness.into(),
            targets: targets.collect(),
        }
    }
}
