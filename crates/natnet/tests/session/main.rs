//! Client and server in memory, with a network that loses, delays and reorders.

mod client;
mod network;
mod properties;
mod reference;
mod server;
mod together;
