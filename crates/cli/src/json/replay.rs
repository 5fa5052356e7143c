//! How a replay went.

use posewire::faults::FaultPlan;
use posewire::json::{FaultsRecord, Spread, TargetRecord};
use posewire::replay::Replayed;
use serde::Serialize;

/// How a replay went.
#[derive(Serialize)]
pub(crate) struct ReplayRecord<'a> {
    kind: &'static str,
    datagrams: u64,
    bytes: u64,
    rounds: u64,
    lost: u64,
    without_target: u64,
    asked: u64,
    lateness_ms: Spread,
    targets: Vec<TargetRecord<'a>>,
    faults: Option<FaultsRecord>,
    damage: Option<&'a str>,
}

impl<'a> ReplayRecord<'a> {
    pub(crate) fn new(replayed: &'a Replayed, plan: Option<&FaultPlan>) -> Self {
        let faults = plan.zip(replayed.faults.as_ref());
        Self {
            kind: "replay",
            datagrams: replayed.datagrams,
            bytes: replayed.bytes,
            rounds: replayed.rounds,
            lost: replayed.lost(),
            without_target: replayed.without_target,
            asked: replayed.asked,
            lateness_ms: replayed.lateness.into(),
            targets: replayed.targets.iter().map(TargetRecord::of).collect(),
            faults: faults.map(|(plan, counts)| FaultsRecord::new(plan, counts)),
            damage: replayed.damage.as_deref(),
        }
    }
}
