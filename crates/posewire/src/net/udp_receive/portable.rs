//! Receiving with nothing but the standard library: the program's own stamps, no drop counts.

use std::io;
use std::net::UdpSocket;

use super::{LARGEST_DATAGRAM, Received, canonical};
use crate::clock;

/// The buffer of one receiving socket.
#[derive(Debug)]
pub(super) struct Reader {
    bytes: Box<[u8]>,
}

impl Reader {
    #[expect(clippy::unnecessary_wraps, reason = "the same signature on every system")]
    pub(super) fn new(_socket: &UdpSocket) -> io::Result<Self> {
        Ok(Self {
            bytes: vec![0; LARGEST_DATAGRAM].into(),
        })
    }

    #[expect(clippy::unused_self, reason = "the same signature on every system")]
    pub(super) fn kernel_dropped(&self) -> u64 {
        0
    }

    /// Takes one datagram, waiting for it as long as the socket's timeout if `wait` is set.
    pub(super) fn receive(
        &mut self,
        socket: &UdpSocket,
        wait: bool,
        each: &mut impl FnMut(Received<'_>),
    ) -> io::Result<usize> {
        socket.set_nonblocking(!wait)?;
        let (length, from) = socket.recv_from(&mut self.bytes)?;
        each(Received {
            bytes: self.bytes.get(..length).unwrap_or_default(),
            from: canonical(from),
            stamp: clock::now(),
            truncated: false,
        });
        Ok(1)
    }
}
