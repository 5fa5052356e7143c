//! TCP both ways, with a limit on how long a peer may stall.

use std::io::{self, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use socket2::{SockRef, TcpKeepalive};

use super::resolve::resolve;
use crate::endpoint::TcpAddress;
use crate::error::{Error, Result};
use crate::stop::Stop;

/// Listens for connections on the address.
///
/// # Errors
/// [`Error::Resolve`], and [`Error::Socket`] when the system refuses, as when the port is in use.
pub fn listen(address: &TcpAddress) -> Result<TcpIncoming> {
    let addresses = resolve(&address.host, address.port)?;
    let place = || format!("tcp {}:{}", address.host, address.port);
    let refused = |error: io::Error| Error::socket("listen on", place(), &error);
    let listener = TcpListener::bind(addresses.as_slice()).map_err(refused)?;
    listener.set_nonblocking(true).map_err(refused)?;
    Ok(TcpIncoming {
        local: listener.local_addr().map_err(refused)?,
        listener,
    })
}

/// Connects to the address, trying each that a host name has for at most `timeout`.
///
/// # Errors
/// [`Error::Resolve`], and [`Error::Socket`] when none answers; it is the last one's failure.
pub fn connect(address: &TcpAddress, timeout: Duration) -> Result<TcpConnection> {
    let mut failure = io::Error::from(io::ErrorKind::AddrNotAvailable);
    let timeout = timeout.max(Duration::from_millis(1));
    for target in resolve(&address.host, address.port)? {
        match TcpStream::connect_timeout(&target, timeout).and_then(|stream| TcpConnection::over(stream, target)) {
            Ok(connection) => return Ok(connection),
            Err(error) => failure = error,
        }
    }
    let place = format!("tcp {}:{}", address.host, address.port);
    Err(Error::socket("connect to", place, &failure))
}

/// Connects to one address within `timeout`.
///
/// # Errors
/// [`Error::Socket`] when it does not answer or refuses.
pub(crate) fn connect_to(address: SocketAddr, timeout: Duration) -> Result<TcpConnection> {
    TcpStream::connect_timeout(&address, timeout.max(Duration::from_millis(1)))
        .and_then(|stream| TcpConnection::over(stream, address))
        .map_err(|error| Error::socket("connect to", format!("tcp {address}"), &error))
}

/// A listening TCP socket.
#[derive(Debug)]
pub struct TcpIncoming {
    listener: TcpListener,
    local: SocketAddr,
}

impl TcpIncoming {
    /// Waits at most `timeout` for a connection; `None` when none came until then, or until `stop` was set. Who called before that
    /// is accepted all the same.
    ///
    /// # Errors
    /// [`Error::Socket`] when the system refuses, as when too many files are open.
    pub fn accept(&self, timeout: Duration, stop: &Stop) -> Result<Option<TcpConnection>> {
        let deadline = Instant::now().checked_add(timeout);
        let mut is_over = false;
        loop {
            let accepted = self.listener.accept();
            match accepted.and_then(|(stream, peer)| TcpConnection::over(stream, peer)) {
                Ok(connection) => return Ok(Some(connection)),
                Err(error) if is_passing(&error) => {}
                Err(error) => {
                    let place = format!("tcp {}", self.local);
                    return Err(Error::socket("accept a connection on", place, &error));
                }
            }
            if is_over {
                return Ok(None);
            }
            let left = deadline.map_or(timeout, |end| end.saturating_duration_since(Instant::now()));
            // Somebody may have called while this waited.
            is_over = left.is_zero() || stop.wait(left.min(ACCEPT_INTERVAL));
        }
    }

    /// The address that is listened on, its port the real one.
    pub fn local_address(&self) -> SocketAddr {
        self.local
    }
}

/// An open TCP connection, without delay for small writes and with keep-alive.
#[derive(Debug)]
pub struct TcpConnection {
    stream: TcpStream,
    peer: SocketAddr,
    local: SocketAddr,
    read_timeout: Option<Duration>,
    write_timeout: Option<Duration>,
}

impl TcpConnection {
    /// Waits at most `timeout` for bytes. Gives how many came, 0 when the peer ended the stream,
    /// and `None` when nothing came in time.
    ///
    /// # Errors
    /// [`Error::Socket`] when the connection broke.
    pub fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<Option<usize>> {
        use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
        let timeout = timeout.max(Duration::from_millis(1));
        if self.read_timeout != Some(timeout) {
            let outcome = self.stream.set_read_timeout(Some(timeout));
            outcome.map_err(|error| self.broken("read from", &error))?;
            self.read_timeout = Some(timeout);
        }
        match self.stream.read(buffer) {
            Ok(count) => Ok(Some(count)),
            Err(error) if matches!(error.kind(), Interrupted | TimedOut | WouldBlock) => Ok(None),
            Err(error) => Err(self.broken("read from", &error)),
        }
    }

    /// Writes as much as the peer takes at once, waiting at most `timeout` for it to take any. Gives how many bytes it
    /// took, 0 when none in time.
    ///
    /// # Errors
    /// [`Error::Socket`] when the connection broke.
    pub fn write_some(&mut self, bytes: &[u8], timeout: Duration) -> Result<usize> {
        use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
        let timeout = timeout.max(Duration::from_millis(1));
        if self.write_timeout != Some(timeout) {
            let outcome = self.stream.set_write_timeout(Some(timeout));
            outcome.map_err(|error| self.broken("write to", &error))?;
            self.write_timeout = Some(timeout);
        }
        match self.stream.write(bytes) {
            Ok(0) if !bytes.is_empty() => Err(self.broken("write to", &io::ErrorKind::WriteZero.into())),
            Ok(count) => Ok(count),
            Err(error) if matches!(error.kind(), Interrupted | TimedOut | WouldBlock) => Ok(0),
            Err(error) => Err(self.broken("write to", &error)),
        }
    }

    /// Tells the peer that nothing more will be written. What was written still arrives.
    ///
    /// # Errors
    /// [`Error::Socket`] when the connection broke before.
    pub fn finish(&mut self) -> Result<()> {
        let outcome = self.stream.shutdown(Shutdown::Write);
        outcome.map_err(|error| self.broken("end", &error))
    }

    /// The other side's address.
    pub fn peer(&self) -> SocketAddr {
        self.peer
    }

    /// This side's address.
    pub fn local_address(&self) -> SocketAddr {
        self.local
    }

    fn over(stream: TcpStream, peer: SocketAddr) -> io::Result<Self> {
        // Some systems hand the listener's mode on to what it accepts.
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        let keep_alive = TcpKeepalive::new().with_time(KEEP_ALIVE);
        SockRef::from(&stream).set_tcp_keepalive(&keep_alive)?;
        Ok(Self {
            local: stream.local_addr()?,
            stream,
            peer,
            read_timeout: None,
            write_timeout: None,
        })
    }

    fn broken(&self, action: &'static str, error: &io::Error) -> Error {
        Error::socket(action, format!("tcp {}", self.peer), error)
    }

    pub(crate) fn stalled(&self, written: usize, length: usize, limit: Duration) -> Error {
        Error::Stalled {
            peer: format!("tcp {}", self.peer),
            written,
            length,
            limit,
        }
    }
}

/// Nobody there yet, or a caller who hung up before the answer.
fn is_passing(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionReset, Interrupted, WouldBlock};
    matches!(
        error.kind(),
        ConnectionAborted | ConnectionReset | Interrupted | WouldBlock
    )
}

