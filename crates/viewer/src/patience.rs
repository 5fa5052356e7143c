//! A connection that is given up when its other end takes nothing for a while, and that lets it take the last words.

use crate::counts::Counts;
use crate::room::Place;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt, ReadBuf};
use tokio::net::TcpStream;
use tokio::runtime::Handle;
use tokio::time::{Instant, Sleep, sleep, timeout};

/// A connection whose writing fails when nothing could be written for a while: a page that is stuck, or a download
/// that nobody takes, holds its place no longer.
///
/// When it is dropped, what still comes is read for a moment: bytes that nobody has read would make the system take back
/// what was said last, as why a request or a message was refused.
#[derive(Debug)]
pub(crate) struct Patient {
    /// There until it is dropped.
    stream: Option<TcpStream>,
    patience: Duration,
    waiting: Pin<Box<Sleep>>,
    is_waiting: bool,
    counts: Arc<Counts>,
    place: Option<Place>,
}

impl Patient {
    /// A connection that holds its place among those that are served until it is closed.
    pub(crate) fn new(stream: TcpStream, patience: Duration, counts: Arc<Counts>, place: Place) -> Self {
        counts.connections.add(1);
        Self {
            stream: Some(stream),
            patience,
            waiting: Box::pin(sleep(patience)),
            is_waiting: false,
            counts,
            place: Some(place),
        }
    }

    fn stream(&mut self) -> io::Result<Pin<&mut TcpStream>> {
        self.stream
            .as_mut()
            .map(Pin::new)
            .ok_or(io::ErrorKind::NotConnected.into())
    }

    /// Passes on what a write gave, or fails when it has waited too long.
    fn judge<T>(&mut self, written: Poll<io::Result<T>>, context: &mut Context<'_>) -> Poll<io::Result<T>> {
        if written.is_ready() {
            self.is_waiting = false;
            return written;
        }
        if !self.is_waiting {
            self.is_waiting = true;
            let until = Instant::now() + self.patience;
            self.waiting.as_mut().reset(until);
        }
        match self.waiting.as_mut().poll(context) {
            Poll::Pending => Poll::Pending,
            Poll::Ready(()) => {
                self.counts.stalled.add(1);
                Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
            }
        }
    }
}

impl Drop for Patient {
    fn drop(&mut self) {
        self.counts.connections.subtract(1);
        if let (Some(stream), Ok(runtime)) = (self.stream.take(), Handle::try_current()) {
            runtime.spawn(timeout(FAREWELL, part(stream, self.place.take())));
        }
    }
}

/// Says that nothing more will be said, and reads what still comes.
async fn part(mut stream: TcpStream, _place: Option<Place>) -> io::Result<()> {
    let mut unread = [0; 4096];
    stream.shutdown().await?;
    while stream.read(&mut unread).await? > 0 {}
    Ok(())
}

impl AsyncRead for Patient {
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context<'_>, to: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        self.stream()?.poll_read(cx, to)
    }
}

impl AsyncWrite for Patient {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let written = self.stream()?.poll_write(cx, bytes);
        self.judge(written, cx)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        parts: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = self.stream()?.poll_write_vectored(cx, parts);
        self.judge(written, cx)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.as_ref().is_some_and(AsyncWrite::is_write_vectored)
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.stream()?.poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.stream()?.poll_shutdown(cx)
    }
}

/// How long what still comes is read.
const FAREWELL: Duration = Duration::from_secs(1);
