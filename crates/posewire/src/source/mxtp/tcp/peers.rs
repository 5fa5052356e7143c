//! The threads that connect, and one for each connection that reads it.

use super::News;
use crate::clock;
use crate::net::{self, Backoff, TcpConnection, TcpIncoming};
use crate::queue::Producer;
use crate::source::report::{DRAIN_LIMIT, TICK};
use crate::stop::Stop;
use crate::{Error, Result};
use std::net::SocketAddr;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Takes every peer that connects, each on a thread of its own, until the end; then waits for these threads.
pub(super) fn accept_peers(incoming: &TcpIncoming, news: &Producer<News>, ending: &Stop) {
    let open = &AtomicUsize::new(0);
    thread::scope(|peers| {
        let mut trouble = Trouble::new(news);
        for connection in 0.. {
            if news.is_closed() {
                break;
            }
            match accept_within_limit(incoming, open, ending) {
                Ok(Some(accepted)) => {
                    trouble.is_over();
                    open.fetch_add(1, Ordering::Relaxed);
                    peers.spawn(move || {
                        read_from(accepted, connection, news, ending);
                        open.fetch_sub(1, Ordering::Relaxed);
                    });
                }
                Ok(None) if ending.is_stopped() => break,
                Ok(None) => {}
                Err(error) => {
                    trouble.tell(error);
                    if ending.wait(ACCEPT_AGAIN) {
                        break;
                    }
                }
            }
        }
    });
}

/// The next connection while fewer than [`MAX_CONNECTIONS`] are open; at the end only what has called by then.
fn accept_within_limit(incoming: &TcpIncoming, open: &AtomicUsize, ending: &Stop) -> Result<Option<TcpConnection>> {
    if open.load(Ordering::Relaxed) < MAX_CONNECTIONS {
        return incoming.accept(Duration::from_secs(1), ending);
    }
    ending.wait(TICK);
    Ok(None)
}

/// Connects, and connects again whenever the connection is lost, until the end.
pub(super) fn call_peer(addresses: &[SocketAddr], news: &Producer<News>, ending: &Stop) {
    let mut trouble = Trouble::new(news);
    let mut backoff = Backoff::default();
    for connection in 0.. {
        match connect_to_any(addresses, ending) {
            Ok(Some(connected)) => {
                trouble.is_over();
                let begun = Instant::now();
                read_from(connected, connection, news, ending);
                if begun.elapsed() >= STEADY {
                    backoff.reset();
                }
            }
            Ok(None) => break,
            Err(error) => trouble.tell(error),
        }
        if ending.wait(backoff.next_delay()) {
            break;
        }
    }
}

/// The first connection that comes about; `None` at the end. The error is that of the last address.
fn connect_to_any(addresses: &[SocketAddr], ending: &Stop) -> Result<Option<TcpConnection>> {
    let mut failure = None;
    for address in addresses {
        if ending.is_stopped() {
            return Ok(None);
        }
        match net::connect_to(*address, CONNECT_TIMEOUT) {
            Ok(connected) => return Ok(Some(connected)),
            Err(error) => failure = Some(error),
        }
    }
    failure.map_or(Ok(None), Err)
}

/// Failures in a row, of which only the first is told.
struct Trouble<'a> {
    told: bool,
    news: &'a Producer<News>,
}

impl<'a> Trouble<'a> {
    fn new(news: &'a Producer<News>) -> Self {
        Self { told: false, news }
    }

    fn tell(&mut self, error: Error) {
        tracing::debug!(%error, "not connected yet");
        if !std::mem::replace(&mut self.told, true) {
            // When the queue is closed nobody is left to be told.
            let _ = self.news.push(News::NotConnected(error));
        }
    }

    fn is_over(&mut self) {
        self.told = false;
    }
}

/// Hands over what a peer sends until it ends the stream, the queue closes or the end.
fn read_from(mut from: TcpConnection, connection: usize, news: &Producer<News>, ending: &Stop) {
    let peer = from.peer().to_string();
    let connected = News::Connected {
        connection,
        peer: peer.clone(),
    };
    if news.push(connected).is_err() {
        return;
    }
    if let Some(reason) = read_all(&mut from, connection, news, ending) {
        // When the queue is closed nobody is left to be told.
        let _ = news.push(News::Ended {
            connection,
            at: clock::now(),
            peer,
            reason,
        });
    }
}

/// Why the peer sends no more; `None` when it is we who read no more.
///
/// At the end of the source, what has come by then is still read, within [`DRAIN_LIMIT`].
fn read_all(from: &mut TcpConnection, connection: usize, news: &Producer<News>, ending: &Stop) -> Option<String> {
    let mut buffer = vec![0; READ_SIZE];
    let mut until = None;
    loop {
        let timeout = patience(ending, &mut until)?;
        let count = match from.read(&mut buffer, timeout) {
            Ok(None) if timeout.is_zero() => return None,
            Ok(None) => continue,
            Ok(Some(0)) => return Some("it ended the stream".to_owned()),
            Ok(Some(count)) => count,
            Err(error) => return Some(error.to_string()),
        };
        let bytes = News::Bytes {
            connection,
            at: clock::now(),
            bytes: buffer.get(..count).unwrap_or_default().to_vec(),
        };
        news.push(bytes).ok()?;
    }
}

/// How long to wait for the next bytes: not at all once the source ends, and `None` when its limit has passed.
fn patience(ending: &Stop, until: &mut Option<Instant>) -> Option<Duration> {
    if !ending.is_stopped() {
        return Some(TICK);
    }
    let until = *until.get_or_insert_with(|| Instant::now() + DRAIN_LIMIT);
    (Instant::now() < until).then_some(Duration::ZERO)
}

const READ_SIZE: usize = 64 * 1024;
const MAX_CONNECTIONS: usize = 16;
/// An attempt cannot be cut short, so the end of the source may have to wait for one.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(1);
/// A connection that lasted so long was one; a peer that hangs up at once is called less and less often.
const STEADY: Duration = Duration::from_secs(1);
/// What keeps the system from accepting, as too many open files, may pass.
const ACCEPT_AGAIN: Duration = Duration::from_secs(1);
