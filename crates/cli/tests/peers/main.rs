//! Streams to programs that others wrote, in the Python that `tests/peers/install` prepares.

mod captures;
mod files;
mod natnet;
mod python;
mod recording;
mod streaming;
mod takes;
