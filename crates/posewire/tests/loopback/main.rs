//! Streams over the loopback, from a source through real sockets to a source on the other side.

mod captures;
mod captures_clock;
mod datagrams;
mod doctor;
mod ends;
mod faults;
mod harness;
mod natnet;
mod natnet_sink;
mod recording;
mod reference;
mod remote;
mod transit;
mod transports;
mod walkers;
