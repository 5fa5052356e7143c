//! Connections: those that find a place are served, the others are told that there is no room.

use crate::counts::Counts;
use crate::patience::Patient;
use crate::room::{Place, Room};
use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use socket2::{SockRef, TcpKeepalive};
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{Semaphore, watch};
use tokio::time::{sleep, timeout};

/// Serves connections until `stop` is set. One that takes nothing for as long as `patience` is closed.
pub(crate) async fn serve(
    listener: TcpListener,
    router: Router,
    counts: Arc<Counts>,
    patience: Duration,
    mut stop: watch::Receiver<bool>,
) {
    let room = Room::new(patience / 5);
    let refusing = Arc::new(Semaphore::new(MOST_REFUSALS));
    loop {
        let accepted = tokio::select! {
            accepted = listener.accept() => accepted,
            _ = stop.wait_for(|stop| *stop) => return,
        };
        let Ok((stream, from)) = accepted else {
            // No more files can be opened: some will be closed.
            sleep(Duration::from_millis(100)).await;
            continue;
        };
        if let Some(place) = room.admit(from.ip()) {
            prepare(&stream);
            tokio::spawn(serve_one(stream, patience, Arc::clone(&counts), place, router.clone()));
        } else {
            counts.refused.connections.add(1);
            if let Ok(place) = Arc::clone(&refusing).try_acquire_owned() {
                tokio::spawn(async move {
                    let _ = timeout(Duration::from_secs(1), refuse(stream)).await;
                    drop(place);
                });
            }
        }
    }
}

async fn serve_one(stream: TcpStream, patience: Duration, counts: Arc<Counts>, place: Place, router: Router) {
    let guest = place.guest();
    let router = router.layer(Extension(place.guest()));
    let stream = Patient::new(stream, patience, counts, place);
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME)
        .max_buf_size(MOST_HEAD)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router))
        .with_upgrades();
    // What goes wrong with a connection ends it, and is of no interest to others.
    tokio::select! {
        _ = served => {}
        () = guest.sent_away() => {}
    }
}

/// A tick leaves at once, little is sent ahead of what a slow page can show, and who has vanished is noticed. None of it
/// is needed to serve.
fn prepare(stream: &TcpStream) {
    let _ = stream.set_nodelay(true);
    let socket = SockRef::from(stream);
    let _ = socket.set_send_buffer_size(SEND_BUFFER);
    let _ = socket.set_tcp_keepalive(&TcpKeepalive::new().with_time(Duration::from_secs(30)));
    #[cfg(target_os = "linux")]
    let _ = socket.set_tcp_user_timeout(Some(Duration::from_secs(30)));
}

/// Says that there is no room. What is asked is read to its end: bytes that nobody has read would take the answer with
/// them.
async fn refuse(mut stream: TcpStream) -> std::io::Result<()> {
    let mut asked = [0; 4096];
    stream.write_all(NO_ROOM).await?;
    stream.shutdown().await?;
    while stream.read(&mut asked).await? > 0 {}
    Ok(())
}

const NO_ROOM: &[u8] = b"HTTP/1.1 503 Service Unavailable\r\nconnection: close\r\nretry-after: 5\r\n\
    content-type: application/json\r\ncontent-length: 76\r\n\r\n\
    {\"error\":\"as many connections are open as can be\",\"help\":\"close some pages\"}";
/// The most connections that are being told so at a time; those beyond are closed without a word.
const MOST_REFUSALS: usize = 256;
const SEND_BUFFER: usize = 128 * 1024;
/// How long the head of a request may take to come.
const HEAD_TIME: Duration = Duration::from_secs(10);
/// The most bytes of a request's head.
const MOST_HEAD: usize = 16 * 1024;
