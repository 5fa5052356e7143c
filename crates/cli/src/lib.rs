//! `posewire`: stream, monitor, inspect and explain motion capture.
//!
//! The whole command line as a function, for programs that have it among other things, as the Python package does:
//!
//! ```
//! assert_eq!(posewire_cli::main(["posewire", "--version"]), 0);
//! ```

mod browser;
mod cli;
mod command;
mod context;
mod error;
mod json;
mod plain;
mod render;

use clap::Parser;
use std::ffi::OsString;

/// Does what a command line asks for and gives the exit code: 0 for done, 1 for failed, 2 for wrong arguments, 3 for done with data
/// lost.
///
/// `arguments` begins with the program's own name. It writes to the standard streams and takes Ctrl-C for itself, so that it can
/// be called once in a process.
pub fn main(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    match cli::Cli::try_parse_from(arguments) {
        Ok(cli) => match command::run(cli.command) {
            Ok(end) => end.exit_code(),
            Err(error) => error::report(&error),
        },
        Err(answer) => error::report_parsing(&answer),
    }
}
