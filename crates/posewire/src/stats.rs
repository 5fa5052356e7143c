//! How a stream is doing: counted in one place, shown by everything.
//!
//! Every protocol is counted in the same terms. A *stream* is a run of datagrams that share one numbering, so that what is
//! missing can be told: of MXTP each message type of each character, of NatNet the frames of the server. Streams of a
//! subject stand with it, those of a server stand with the server; [`Statistics::streams`] gives all of them.

mod arrivals;
mod kind;
mod mxtp;
mod natnet;
mod server;
mod transit;

pub use kind::{DatagramKind, Quirk};
pub use server::{Clock, Latencies, ModelCounts, ServerStatistics};
pub use transit::{Clocks, Transit};

pub(crate) use mxtp::{Edge, Tally};
pub(crate) use natnet::{Link, NatNetTally};

use std::sync::Arc;
use std::time::Duration;

use posewire_motion::{Stamp, Subject, Timecode};
pub use posewire_mxtp::SampleCounts;

use crate::histogram::Summary;

/// How a live stream is doing, since it was opened.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// When this was counted.
    pub at: Stamp,
    /// Since when it is counted.
    pub elapsed: Duration,
    /// Whether the stream has ended and these are the last numbers, with rates over its whole time.
    pub ended: bool,
    /// Datagrams that arrived, of whatever kind.
    pub datagrams: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Datagrams that could not be read at all.
    pub malformed: u64,
    /// What was wrong with the last one of these.
    pub last_malformed: Option<String>,
    /// Bytes of a TCP stream that belonged to no datagram.
    pub skipped_bytes: u64,
    /// Datagrams that the kernel dropped because this program took them too slowly.
    pub kernel_dropped: u64,
    /// Datagrams of characters beyond the 64 that are followed.
    pub characters_refused: u64,
    /// Each subject that was heard of, by its number.
    pub subjects: Vec<SubjectStatistics>,
    /// The server that it comes from, for protocols that have one and once something has come from it.
    pub server: Option<Box<ServerStatistics>>,
}

/// How one subject of a live stream is doing.
#[derive(Clone, Debug)]
pub struct SubjectStatistics {
    /// Who it is.
    pub subject: Arc<Subject>,
    /// The time of day of its newest sample, where the source says.
    pub timecode: Option<Timecode>,
    /// The streams that are its own, by kind; none where a server's frames hold every subject.
    pub streams: Vec<StreamStatistics>,
    /// What became of its samples; `None` where it shares them with others, as all subjects of a NatNet server do.
    pub samples: Option<SampleCounts>,
    /// How long its samples were on their way; `None` where that is told of its server.
    pub transit: Option<Transit>,
    /// How much of it is tracked, where the protocol says; `None` also for one without segments.
    pub tracking: Option<Tracking>,
}

/// How well a subject is tracked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tracking {
    /// Its segments: 1 for a rigid body, the bones of a skeleton.
    pub segments: usize,
    /// How many of them are tracked in the newest frame; 0 when the frame does not hold the subject.
    pub tracked: usize,
    /// Frames in which not all of them were tracked, since the subject was first heard of.
    pub frames_untracked: u64,
    /// Whether no frame has held it yet.
    pub awaited: bool,
}

/// How the datagrams of one kind and one numbering are doing.
#[derive(Clone, Debug)]
pub struct StreamStatistics {
    /// What kind they are.
    pub kind: DatagramKind,
    /// Whole messages a second: since the statistics before these, or over all the time when the stream has ended.
    pub rate_hz: f64,
    /// What arrived and what did not.
    pub counters: Counters,
    /// The time between a message and the next.
    pub interval: Summary,
}

/// What arrived of a stream and what did not.
///
/// What has no sample counter to go by has `datagrams`, `received`, `malformed` and `quirks` only.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Datagrams that decode.
    pub datagrams: u64,
    /// Whole messages, duplicates left out.
    pub received: u64,
    /// Samples of which nothing came, in strides.
    pub missing: u64,
    /// Messages that came again.
    pub duplicate: u64,
    /// Messages that came after a newer sample's.
    pub late: u64,
    /// How often the sample counter started anew; of NatNet, how often the frame number jumped, whichever way.
    pub reset: u64,
    /// How often the sample counter was wound back, but not to its beginning.
    pub rewound: u64,
    /// How often the sample counter went forward further than the time that passed explains.
    pub jumped: u64,
    /// Datagrams that do not decode.
    pub malformed: u64,
    /// Split messages that never became whole.
    pub incomplete: u64,
    /// By how much the sample counter goes up; `None` before the second sample.
    pub stride: Option<u32>,
    /// Datagrams that deviate from the specification, by how they do; only those that were found, in order.
    pub quirks: Vec<(Quirk, u64)>,
}

impl Counters {
    /// How often a new numbering began, however.
    pub const fn restarts(&self) -> u64 {
        self.reset + self.rewound + self.jumped
    }
}

impl Statistics {
    /// Every stream: that of the server, then those of each subject with the subject.
    pub fn streams(&self) -> impl Iterator<Item = (Option<&Arc<Subject>>, &StreamStatistics)> {
        let server = self.server.iter().map(|server| (None, &server.frames));
        let subjects = self.subjects.iter().flat_map(|of| {
            let streams = of.streams.iter();
            streams.map(|stream| (Some(&of.subject), stream))
        });
        server.chain(subjects)
    }

    /// Datagrams that arrived on this machine and were lost here: dropped by the kernel, or refused while no server was
    /// connected that says their version.
    pub fn lost_here(&self) -> u64 {
        self.kernel_dropped + self.server.as_ref().map_or(0, |server| server.refused)
    }
}
