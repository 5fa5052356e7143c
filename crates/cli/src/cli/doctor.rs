//! The arguments of `posewire doctor`.

use super::value::seconds;
use clap::Args;
use std::time::Duration;

/// Say why nothing arrives, or what is wrong with what does.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire doctor                                    this machine: ports, networks, limits
  posewire doctor mxtp://0.0.0.0                     what MVN sends by UDP
  posewire doctor mxtp+tcp://0.0.0.0                 what MVN sends by TCP
  posewire doctor natnet://10.0.0.7                  Motive there
  posewire doctor mxtp://0.0.0.0 --duration 30 --json
  posewire doctor take.pcapng                        a recording or capture

docs/troubleshooting.md has every finding by its name.

Exit codes: 0 nothing is broken, 1 something is, or the doctor failed (with an error: line),
2 wrong arguments, 3 nothing is broken but that this machine lost data.")]
pub(crate) struct Doctor {
    /// Where to listen, which NatNet server to ask, or a recording or capture. Without it only this machine is looked at.
    pub(crate) url: Option<String>,

    /// Listen for so many seconds.
    #[arg(long, value_name = "SECONDS", default_value = "5", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Duration,

    /// Of a capture with several sources: this one alone, by its number or a part of its name.
    #[arg(long, value_name = "SOURCE")]
    pub(crate) only: Option<String>,

    /// Print JSON: one object for each finding, and one at the end.
    #[arg(long)]
    pub(crate) json: bool,
}
