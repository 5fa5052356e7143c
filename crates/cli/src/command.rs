//! The verbs, one file each.

mod convert;
mod demo;
mod doctor;
mod explain;
mod inspect;
mod monitor;
mod record;
mod replay;
mod stream;
mod view;

use crate::cli::Command;

/// How a verb ended that did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Everything was done.
    Done,
    /// It was done, but data was lost on this side.
    LostData,
    /// It was done, and something is broken that was looked at.
    Broken,
}

impl End {
    /// What to end with when `lost` pieces of data were lost.
    pub(crate) fn with_lost(lost: u64) -> Self {
        if lost == 0 { Self::Done } else { Self::LostData }
    }

    pub(crate) fn exit_code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::LostData => 3,
            Self::Broken => 1,
        }
    }
}

pub(crate) fn run(command: Command) -> anyhow::Result<End> {
    match command {
        Command::Stream(arguments) => stream::run(&arguments),
        Command::Monitor(arguments) => monitor::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Record(arguments) => record::run(&arguments),
        Command::Inspect(arguments) => inspect::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Doctor(arguments) => doctor::run(&arguments),
        Command::Demo(arguments) => demo::run(&arguments),
    }
}
