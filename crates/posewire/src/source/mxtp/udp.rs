//! MXTP over UDP.

use super::intake::Intake;
use crate::Result;
use crate::endpoint::{Endpoint, UdpAddress};
use crate::net::UdpReceiver;
use crate::session::Outlet;
use crate::source::report::{DRAIN_LIMIT, TICK};
use crate::stop::Stop;
use std::time::{Duration, Instant};

/// A bound socket that MXTP datagrams arrive on.
#[derive(Debug)]
pub(in crate::source) struct MxtpUdp {
    address: UdpAddress,
    receiver: UdpReceiver,
}

impl MxtpUdp {
    pub(in crate::source) fn open(address: &UdpAddress) -> Result<Self> {
        let receiver = UdpReceiver::bind(address)?;
        let port = receiver.local_address().port();
        Ok(Self {
            address: UdpAddress {
                port,
                ..address.clone()
            },
            receiver,
        })
    }

    pub(in crate::source) fn endpoint(&self) -> Endpoint {
        Endpoint::MxtpUdp(self.address.clone())
    }

    pub(in crate::source) fn run(mut self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        let mut intake = Intake::new(outlet);
        let received = self.receive_all(&mut intake, stop);
        // Also after an error: the numbers up to there are true.
        intake.finish(self.receiver.kernel_dropped(), 0);
        received
    }

    /// Receives until the stop, and then what the system had taken by then.
    fn receive_all(&mut self, intake: &mut Intake<'_>, stop: &Stop) -> Result<()> {
        while !stop.is_stopped() {
            self.receive(intake, TICK)?;
            if !intake.tick(self.receiver.kernel_dropped(), 0) {
                return Ok(());
            }
        }
        // A sender that goes on must not hold up the end.
        let until = Instant::now() + DRAIN_LIMIT;
        while Instant::now() < until && self.receive(intake, Duration::ZERO)? > 0 {
            intake.tick(self.receiver.kernel_dropped(), 0);
        }
        Ok(())
    }

    fn receive(&mut self, intake: &mut Intake<'_>, timeout: Duration) -> Result<usize> {
        self.receiver
            .receive(timeout, |received| intake.datagram(received.stamp, received.bytes))
    }
}