const ACCEPT_INTERVAL: Duration = Duration::from_millis(20);
const KEEP_ALIVE: Duration = Duration::from_secs(10);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::endpoint::Host;

    const SOON: Duration = Duration::from_secs(5);

    fn loopback(port: u16) -> TcpAddress {
        TcpAddress::new(Host::Address([127, 0, 0, 1].into()), port)
    }

    fn pair() -> (TcpConnection, TcpConnection) {
        let incoming = listen(&loopback(0)).unwrap();
        let caller = connect(&loopback(incoming.local_address().port()), SOON).unwrap();
        let callee = incoming.accept(SOON, &Stop::new()).unwrap().unwrap();
        (caller, callee)
    }

    #[test]
    fn bytes_go_both_ways_until_the_end() {
        let (mut caller, mut callee) = pair();
        let mut buffer = [0; 64];
        assert_eq!(caller.write_some(b"MXTP", SOON), Ok(4));
        assert_eq!(callee.read(&mut buffer, SOON), Ok(Some(4)));
        assert_eq!(caller.read(&mut buffer, Duration::from_millis(1)), Ok(None));
        assert_eq!(callee.write_some(b"ok", SOON), Ok(2));
        assert_eq!(caller.read(&mut buffer, SOON), Ok(Some(2)));
        caller.finish().unwrap();
        assert_eq!(callee.read(&mut buffer, SOON), Ok(Some(0)));
    }

    #[test]
    fn a_peer_that_reads_nothing_takes_nothing_in_the_end() {
        let (mut caller, _callee) = pair();
        let bytes = vec![0; 1 << 20];
        let mut taken = 0;
        loop {
            match caller.write_some(&bytes, Duration::from_millis(20)).unwrap() {
                0 => break,
                count => taken += count,
            }
            assert!(taken < 1 << 30, "the system keeps a bounded part of a stream");
        }
    }

    #[test]
    fn nobody_listening_is_a_clear_error() {
        let incoming = listen(&loopback(0)).unwrap();
        let local = incoming.local_address();
        drop(incoming);
        let error = connect(&loopback(local.port()), SOON).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with(&format!("cannot connect to tcp {local}: "))
        );
        assert!(
            error
                .help()
                .unwrap()
                .starts_with(&format!("nothing listens on {local}"))
        );
    }

    #[test]
    fn a_port_in_use_is_a_clear_error() {
        let incoming = listen(&loopback(0)).unwrap();
        let error = listen(&loopback(incoming.local_address().port())).unwrap_err();
        assert!(
            error
                .help()
                .unwrap()
                .starts_with("another program listens on 127.0.0.1:")
        );
    }

    #[test]
    fn who_has_called_before_the_stop_is_accepted() {
        for _ in 0..20 {
            let (incoming, stop) = (listen(&loopback(0)).unwrap(), Stop::new());
            let address = loopback(incoming.local_address().port());
            let at_stop = stop.clone();
            let waiting = std::thread::spawn(move || incoming.accept(Duration::from_hours(1), &at_stop));
            let _caller = connect(&address, SOON).unwrap();
            stop.stop();
            assert!(waiting.join().unwrap().unwrap().is_some());
        }
    }

    #[test]
    fn waiting_for_a_caller_ends_in_time_or_at_the_stop() {
        let incoming = listen(&loopback(0)).unwrap();
        let stop = Stop::new();
        assert!(incoming.accept(Duration::ZERO, &stop).unwrap().is_none());
        stop.stop();
        assert!(incoming.accept(Duration::from_hours(1), &stop).unwrap().is_none());
    }
}
