//! How a server is doing, for protocols that have one.

use std::net::SocketAddr;
use std::time::Duration;

use posewire_natnet::Version;
use posewire_natnet::client::Mode;

use super::StreamStatistics;
use crate::endpoint::NatNetAddress;
use crate::histogram::Summary;

/// What a NatNet server says, and how its frames arrive.
#[derive(Clone, Debug)]
pub struct ServerStatistics {
    /// What it calls itself; what is not UTF-8 is U+FFFD. Empty when it has never answered.
    pub name: String,
    /// Version of the application.
    pub app_version: Version,
    /// Its command endpoint, or where that was looked for.
    pub address: SocketAddr,
    /// Whether it answers now; otherwise the rest is what was last known.
    pub connected: bool,
    /// The version that its frames are read as.
    pub version: Version,
    /// How the frames come.
    pub mode: Mode,
    /// The group and port that were joined, when frames are multicast.
    pub group: Option<SocketAddr>,
    /// The interface that frames arrive on, as `192.168.1.5 (eth0)`, where it is known.
    pub interface: Option<String>,
    /// The frames, which hold all subjects.
    pub frames: StreamStatistics,
    /// Its clock against ours, as soon as it is known; servers before 3.0 do not tell it.
    pub clock: Option<Clock>,
    /// How long frames were on their way.
    pub latencies: Latencies,
    /// What its newest descriptions hold, once they have come.
    pub model: Option<ModelCounts>,
    /// Whether it records, where the version says (2.6 and later).
    pub recording: Option<bool>,
    /// Whether it plays a recording rather than live, where the version says (2.6 and later).
    pub edit_mode: Option<bool>,
    /// Bodies, skeletons and bones of all frames that could not be made motion.
    pub left_out: u64,
    /// Frames that came after the connection was lost and before the server had answered again, and could not be read.
    pub refused: u64,
    /// The endpoint to use, when the server says that it sends its frames another way than is expected.
    pub better: Option<NatNetAddress>,
}

/// A server's clock against ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// Nanoseconds of UTC at which the server's clock showed zero.
    pub offset_ns: i64,
    /// How far the offset can be off, either way.
    pub uncertainty: Duration,
    /// The time from the question for it to the answer.
    pub round_trip: Duration,
}

/// How long frames were on their way; each is absent where it cannot be known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Latencies {
    /// From the middle of the exposure to the sending by the server (3.0 and later, where the cameras can tell).
    pub camera_to_host: Option<Summary>,
    /// The part of that which the server's software took: from the cameras' data to the sending.
    pub software: Option<Summary>,
    /// From the sending to the arrival here, by the estimate of the server's clock: as far off as that.
    pub host_to_here: Option<Summary>,
}

/// How many of each a server describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModelCounts {
    /// Marker sets.
    pub marker_sets: usize,
    /// Rigid bodies of their own.
    pub rigid_bodies: usize,
    /// Skeletons.
    pub skeletons: usize,
    /// Assets, such as trained marker sets.
    pub assets: usize,
    /// Force plates.
    pub force_plates: usize,
    /// Other analog devices.
    pub devices: usize,
    /// Cameras.
    pub cameras: usize,
    /// Descriptions of a type that is not known.
    pub unknown: usize,
}
