//! MXTP over UDP.

use super::intake::{Intake, TICK};
use crate::Result;
use crate::endpoint::{Endpoint, UdpAddress};
use crate::net::UdpReceiver;
use crate::session::Outlet;
use crate::stop::Stop;

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
        while !stop.is_stopped() {
            self.receiver
                .receive(TICK, |received| intake.datagram(received.stamp, received.bytes))?;
            if !intake.tick(self.receiver.kernel_dropped(), 0) {
                break;
            }
        }
        intake.finish(self.receiver.kernel_dropped(), 0);
        Ok(())
    }
}
