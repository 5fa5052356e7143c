//! Streams over the loopback, from a source through real sockets to a source on the other side.

mod ends;
mod harness;
mod natnet;
mod natnet_sink;
mod reference;
mod transports;
mod walkers;
