//! The arguments of `posewire replay`.

use super::capture::Again;
use super::value::seconds;
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;

/// Send a recording or a capture again: the same bytes in the same order with the same gaps.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire replay take.mcap --to mxtp://127.0.0.1
  posewire replay take.pcapng --to mxtp+tcp://robot --speed 0.5 --loop
  posewire replay take.mcap --to mxtp://10.0.0.5 --from 10 --until 12.5 --only 0
  posewire replay motive.mcap --to natnet://0.0.0.0           be the Motive that was recorded
  posewire replay take.mcap --to mxtp://10.0.0.5 --faults loss=1%,seed=7

MXTP goes to MXTP targets, NatNet frames to NatNet targets. In a loop the same bytes come again, so that \
receivers see sample numbers start over.")]
pub(crate) struct Replay {
    /// A recording (.mcap), or packets captured with tcpdump or Wireshark (.pcap, .pcapng).
    pub(crate) file: PathBuf,

    /// Where to send it; may be given many times.
    #[arg(long, value_name = "URL", required = true)]
    pub(crate) to: Vec<String>,

    #[command(flatten)]
    pub(crate) again: Again,

    /// Stop after so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Make these faults on purpose; as stream has it.
    #[arg(long, value_name = "PLAN")]
    pub(crate) faults: Option<String>,

    /// Begin at once, also when nobody has connected yet.
    #[arg(long)]
    pub(crate) no_wait: bool,

    /// Print the numbers at the end as one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}
