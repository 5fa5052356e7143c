//! `posewire`: stream, monitor, inspect and explain motion capture.

use std::process::ExitCode;

fn main() -> ExitCode {
    posewire_cli::main(std::env::args_os()).into()
}
