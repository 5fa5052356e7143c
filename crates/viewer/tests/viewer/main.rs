//! The server as its clients see it, on the loopback.

#![allow(clippy::float_cmp, reason = "what is sent reads as it is")]

mod decode;
mod guarded;
mod harness;
mod limits;
mod live;
mod recorder;
mod takes;
