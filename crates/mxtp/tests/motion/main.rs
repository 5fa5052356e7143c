//! Frames to datagrams and back.

mod any_input;
mod character;
mod frames;
mod reference;
mod round_trip;
mod sections;
mod vendor_axes;
