//! The arguments of `posewire record`.

use super::remote::remote;
use super::value::seconds;
use clap::Args;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;

/// Record live streams: every datagram as it came, and the poses in them, into an MCAP file.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire record mxtp://0.0.0.0 -o take.mcap                 until Ctrl-C
  posewire record mxtp://0.0.0.0 natnet://10.0.0.7 -o take.mcap --duration 60
  posewire record mxtp+tcp://0.0.0.0 -o take.mcap --split-size 500
  posewire record mxtp://0.0.0.0 -o takes --remote 6004       takes that others begin and end

What has come is in the file a tenth of a second later. When this program or the machine dies, it can be \
read up to there, and posewire inspect take.mcap --recover completes it. Foxglove and other viewers of \
MCAP show the poses. With --split-size, take-002.mcap follows take.mcap.")]
pub(crate) struct Record {
    /// Where to listen, or which NatNet server to connect to; as many as there are systems.
    #[arg(value_name = "URL", required = true)]
    pub(crate) urls: Vec<String>,

    /// The .mcap file to write; one that is there is left alone. With --remote, the folder for the takes.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Begin a new file before one has more than so many megabytes.
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) split_size: Option<u64>,

    /// Replace the file if it is there and nobody records into it.
    #[arg(long)]
    pub(crate) overwrite: bool,

    /// Record takes, which begin and end by the commands of MVN's remote control: on this UDP port of this machine, or at
    /// ADDRESS:PORT; MVN's is 6004.
    #[arg(long, value_name = "PORT", value_parser = remote)]
    pub(crate) remote: Option<SocketAddr>,

    /// Print JSON: one object a second, and one at the end.
    #[arg(long)]
    pub(crate) json: bool,
}
