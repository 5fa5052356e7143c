//! What a NatNet server says of itself before its frames can be read, wherever in the capture it says it.

use super::{Capture, CaptureOptions, CapturedSource, is_asked};
use crate::endpoint::{Endpoint, Host, NatNetAddress};
use crate::{Datagram, Result};
use posewire_natnet::client::Mode;
use posewire_natnet::command::{Sender, ServerInfo, Text};
use posewire_natnet::{Message, MessageId, Name, Packet, Version};
use std::cmp::Reverse;
use std::net::SocketAddr;
use std::path::Path;

/// What a NatNet server said of itself.
#[derive(Debug)]
pub(crate) struct Opening {
    pub(crate) address: NatNetAddress,
    pub(crate) server: SocketAddr,
    /// Server information, descriptions and the frame rate, as far as they were captured. Server information there is always.
    pub(crate) packets: Vec<Box<[u8]>>,
}

/// What was found so far.
#[derive(Default)]
struct Search {
    server: Option<SocketAddr>,
    info: Option<Box<[u8]>>,
    model: Option<Box<[u8]>>,
    rate: Option<Box<[u8]>>,
    /// Whether the client's questions were captured too, and the last one was for the rate.
    asks: Option<bool>,
    frames: Vec<Box<[u8]>>,
    /// Whether a frame went to a group.
    to_group: bool,
}

impl Opening {
    /// Looks through a capture for what the server says, and at its first frames for their version.
    pub(crate) fn find(path: &Path, options: &CaptureOptions, source: &CapturedSource) -> Result<Self> {
        let mut search = Search::default();
        for captured in Capture::open(path, options)? {
            let captured = captured?;
            if captured.source == source.number {
                search.note(captured.datagram);
            }
            if search.is_over() {
                break;
            }
        }
        Ok(search.end(source))
    }
}

impl Search {
    fn note(&mut self, datagram: Datagram) {
        let Ok(packet) = Packet::decode(&datagram.bytes) else {
            return;
        };
        match packet.id {
            MessageId::REQUEST => {
                let (text, _) = Text::decode(packet.payload);
                self.asks = Some(text.to_string() == FRAME_RATE);
            }
            MessageId::SERVER_INFO if self.info.is_none() => {
                self.server = Some(datagram.from);
                self.info = Some(datagram.bytes);
            }
            MessageId::MODEL if self.model.is_none() => self.model = Some(datagram.bytes),
            MessageId::RESPONSE if self.rate.is_none() && self.asks != Some(false) && is_rate(packet.payload) => {
                self.rate = Some(datagram.bytes);
            }
            MessageId::FRAME if self.frames.len() < TRIED => {
                self.server.get_or_insert(datagram.from);
                self.to_group |= datagram.to.ip().is_multicast();
                self.frames.push(datagram.bytes);
            }
            _ if is_asked(&datagram.bytes) => {
                self.server.get_or_insert(datagram.to);
            }
            _ => {}
        }
    }

    fn is_over(&self) -> bool {
        self.info.is_some() && self.model.is_some() && self.rate.is_some() && self.frames.len() >= TRIED
    }

    fn end(self, source: &CapturedSource) -> Opening {
        let server = self.server.unwrap_or(SocketAddr::from(([0; 4], 1510)));
        let named = source.name.parse();
        let address = match named {
            Ok(Endpoint::NatNet(address)) => address,
            _ => NatNetAddress {
                mode: if self.to_group { Mode::Multicast } else { Mode::Unicast },
                ..NatNetAddress::new(Host::Address(server.ip()), server.port())
            },
        };
        let info = self.server_info();
        let packets = info.into_iter().chain(self.model).chain(self.rate).collect();
        Opening {
            // Which version was asked for does not say which one came.
            address: NatNetAddress {
                version: None,
                ..address
            },
            server,
            packets,
        }
    }

    /// What the server says, with the version that its frames are of.
    fn server_info(&self) -> Option<Box<[u8]>> {
        let said = self.info.as_ref().and_then(|bytes| {
            let packet = Packet::decode(bytes).ok()?;
            ServerInfo::decode(packet.payload).ok().map(|(info, _)| info)
        });
        let stated = said.as_ref().map(|info| info.server.natnet_version);
        let version = self.version(stated);
        if stated == Some(version) {
            return self.info.clone();
        }
        let unknown = ServerInfo {
            server: Sender {
                name: Name::default(),
                app_version: Version::new(0, 0),
                natnet_version: version,
            },
            connection: None,
        };
        let mut info = said.unwrap_or(unknown);
        info.server.natnet_version = version;
        let mut bytes = Vec::new();
        Message::ServerInfo(info).encode(version, &mut bytes).ok()?;
        Some(bytes.into())
    }

    /// The version that the server states if its frames are of it, else the newest that they fit.
    fn version(&self, stated: Option<Version>) -> Version {
        let newest_first = Version::LAYOUTS.into_iter().rev();
        let candidates = stated.into_iter().chain(newest_first);
        let best = candidates.min_by_key(|version| Reverse(self.clean_frames(*version)));
        best.unwrap_or(Version::LATEST)
    }

    fn clean_frames(&self, version: Version) -> usize {
        let is_clean = |bytes: &[u8]| Message::decode(version, bytes).is_ok_and(|(_, quirks)| quirks.is_empty());
        self.frames.iter().filter(|bytes| is_clean(bytes)).count()
    }
}

fn is_rate(payload: &[u8]) -> bool {
    let rate = payload.try_into().map_or(0.0, f32::from_le_bytes);
    (1.0..=10_000.0).contains(&rate)
}

const FRAME_RATE: &str = "FrameRate";
/// Frames that a version is tried on.
const TRIED: usize = 32;
