//! `posewire`: stream, monitor, inspect and explain motion capture.

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
    let cli = cli::Cli::parse();
    match command::run(cli.command) {
        Ok(end) => end.exit_code(),
        Err(error) => error::report(&error),
    }
}
