//! One target of a stream.

use super::tcp::TcpTarget;
use crate::endpoint::{Endpoint, TcpAddress};
use crate::net::UdpSender;
use crate::sink::TargetProgress;
use crate::{Error, Result};
use posewire_mxtp::motion::Datagrams;

/// One target of a stream.
pub(crate) enum Target {
    Udp { endpoint: String, sender: UdpSender },
    Tcp { endpoint: String, target: TcpTarget },
}

impl Target {
    /// A target that is sent whole samples.
    pub(crate) fn open(endpoint: &Endpoint) -> Result<Self> {
        Self::open_with(endpoint, QUEUED_SAMPLES)
    }

    /// A target that is sent datagrams one by one.
    pub(crate) fn open_for_datagrams(endpoint: &Endpoint) -> Result<Self> {
        Self::open_with(endpoint, QUEUED_DATAGRAMS)
    }

    fn open_with(endpoint: &Endpoint, queued: usize) -> Result<Self> {
        match endpoint {
            Endpoint::MxtpUdp(address) => Ok(Self::Udp {
                endpoint: endpoint.to_string(),
                sender: UdpSender::open(address)?,
            }),
            Endpoint::MxtpTcp(address) => {
                let target = TcpTarget::open(address, queued)?;
                let port = target.port().unwrap_or(address.port);
                let endpoint = Endpoint::MxtpTcp(TcpAddress {
                    port,
                    ..address.clone()
                })
                .to_string();
                Ok(Self::Tcp { endpoint, target })
            }
            _ => Err(Error::NotATarget {
                endpoint: endpoint.to_string(),
            }),
        }
    }

    /// Whether somebody is there to be sent to, as far as can be known.
    pub(crate) fn is_ready(&self) -> bool {
        match self {
            Self::Udp { .. } => true,
            Self::Tcp { target, .. } => target.peers() > 0,
        }
    }

    /// Sends the datagrams of one sample.
    ///
    /// # Errors
    /// [`Error::Socket`] when the very first datagram cannot be sent: the target cannot be reached at all.
    pub(crate) fn send(&mut self, datagrams: &Datagrams) -> Result<()> {
        match self {
            Self::Udp { sender, .. } => {
                for datagram in datagrams.iter() {
                    let outcome = sender.send(datagram);
                    if outcome.is_err() && sender.counts().sent == 0 {
                        return outcome;
                    }
                }
            }
            Self::Tcp { target, .. } => target.send(datagrams),
        }
        Ok(())
    }

    pub(crate) fn finish(&mut self) {
        if let Self::Tcp { target, .. } = self {
            target.finish();
        }
    }

    pub(crate) fn progress(&self) -> TargetProgress {
        match self {
            Self::Udp { endpoint, sender } => {
                let counts = sender.counts();
                TargetProgress {
                    endpoint: endpoint.clone(),
                    peers: 1,
                    datagrams: counts.sent,
                    congested: counts.congested,
                    failed: counts.failed,
                    ..TargetProgress::default()
                }
            }
            Self::Tcp { endpoint, target } => TargetProgress {
                endpoint: endpoint.clone(),
                peers: target.peers(),
                datagrams: target.written(),
                dropped: target.dropped(),
                notices: target.notices(),
                ..TargetProgress::default()
            },
        }
    }
}

/// About a second of a 240 Hz stream.
const QUEUED_SAMPLES: usize = 256;
/// About a second of 16 people in five types at 240 Hz.
const QUEUED_DATAGRAMS: usize = 16 << 10;
