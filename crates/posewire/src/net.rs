//! Sockets: datagrams in with the kernel's receive time, datagrams out, TCP both ways.
//!
//! ```
//! use posewire::endpoint::{Host, UdpAddress};
//! use posewire::net::{UdpReceiver, UdpSender};
//! use std::time::Duration;
//!
//! let loopback = Host::Address([127, 0, 0, 1].into());
//! let mut receiver = UdpReceiver::bind(&UdpAddress::new(loopback.clone(), 0))?;
//! let port = receiver.local_address().port();
//! let mut sender = UdpSender::open(&UdpAddress::new(loopback, port))?;
//!
//! sender.send(b"MXTP02")?;
//! let count = receiver.receive(Duration::from_secs(5), |received| {
//!     assert_eq!(received.bytes, b"MXTP02");
//! })?;
//! assert_eq!(count, 1);
//! # Ok::<(), posewire::Error>(())
//! ```

mod backoff;
mod interface;
mod resolve;
mod route;
mod tcp;
mod udp_receive;
mod udp_send;
mod udp_serve;

pub use backoff::Backoff;
pub(crate) use interface::{LocalInterface, list as interfaces};
pub use resolve::resolve;
pub(crate) use resolve::resolve_first;
pub(crate) use route::{LocalAddress, broadcast_addresses, broadcasts_beside, is_own};
pub(crate) use tcp::connect_to;
pub use tcp::{TcpConnection, TcpIncoming, connect, listen};
pub use udp_receive::{Received, UdpReceiver};
pub use udp_send::{SendCounts, UdpSender};
pub(crate) use udp_serve::{Sent, ServedPort};
