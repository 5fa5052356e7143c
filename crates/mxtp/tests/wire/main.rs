//! The wire layer from outside: vectors, captured datagrams, arbitrary bytes.

mod json;
mod properties;
mod quirks;
mod reference;
mod samples;
mod vectors;
