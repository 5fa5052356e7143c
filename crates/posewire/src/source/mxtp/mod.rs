//! MXTP from the network.

mod intake;
mod tcp;
mod udp;

pub(super) use intake::{Intake, Way};
pub(super) use tcp::MxtpTcp;
pub(super) use udp::MxtpUdp;
