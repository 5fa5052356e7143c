//! NatNet over the loopback, from a server that the tests drive frame by frame to a source.

mod connection;
mod contents;
#[cfg(target_os = "linux")]
mod finding;
mod motive;
