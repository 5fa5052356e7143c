//! The arguments of `posewire demo`.

use super::value::seconds;
use super::view::Beside;
use clap::Args;
use std::time::Duration;

/// See it work: people walk, are streamed over the loopback, monitored, and shown in a browser.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  posewire demo
  posewire demo --people 5 --open
  posewire demo --duration 10 --json")]
pub(crate) struct Demo {
    /// How many people walk, 1 to 64.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub(crate) people: u8,

    /// Open the page in this machine's browser.
    #[arg(long)]
    pub(crate) open: bool,

    #[command(flatten)]
    pub(crate) beside: Beside,

    /// End by itself after so many seconds and print the statistics.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,

    /// Print JSON, as monitor does.
    #[arg(long)]
    pub(crate) json: bool,

    /// Print a table a second instead of the live page, as when the output is no terminal.
    #[arg(long)]
    pub(crate) plain: bool,
}
