//! How a client works.

use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

use crate::Version;
use crate::command::Sender;

/// How a [`Client`](super::Client) works.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClientOptions {
    /// The server's command endpoint; port 1510 in Motive unless changed.
    pub server: SocketAddr,
    /// How the frames come.
    pub mode: Mode,
    /// The version of the bitstream to ask for; `None` leaves it to the server. A server that
    /// multicasts grants no wish: there it is what frames are read as until the server has said which
    /// version it speaks.
    pub version: Option<Version>,
    /// Who the client says it is.
    pub sender: Sender,
    /// Whose frames are taken.
    pub data_source: DataSource,
    /// Time between signs of life to a server that unicasts; 1 s unless set.
    pub keep_alive: Duration,
    /// Time between questions for the server's clock; 0.5 s unless set.
    pub echo: Duration,
    /// First wait for an answer, doubled each time up to 2 s; 0.25 s unless set.
    pub retry: Duration,
    /// Silence after which the server counts as lost; 3 s unless set.
    pub lost_after: Duration,
}

impl ClientOptions {
    /// A client of the server at `server`, with the usual times and no wishes.
    pub fn new(server: SocketAddr, mode: Mode) -> Self {
        Self {
            server,
            mode,
            version: None,
            sender: Sender {
                name: "posewire".into(),
                app_version: Version::new(0, 1),
                natnet_version: Version::LATEST,
            },
            data_source: DataSource::Server,
            keep_alive: Duration::from_secs(1),
            echo: Duration::from_millis(500),
            retry: Duration::from_millis(250),
            lost_after: Duration::from_secs(3),
        }
    }
}

/// How frames come to a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// To the socket that the client connects from.
    Unicast,
    /// To a group that the client has joined.
    Multicast,
}

/// Whose frames a client takes. Several servers may send to one group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DataSource {
    /// The address that the commands go to.
    Server,
    /// Another address of the server: one with several interfaces may send from any of them.
    Address(IpAddr),
    /// Anybody's.
    Any,
}
