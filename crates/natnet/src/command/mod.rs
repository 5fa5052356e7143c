//! What client and server say to each other besides frames and descriptions.

mod connect;
mod echo;
mod server_info;
mod text;

pub use connect::{Connect, ConnectOptions, Sender};
pub use echo::{EchoRequest, EchoResponse};
pub use server_info::{ConnectionInfo, ServerInfo};
pub use text::{Response, Text};
