//! The arguments of `posewire stream`.

use super::capture::Capture;
use super::remote::remote;
use super::value::seconds;
use clap::{Args, ValueEnum};
use std::net::SocketAddr;
use std::time::Duration;

/// Send a take, a walker or a live stream as MVN's Network Streamer would, or as Motive.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire stream take.mvnx                                  to this machine, UDP port 9763
  posewire stream take.mvnx --to mxtp://192.168.1.20 --loop
  posewire stream take.mvnx --to mxtp+tcp://robot --types all
  posewire stream \"synthetic:walk?people=3\" --to \"mxtp://239.255.42.99?interface=eth0\"
  posewire stream mxtp://0.0.0.0 --to mxtp://10.0.0.5 --to mxtp+tcp://10.0.0.6   pass it on
  posewire stream take.mvnx --to natnet://0.0.0.0            be Motive to NatNet clients
  posewire stream take.mvnx --to \"natnet://0.0.0.0?mode=multicast&interface=eth0\"
  posewire stream natnet://10.0.0.7 --to mxtp://10.0.0.5     Motive's skeletons as MVN's characters
  posewire stream take.mvnx --remote 6004                    paused and moved in by other programs
  posewire stream synthetic:walk --faults loss=1%,reorder=1%,reset@10s,seed=7   with what goes wrong

A take begins when somebody has connected, unless there is a target to which nobody has to connect.
--types, --character, --revision and --split are for MXTP targets.")]
pub(crate) struct Stream {
    /// What to send: a take, synthetic:walk, or a live stream to pass on.
    pub(crate) source: String,

    /// Where to send it; may be given many times.
    #[arg(long, value_name = "URL", default_value = "mxtp://127.0.0.1:9763")]
    pub(crate) to: Vec<String>,

    /// Datagram types for MXTP targets, by number and with commas, or `all`.
    ///
    /// 01 Euler, 02 quaternion, 03 points, 05 Unity, 12 meta, 13 scale, 20 joint angles, 21 linear and 22 angular
    /// kinematics, 23 trackers, 24 centre of mass, 25 timecode. What a take lacks is computed where that is possible;
    /// a centre of mass is then an estimate.
    #[arg(long, value_name = "TYPES", default_value = Self::TYPES)]
    pub(crate) types: String,

    #[command(flatten)]
    pub(crate) playback: Playback,

    /// The number of the first MXTP character, from 0; MVN shows it plus one.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) character: u8,

    /// A name instead of the subject's own.
    #[arg(long, value_name = "NAME")]
    pub(crate) name: Option<String>,

    /// The revision of the MXTP header: N is MVN 2019 and later, J what was before.
    #[arg(long, value_enum, ignore_case = true, default_value = "n")]
    pub(crate) revision: Revision,

    /// Split MXTP pose data into datagrams of at most so many bytes. MVN does not, and some receivers cannot take it.
    #[arg(long, value_name = "BYTES", value_parser = clap::value_parser!(u32).range(100..=65_507))]
    pub(crate) split: Option<u32>,

    /// Misbehave on purpose, to test who receives: any of
    /// loss=1%,burst=0.1%x20,dup=0.5%,reorder=1%,jitter=5ms,drift=200ppm,reset@10s,rewind@15s-2s,truncate=0.1%,flip=0.01%,
    /// nan=0.1%,silence@20s+3s,seed=7.
    ///
    /// Shares are of all datagrams, times are since the stream began. The same seed makes the same faults.
    #[arg(long, value_name = "PLAN")]
    pub(crate) faults: Option<String>,

    /// Take the commands of MVN's remote control on this UDP port of this machine, or at ADDRESS:PORT; MVN's is 6004.
    ///
    /// They pause the stream, move in it, and add and remove MXTP targets. A take then waits at its end for more.
    #[arg(long, value_name = "PORT", value_parser = remote)]
    pub(crate) remote: Option<SocketAddr>,

    /// Begin at once, also when nobody has connected yet.
    #[arg(long)]
    pub(crate) no_wait: bool,

    /// Drop a NatNet client that has said nothing for so many seconds; 10 unless set. Multicast has no clients.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) silence: Option<Duration>,

    /// Print the numbers at the end as one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

impl Stream {
    /// The types that MVN sends unless told otherwise.
    pub(crate) const TYPES: &str = "02,12,13,20,24,25";
}

/// How a file or the walker is played.
#[derive(Debug, Args)]
pub(crate) struct Playback {
    /// Send only so many samples a second; they keep their own sample numbers.
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub(crate) rate: Option<f64>,

    /// Play so many times as fast as recorded.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) speed: f64,

    /// Begin again at the end; sample numbers go on.
    #[arg(long = "loop")]
    pub(crate) looped: bool,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Use a damaged file up to the damage.
    #[arg(long)]
    pub(crate) salvage: bool,

    #[command(flatten)]
    pub(crate) capture: Capture,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Revision {
    N,
    J,
}
