//! Packets of every kind and version, to and from bytes.

mod bounds;
mod json;
mod lines;
mod properties;
mod quirks;
mod reference;
mod samples;
mod strategies;
mod vectors;
