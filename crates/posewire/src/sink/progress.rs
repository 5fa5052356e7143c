//! How far a stream has come.

use crate::Notice;
use crate::faults::FaultCounts;
use crate::histogram::Summary;
use posewire_natnet::Version;
use std::net::SocketAddr;

/// How far a stream has come.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Frames sent, each subject's its own.
    pub frames: u64,
    /// How long after they were due they were on their way.
    pub lateness: Summary,
    /// Each target, in the order given.
    pub targets: Vec<TargetProgress>,
    /// What of the source cannot be sent, each once.
    pub left_out: Vec<LeftOut>,
    /// What was done to the datagrams on purpose, where a plan says so; in all targets together.
    pub faults: Option<FaultCounts>,
}

/// Something of the source that cannot be sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// What it is.
    pub what: String,
    /// Why it cannot, in words that fit behind a colon.
    pub why: &'static str,
}

impl Progress {
    /// The progress of one stream that several sinks send: all targets, the most frames, the lateness of the sink
    /// that was latest, and what any of them leaves out, once.
    pub fn of_all(sinks: impl IntoIterator<Item = Self>) -> Self {
        sinks.into_iter().reduce(Self::beside).unwrap_or_default()
    }

    /// Datagrams and samples that did not reach their target for a reason on this side.
    pub fn lost(&self) -> u64 {
        self.targets
            .iter()
            .map(|target| target.congested + target.failed + target.dropped)
            .sum()
    }

    fn beside(mut self, other: Self) -> Self {
        self.frames = self.frames.max(other.frames);
        if other.lateness.max > self.lateness.max {
            self.lateness = other.lateness;
        }
        self.targets.extend(other.targets);
        for entry in other.left_out {
            if !self.left_out.contains(&entry) {
                self.left_out.push(entry);
            }
        }
        self.faults = match (self.faults, other.faults) {
            (Some(ours), Some(others)) => Some(ours.and(&others)),
            (ours, others) => ours.or(others),
        };
        self
    }
}

/// What became of what was sent to one target.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TargetProgress {
    /// The target's endpoint.
    pub endpoint: String,
    /// Peers connected now, at the end those that were served to it; where nobody connects, as with MXTP over UDP and
    /// multicast, always 1.
    pub peers: usize,
    /// Datagrams that the system took.
    pub datagrams: u64,
    /// UDP datagrams that the system had no room for.
    pub congested: u64,
    /// UDP datagrams that the system refused, and samples that no datagram can hold.
    pub failed: u64,
    /// Samples that a TCP peer took too slowly, or that came while one that we connect to was away.
    pub dropped: u64,
    /// Who has connected to a NatNet target, those who have left included, in the order in which they came.
    pub clients: Vec<ClientProgress>,
    /// Who came and went, the newest 100 and those last. A target that nobody connects to has none.
    pub notices: Vec<Notice>,
}

/// What became of what was sent to one NatNet client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClientProgress {
    /// Where it connected from.
    pub address: SocketAddr,
    /// What it calls itself; empty where it does not say.
    pub name: String,
    /// The bitstream that it gets.
    pub version: Version,
    /// Whether it is still there.
    pub state: ClientState,
    /// Frames that left for it. What its own system drops because it does not read is not known here.
    pub frames: u64,
    /// Frames for it that the system here had no room for or refused.
    pub dropped: u64,
}

/// Whether a NatNet client is still there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClientState {
    /// It gets frames.
    Connected,
    /// It has said goodbye.
    Left,
    /// It was dropped, and told so, because nothing came from it any more.
    Silent,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn several_sinks_show_as_one_stream() {
        let progress = |frames, milliseconds, endpoint: &str, congested| Progress {
            frames,
            lateness: Summary {
                max: Duration::from_millis(milliseconds),
                ..Summary::default()
            },
            targets: vec![TargetProgress {
                endpoint: endpoint.to_owned(),
                congested,
                ..TargetProgress::default()
            }],
            left_out: vec![LeftOut {
                what: "velocities".to_owned(),
                why: "there is no place",
            }],
            faults: None,
        };
        let all = Progress::of_all([progress(240, 3, "mxtp://a", 1), progress(238, 5, "natnet://b", 2)]);
        let endpoints: Vec<_> = all.targets.iter().map(|target| target.endpoint.as_str()).collect();
        assert_eq!(endpoints, ["mxtp://a", "natnet://b"]);
        assert_eq!((all.frames, all.lateness.max.as_millis(), all.lost()), (240, 5, 3));
        assert_eq!(all.left_out.len(), 1, "it is said once");
    }
}
