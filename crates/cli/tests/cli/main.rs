//! Runs the program as its users do.

mod convert;
mod convert_arguments;
mod demo;
mod explain;
mod inspect;
mod monitor;
mod motive;
mod natnet;
mod natnet_monitor;
#[cfg(unix)]
mod page;
mod program;
mod refusals;
mod stream;
mod takes;
