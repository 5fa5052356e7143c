//! How far a stream has come.

use crate::histogram::Summary;

/// How far a stream has come.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Frames sent.
    pub frames: u64,
    /// How long after they were due they were on their way.
    pub lateness: Summary,
    /// Each target, in the order given.
    pub targets: Vec<TargetProgress>,
}

impl Progress {
    /// Datagrams and samples that did not reach their target for a reason on this side.
    pub fn lost(&self) -> u64 {
        self.targets
            .iter()
            .map(|target| target.congested + target.failed + target.dropped)
            .sum()
    }
}

/// What became of what was sent to one target.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TargetProgress {
    /// The target's endpoint.
    pub endpoint: String,
    /// Peers connected now, at the end those that were served to it; of UDP always 1.
    pub peers: usize,
    /// Datagrams that the system took.
    pub datagrams: u64,
    /// UDP datagrams that the system had no room for.
    pub congested: u64,
    /// UDP datagrams that the system refused.
    pub failed: u64,
    /// Samples that a TCP peer took too slowly, or that came while one that we connect to was away.
    pub dropped: u64,
}
