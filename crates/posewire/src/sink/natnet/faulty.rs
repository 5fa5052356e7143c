//! Faults in the frames that clients get.

use crate::faults::{FaultCounts, FaultPlan, LiveFaults};
use posewire_natnet::{Socket, Transmit};
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Instant;

/// Faults in the frames of each client, which are the same for all who get the same from the beginning on.
#[derive(Debug)]
pub(crate) struct FaultyFrames {
    plan: FaultPlan,
    clients: BTreeMap<SocketAddr, LiveFaults>,
}

impl FaultyFrames {
    pub(crate) const fn new(plan: FaultPlan) -> Self {
        Self {
            plan,
            clients: BTreeMap::new(),
        }
    }

    /// Takes a frame that was to leave at `due`.
    pub(crate) fn handle(&mut self, due: Instant, frame: &Transmit) {
        let faults = self.clients.entry(frame.to);
        let faults = faults.or_insert_with(|| LiveFaults::new(self.plan.clone()));
        faults.handle(due, &frame.bytes);
    }

    pub(crate) fn timeout(&self) -> Option<Instant> {
        self.clients.values().filter_map(LiveFaults::timeout).min()
    }

    pub(crate) fn handle_timeout(&mut self, now: Instant) {
        self.clients.values_mut().for_each(|faults| faults.handle_timeout(now));
    }

    pub(crate) fn finish(&mut self) {
        self.clients.values_mut().for_each(LiveFaults::finish);
    }

    /// The next frame that leaves.
    pub(crate) fn poll(&mut self) -> Option<Transmit> {
        self.clients.iter_mut().find_map(|(to, faults)| {
            let bytes = faults.poll()?.into();
            Some(Transmit {
                socket: Socket::Data,
                to: *to,
                bytes,
            })
        })
    }

    /// How often what was done to the frames of all clients.
    pub(crate) fn counts(&self) -> FaultCounts {
        let clients = self.clients.values().map(LiveFaults::counts);
        clients.fold(FaultCounts::default(), FaultCounts::and)
    }
}
