//! What was done to a stream on purpose.

use crate::faults::{FaultCounts, FaultKind, FaultPlan, FaultedStream};
use serde::Serialize;
use std::collections::BTreeMap;

/// What was done to a stream on purpose.
#[derive(Debug, Serialize)]
pub struct FaultsRecord {
    plan: String,
    taken: u64,
    sent: u64,
    made: BTreeMap<&'static str, u64>,
    streams: Vec<StreamFaults>,
}

#[derive(Debug, Serialize)]
struct StreamFaults {
    character: Option<u8>,
    r#type: Option<String>,
    made: BTreeMap<&'static str, u64>,
}

impl FaultsRecord {
    /// The record of what was done by a plan.
    pub fn new(plan: &FaultPlan, counts: &FaultCounts) -> Self {
        Self {
            plan: plan.to_string(),
            taken: counts.taken,
            sent: counts.sent,
            made: counts.iter().map(|(kind, count)| (kind.name(), count)).collect(),
            streams: counts
                .streams()
                .map(|stream| StreamFaults::of(stream, counts))
                .collect(),
        }
    }
}

impl StreamFaults {
    fn of(stream: FaultedStream, counts: &FaultCounts) -> Self {
        let made = FaultKind::ALL.map(|kind| (kind.name(), counts.in_stream(stream, kind)));
        Self {
            character: stream.character,
            r#type: stream.kind.map(|kind| kind.to_string()),
            made: made.into_iter().filter(|(_, count)| *count > 0).collect(),
        }
    }
}
