//! Receiving on Linux: stamps and drop counts by the kernel, through control messages.

use std::array;
use std::io::{self, IoSliceMut};
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::os::fd::AsRawFd;

use nix::cmsg_space;
use nix::sys::socket::{
    ControlMessageOwned, MsgFlags, MultiHeaders, RecvMsg, SockaddrStorage, recvmmsg, setsockopt, sockopt,
};
use nix::sys::time::TimeSpec;
use posewire_motion::Stamp;

use super::{LARGEST_DATAGRAM, Received, canonical};
use crate::clock;

/// The buffers of one receiving socket.
#[derive(Debug)]
pub(super) struct Reader {
    bytes: Box<[u8]>,
    dropped: u64,
}

impl Reader {
    /// Asks the kernel for stamps and drop counts.
    pub(super) fn new(socket: &UdpSocket) -> io::Result<Self> {
        setsockopt(socket, sockopt::ReceiveTimestampns, &true)?;
        setsockopt(socket, sockopt::RxqOvfl, &1)?;
        Ok(Self {
            bytes: vec![0; BATCH * LARGEST_DATAGRAM].into(),
            dropped: 0,
        })
    }

    pub(super) fn kernel_dropped(&self) -> u64 {
        self.dropped
    }

    /// Takes what is there, waiting for the first datagram as long as the socket's timeout if
    /// `wait` is set.
    pub(super) fn receive(
        &mut self,
        socket: &UdpSocket,
        wait: bool,
        each: &mut impl FnMut(Received<'_>),
    ) -> io::Result<usize> {
        let wait = if wait {
            MsgFlags::MSG_WAITFORONE
        } else {
            MsgFlags::MSG_DONTWAIT
        };
        // New headers every time: the kernel shortens the room for control messages in used ones to
        // what it needed, and its first drop count would find none.
        let mut headers = MultiHeaders::<SockaddrStorage>::preallocate(BATCH, Some(cmsg_space!(TimeSpec, u32)));
        let mut slots = self.bytes.chunks_exact_mut(LARGEST_DATAGRAM);
        let mut slices: [_; BATCH] = array::from_fn(|_| [IoSliceMut::new(slots.next().unwrap_or_default())]);
        let messages = recvmmsg(socket.as_raw_fd(), &mut headers, slices.iter_mut(), wait, None)?;
        let mut count = 0;
        for message in messages {
            let (stamp, drops) = control_values(&message);
            self.dropped = drops.map_or(self.dropped, |drops| total(self.dropped, drops));
            each(Received {
                bytes: message.iovs().next().unwrap_or_default(),
                from: sender(&message),
                stamp: stamp.unwrap_or_else(clock::now),
                truncated: message.flags.contains(MsgFlags::MSG_TRUNC),
            });
            count += 1;
        }
        Ok(count)
    }
}

fn sender(message: &RecvMsg<'_, '_, SockaddrStorage>) -> SocketAddr {
    let address = message.address.as_ref();
    let v4 = address.and_then(|a| a.as_sockaddr_in()).map(|a| SocketAddr::from(*a));
    let v6 = || address.and_then(|a| a.as_sockaddr_in6()).map(|a| SocketAddr::from(*a));
    let nobody = SocketAddr::new(Ipv4Addr::UNSPECIFIED.into(), 0);
    canonical(v4.or_else(v6).unwrap_or(nobody))
}

fn control_values(message: &RecvMsg<'_, '_, SockaddrStorage>) -> (Option<Stamp>, Option<u32>) {
    let (mut stamp, mut drops) = (None, None);
    for control in message.cmsgs().into_iter().flatten() {
        match control {
            ControlMessageOwned::ScmTimestampns(time) => stamp = Some(clock::stamp_of_kernel(time)),
            ControlMessageOwned::RxqOvfl(count) => drops = Some(count),
            _ => {}
        }
    }
    (stamp, drops)
}

/// The kernel counts in 32 bits, which wrap.
fn total(before: u64, count: u32) -> u64 {
    before + u64::from(count.wrapping_sub(before as u32))
}

/// How many datagrams one call of the kernel takes at most; beyond this many, more gain nothing.
const BATCH: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drop_count_goes_on_when_the_kernels_wraps() {
        let before = u64::from(u32::MAX) - 1;
        assert_eq!(total(0, 7), 7);
        assert_eq!(total(7, 7), 7);
        assert_eq!(total(before, 3), before + 5);
    }
}
