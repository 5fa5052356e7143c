//! How a stream went that we sent.

use super::{FaultsRecord, Spread};
use crate::faults::FaultPlan;
use crate::sink::{ClientProgress, ClientState, LeftOut, Progress, TargetProgress};
use serde::Serialize;

/// How a stream that we send is going, or went: what `posewire stream --json` prints at the end.
///
/// ```
/// use posewire::json::StreamRecord;
/// use posewire::sink::Progress;
///
/// let progress = Progress::default();
/// let json = serde_json::to_value(StreamRecord::new(&progress, 0, None))?;
/// assert_eq!((&json["kind"], &json["lost"]), (&"stream".into(), &0.into()));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Serialize)]
pub struct StreamRecord<'a> {
    kind: &'static str,
    frames: u64,
    lost: u64,
    unsent: u64,
    lateness_ms: Spread,
    targets: Vec<TargetRecord<'a>>,
    left_out: Vec<LeftOutRecord<'a>>,
    faults: Option<FaultsRecord>,
}

#[derive(Debug, Serialize)]
struct LeftOutRecord<'a> {
    what: &'a str,
    why: &'a str,
}

/// What became of what was sent to one target.
#[derive(Debug, Serialize)]
pub struct TargetRecord<'a> {
    endpoint: &'a str,
    peers: usize,
    datagrams: u64,
    congested: u64,
    failed: u64,
    dropped: u64,
    clients: Vec<ClientRecord<'a>>,
}

#[derive(Debug, Serialize)]
struct ClientRecord<'a> {
    address: String,
    name: &'a str,
    version: String,
    state: &'static str,
    frames: u64,
    dropped: u64,
}

impl<'a> StreamRecord<'a> {
    /// `unsent` is what of a live source was lost on this machine before it could be sent; `plan` are the faults on purpose.
    pub fn new(progress: &'a Progress, unsent: u64, plan: Option<&FaultPlan>) -> Self {
        let faults = plan.zip(progress.faults.as_ref());
        Self {
            kind: "stream",
            frames: progress.frames,
            lost: progress.lost() + unsent,
            unsent,
            lateness_ms: progress.lateness.into(),
            targets: progress.targets.iter().map(TargetRecord::of).collect(),
            left_out: progress.left_out.iter().map(LeftOutRecord::of).collect(),
            faults: faults.map(|(plan, counts)| FaultsRecord::new(plan, counts)),
        }
    }
}

impl<'a> TargetRecord<'a> {
    /// The record of a target.
    pub fn of(target: &'a TargetProgress) -> Self {
        Self {
            endpoint: &target.endpoint,
            peers: target.peers,
            datagrams: target.datagrams,
            congested: target.congested,
            failed: target.failed,
            dropped: target.dropped,
            clients: target.clients.iter().map(ClientRecord::of).collect(),
        }
    }
}

impl<'a> LeftOutRecord<'a> {
    fn of(entry: &'a LeftOut) -> Self {
        Self {
            what: &entry.what,
            why: entry.why,
        }
    }
}

impl<'a> ClientRecord<'a> {
    fn of(client: &'a ClientProgress) -> Self {
        Self {
            address: client.address.to_string(),
            name: &client.name,
            version: client.version.to_string(),
            state: match client.state {
                ClientState::Connected => "connected",
                ClientState::Left => "left",
                ClientState::Silent => "silent",
            },
            frames: client.frames,
            dropped: client.dropped,
        }
    }
}
