//! How a server works.

use std::net::Ipv4Addr;
use std::time::Duration;

use crate::{Name, Version};

/// How a [`Server`](super::Server) works.
#[derive(Clone, Debug, PartialEq)]
pub struct ServerOptions {
    /// What it calls itself. Some clients talk to `Motive` only.
    pub name: Name,
    /// Version of the application.
    pub app_version: Version,
    /// Newest version of the bitstream that it sends, and the one that clients without a wish get. 4.1 unless
    /// set: 4.2 breaks several clients.
    pub version: Version,
    /// How frames go out.
    pub delivery: Delivery,
    /// Port that frames are sent to (multicast) or from (unicast); 1511 unless set.
    pub data_port: u16,
    /// Ticks a second of the clock in echoes and host stamps; 10 million unless set, as on Windows.
    pub clock_frequency: u64,
    /// Silence after which a client is dropped, `None` for never; 10 s unless set.
    pub silence_limit: Option<Duration>,
    /// Whether a client's host gets its frames at the data port as well: some clients listen only there. The
    /// endpoint that a client connected from then gets frames from the next packet on that it sends. Those that
    /// listen at the data port never keep alive, so that with this option silence does not drop a client that has
    /// never sent a keep-alive until its host brings another one.
    pub copy_to_data_port: bool,
    /// Frames a second, for those who ask.
    pub frame_rate: f32,
    /// Samples of analog devices per frame, for those who ask.
    pub analog_samples_per_frame: i32,
}

impl Default for ServerOptions {
    /// A server that calls itself Motive and sends 4.1 at 120 Hz to each client.
    fn default() -> Self {
        Self {
            name: "Motive".into(),
            app_version: Version::new(3, 1),
            version: Version::new(4, 1),
            delivery: Delivery::Unicast,
            data_port: 1511,
            clock_frequency: 10_000_000,
            silence_limit: Some(Duration::from_secs(10)),
            copy_to_data_port: false,
            frame_rate: 120.0,
            analog_samples_per_frame: 0,
        }
    }
}

/// How frames go out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Delivery {
    /// To every client that has connected, at the endpoint that it connected from, in the version that it wants.
    Unicast,
    /// Once, to a group, in the server's own version. 255.255.255.255 is everybody in the network.
    Multicast(Ipv4Addr),
}

impl Delivery {
    /// The group that Motive sends to unless set otherwise.
    pub const MOTIVE_GROUP: Ipv4Addr = Ipv4Addr::new(239, 255, 42, 99);
}
