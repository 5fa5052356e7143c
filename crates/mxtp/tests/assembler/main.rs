//! What an assembler makes of datagrams, however they arrive.

mod ahead;
mod any_input;
mod bounds;
mod counting;
mod description;
mod order;
mod sessions;
mod split;
mod stream;
