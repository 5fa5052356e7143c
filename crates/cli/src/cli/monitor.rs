//! The arguments of `posewire monitor`.

use super::capture::Again;
use super::value::seconds;
use super::view::Beside;
use clap::Args;
use std::time::Duration;

/// Receive a stream, check it and show it.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire monitor                                   whatever arrives on UDP port 9763
  posewire monitor mxtp+tcp://0.0.0.0                let MVN connect over TCP
  posewire monitor \"mxtp://239.255.42.99?interface=eth0\"
  posewire monitor natnet://10.0.0.7                 Motive there, unicast
  posewire monitor \"natnet://10.0.0.7?mode=multicast&interface=eth0\"
  posewire monitor natnet://0.0.0.0                  whichever NatNet server answers
  posewire monitor --json --frames --count 240 > frames.jsonl
  posewire monitor take.mcap                         a recording, as if it came now

In MVN: Options > Preferences > Network Streamer, add this machine's address with port 9763.
In Motive: Settings > Streaming, Enable, and as Local Interface the network that you share.")]
pub(crate) struct Monitor {
    /// Where to listen, which NatNet server to connect to, or a recording or capture to play.
    #[arg(default_value = "mxtp://0.0.0.0:9763")]
    pub(crate) url: String,

    /// Print JSON: one object a second for each character and datagram type, or for a server.
    #[arg(long)]
    pub(crate) json: bool,

    /// With --json, also one object for each sample, in metres, radians and seconds, Z up.
    #[arg(long, requires = "json")]
    pub(crate) frames: bool,

    /// Print a table a second instead of the live page, as when the output is no terminal.
    #[arg(long)]
    pub(crate) plain: bool,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    #[command(flatten)]
    pub(crate) again: Again,

    /// Stop after so many samples, of all characters together.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) count: Option<u64>,

    #[command(flatten)]
    pub(crate) beside: Beside,
}
