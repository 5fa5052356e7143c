//! `posewire`: stream, monitor, inspect and explain motion capture.

mod browser;
mod cli;
mod command;
mod context;
mod error;
mod json;
mod plain;
mod render;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match cli::Cli::try_parse() {
        Ok(cli) => match command::run(cli.command) {
            Ok(end) => end.exit_code(),
            Err(error) => error::report(&error),
        },
        Err(answer) => error::report_parsing(&answer),
    }
}
