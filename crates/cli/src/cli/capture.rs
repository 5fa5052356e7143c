//! Arguments of verbs that play recordings and captures.

use super::explain::Protocol;
use super::value::{moment, seconds};
use crate::error::Usage;
use clap::Args;
use std::time::Duration;

/// How a recording or capture is played again.
#[derive(Debug, Args)]
pub(crate) struct Again {
    /// Of a capture: play so many times as fast as captured.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) speed: f64,

    /// Of a capture: begin again at the end.
    #[arg(long = "loop")]
    pub(crate) looped: bool,

    #[command(flatten)]
    pub(crate) capture: Capture,
}

/// What of a recording or capture is used.
#[derive(Debug, Args)]
pub(crate) struct Capture {
    #[command(flatten)]
    pub(crate) part: Part,

    /// Of a capture of packets: what its UDP datagrams are; told by their content when left out.
    #[arg(long = "protocol", value_enum, ignore_case = true)]
    pub(crate) forced: Option<Protocol>,
}

/// Which datagrams of a recording or capture are used.
#[derive(Debug, Args)]
pub(crate) struct Part {
    /// Of a capture: only this source, by its number or a part of its name.
    #[arg(long, value_name = "SOURCE")]
    pub(crate) only: Option<String>,

    /// Of a capture: begin so many seconds after its first datagram.
    #[arg(long, value_name = "SECONDS", value_parser = moment, allow_negative_numbers = true)]
    pub(crate) from: Option<Duration>,

    /// Of a capture: end so many seconds after its first datagram.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) until: Option<Duration>,
}

impl Part {
    /// Refuses a part that ends before it begins.
    pub(crate) fn check(&self) -> Result<(), Usage> {
        match (self.from, self.until) {
            (Some(from), Some(until)) if until <= from => Err(Usage {
                problem: format!(
                    "--until {} is not behind --from {}",
                    until.as_secs_f64(),
                    from.as_secs_f64()
                ),
                help: "both are seconds after the first datagram of the file".to_owned(),
            }),
            _ => Ok(()),
        }
    }

    /// The options that were given.
    pub(crate) fn given(&self) -> [(&'static str, bool); 3] {
        [
            ("--only", self.only.is_some()),
            ("--from", self.from.is_some()),
            ("--until", self.until.is_some()),
        ]
    }
}

impl Capture {
    /// The protocol that was named.
    pub(crate) fn protocol(&self) -> Option<posewire::capture::Protocol> {
        self.forced.map(Into::into)
    }

    /// The options that were given.
    pub(crate) fn given(&self) -> [(&'static str, bool); 4] {
        let [only, from, until] = self.part.given();
        [only, from, until, ("--protocol", self.forced.is_some())]
    }
}
