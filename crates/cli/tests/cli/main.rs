//! Runs the program as its users do.

mod demo;
mod explain;
mod inspect;
mod monitor;
mod natnet;
#[cfg(unix)]
mod page;
mod program;
mod refusals;
mod stream;
mod takes;
