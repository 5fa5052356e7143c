//! Streams to programs that others wrote, in the Python that `tests/peers/install` prepares.

mod files;
mod natnet;
mod python;
mod streaming;
mod takes;
