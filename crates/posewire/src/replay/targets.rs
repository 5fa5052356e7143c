//! Where a capture is sent.

use super::Replayed;
use super::natnet::RawServer;
use crate::capture::{CaptureOptions, Protocol, Survey, is_asked};
use crate::endpoint::Endpoint;
use crate::sink::{MxtpTarget, TargetProgress};
use crate::{Datagram, Result};
use posewire_mxtp::motion::Datagrams;
use std::path::Path;

/// The targets in the order given.
pub(super) struct Targets {
    targets: Vec<Target>,
    datagrams: Datagrams,
}

enum Target {
    Mxtp(MxtpTarget),
    NatNet(Box<RawServer>),
}

impl Targets {
    pub(super) fn open(
        path: &Path,
        options: &CaptureOptions,
        survey: &Survey,
        chosen: Option<u16>,
        targets: &[Endpoint],
    ) -> Result<Self> {
        let open = |endpoint: &Endpoint| match endpoint {
            Endpoint::NatNet(address) => {
                let source = survey.natnet(path, chosen)?;
                let server = RawServer::open(path, options, source, address)?;
                Ok(Target::NatNet(Box::new(server)))
            }
            endpoint => MxtpTarget::open_for_datagrams(endpoint).map(Target::Mxtp),
        };
        Ok(Self {
            targets: targets.iter().map(open).collect::<Result<_>>()?,
            datagrams: Datagrams::new(),
        })
    }

    pub(super) fn is_ready(&self) -> bool {
        self.targets.iter().any(|target| match target {
            Target::Mxtp(target) => target.is_ready(),
            Target::NatNet(server) => server.is_ready(),
        })
    }

    /// Whether a datagram is for any target; if not, it is counted why.
    pub(super) fn takes(&self, datagram: &Datagram, replayed: &mut Replayed) -> bool {
        let protocol = Protocol::of(datagram.wire);
        let is_for = |target: &Target| matches!(target, Target::NatNet(_)) == (protocol == Protocol::NatNet);
        let is_for_any = self.targets.iter().any(is_for);
        if !is_for_any {
            replayed.without_target += 1;
        } else if protocol == Protocol::NatNet && is_asked(&datagram.bytes) {
            replayed.asked += 1;
            return false;
        }
        is_for_any
    }

    /// Sends a datagram to the targets of its protocol.
    pub(super) fn send(&mut self, datagram: &Datagram) -> Result<()> {
        if Protocol::of(datagram.wire) == Protocol::Mxtp {
            return self.send_mxtp(&datagram.bytes);
        }
        for target in &mut self.targets {
            if let Target::NatNet(server) = target {
                server.send(&datagram.bytes);
            }
        }
        Ok(())
    }

    pub(super) fn send_mxtp(&mut self, bytes: &[u8]) -> Result<()> {
        self.datagrams.clear();
        self.datagrams.push(bytes);
        let datagrams = &self.datagrams;
        self.targets.iter_mut().try_for_each(|target| match target {
            Target::Mxtp(target) => target.send(datagrams),
            Target::NatNet(_) => Ok(()),
        })
    }

    /// Lets every peer have what is queued.
    pub(super) fn finish(&mut self) {
        for target in &mut self.targets {
            match target {
                Target::Mxtp(target) => target.finish(),
                Target::NatNet(server) => server.finish(),
            }
        }
    }

    pub(super) fn progress(&self) -> Vec<TargetProgress> {
        let progress = |target: &Target| match target {
            Target::Mxtp(target) => target.progress(),
            Target::NatNet(server) => server.progress(),
        };
        self.targets.iter().map(progress).collect()
    }
}
