//! Runs the program as its users do.

mod convert;
mod convert_arguments;
mod demo;
mod doctor;
mod explain;
mod faults;
mod inspect;
mod monitor;
mod motive;
mod natnet;
mod natnet_monitor;
#[cfg(unix)]
mod page;
mod program;
mod record;
#[cfg(unix)]
mod recording_mishaps;
mod refusals;
mod remote;
mod replay;
mod running;
mod stream;
mod takes;
mod view;
