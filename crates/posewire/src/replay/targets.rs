//! Where a capture is sent.

use super::Replayed;
use super::natnet::{RawServer, is_frame};
use crate::capture::{CaptureOptions, CapturedSource, Protocol, Survey};
use crate::endpoint::Endpoint;
use crate::faults::{FaultCounts, FaultPlan, Faults};
use crate::sink::{MxtpTarget, TargetProgress};
use crate::{Datagram, Error, Result};
use posewire_mxtp::motion::Datagrams;
use std::path::Path;
use std::time::Duration;

/// The targets in the order given.
pub(super) struct Targets {
    all: Vec<Target>,
    datagrams: Datagrams,
    /// Those of MXTP, which are the same for every target.
    faults: Option<Faults>,
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
        (targets, faults): (&[Endpoint], Option<&FaultPlan>),
    ) -> Result<Self> {
        let open = |endpoint: &Endpoint| match endpoint {
            Endpoint::NatNet(address) => {
                let sources = survey.for_target(path, chosen, Protocol::NatNet, endpoint)?;
                let [source] = sources[..] else {
                    return Err(several(path, &sources));
                };
                let server = RawServer::open(path, options, source, address, faults)?;
                Ok(Target::NatNet(Box::new(server)))
            }
            endpoint @ (Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_)) => {
                survey.for_target(path, chosen, Protocol::Mxtp, endpoint)?;
                MxtpTarget::open_for_datagrams(endpoint).map(Target::Mxtp)
            }
            endpoint => Err(Error::NotATarget {
                endpoint: endpoint.to_string(),
            }),
        };
        Ok(Self {
            all: targets.iter().map(open).collect::<Result<_>>()?,
            datagrams: Datagrams::new(),
            faults: faults.cloned().map(Faults::new),
        })
    }

    pub(super) fn is_ready(&self) -> bool {
        self.all.iter().any(|target| match target {
            Target::Mxtp(target) => target.is_ready(),
            Target::NatNet(server) => server.is_ready(),
        })
    }

    /// Whether a datagram is for any target; if not, it is counted why.
    pub(super) fn takes(&self, datagram: &Datagram, replayed: &mut Replayed) -> bool {
        let protocol = Protocol::of(datagram.wire);
        let is_for = |target: &Target| matches!(target, Target::NatNet(_)) == (protocol == Protocol::NatNet);
        let is_for_any = self.all.iter().any(is_for);
        if !is_for_any {
            replayed.without_target += 1;
        } else if protocol == Protocol::NatNet && !is_frame(&datagram.bytes) {
            replayed.asked += 1;
            return false;
        }
        is_for_any
    }

    /// Sends a datagram that was due at `offset` to the targets of its protocol, or what faults make of it.
    pub(super) fn send(&mut self, offset: Duration, datagram: &Datagram) -> Result<()> {
        if Protocol::of(datagram.wire) == Protocol::Mxtp {
            let Some(faults) = &mut self.faults else {
                return self.send_mxtp(&datagram.bytes);
            };
            faults.handle(offset, &datagram.bytes);
            return self.send_faulty();
        }
        for server in self.servers() {
            server.send(offset, &datagram.bytes);
        }
        Ok(())
    }

    /// When what faults hold back is due.
    pub(super) fn timeout(&self) -> Option<Duration> {
        let natnet = self.all.iter().filter_map(|target| match target {
            Target::Mxtp(_) => None,
            Target::NatNet(server) => server.timeout(),
        });
        natnet.chain(self.faults.as_ref().and_then(Faults::timeout)).min()
    }

    /// Sends what faults let go at `offset`.
    pub(super) fn handle_timeout(&mut self, offset: Duration) -> Result<()> {
        for server in self.servers() {
            server.handle_timeout(offset);
        }
        if let Some(faults) = &mut self.faults {
            faults.handle_timeout(offset);
        }
        self.send_faulty()
    }

    /// Sends all that faults hold back.
    pub(super) fn finish_faults(&mut self) -> Result<()> {
        for server in self.servers() {
            server.finish_faults();
        }
        if let Some(faults) = &mut self.faults {
            faults.finish();
        }
        self.send_faulty()
    }

    /// How often what went wrong on purpose, where anything was to.
    pub(super) fn fault_counts(&self) -> Option<FaultCounts> {
        let mut counts = self.faults.as_ref()?.counts().clone();
        for target in &self.all {
            if let Target::NatNet(server) = target {
                counts = server.fault_counts().map_or(counts.clone(), |more| counts.and(&more));
            }
        }
        Some(counts)
    }

    fn servers(&mut self) -> impl Iterator<Item = &mut RawServer> {
        self.all.iter_mut().filter_map(|target| match target {
            Target::Mxtp(_) => None,
            Target::NatNet(server) => Some(&mut **server),
        })
    }

    fn send_faulty(&mut self) -> Result<()> {
        while let Some(bytes) = self.faults.as_mut().and_then(Faults::poll) {
            self.send_mxtp(&bytes)?;
        }
        Ok(())
    }

    fn send_mxtp(&mut self, bytes: &[u8]) -> Result<()> {
        self.datagrams.clear();
        self.datagrams.push(bytes);
        let datagrams = &self.datagrams;
        self.all.iter_mut().try_for_each(|target| match target {
            Target::Mxtp(target) => target.send(datagrams),
            Target::NatNet(_) => Ok(()),
        })
    }

    /// Lets every peer have what is queued.
    pub(super) fn finish(&mut self) {
        for target in &mut self.all {
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
        self.all.iter().map(progress).collect()
    }
}

/// A NatNet server has the frames of one source.
fn several(path: &Path, found: &[&CapturedSource]) -> Error {
    Error::CapturedSources {
        path: path.to_owned(),
        wanted: None,
        found: found.iter().map(|source| source.label()).collect(),
    }
}
