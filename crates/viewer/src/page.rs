//! One page: what it asks for, and what it is sent.

use crate::Feed;
use crate::app::App;
use crate::live::LiveView;
use crate::series::{MOST_CHANNELS, Plot, Wish};
use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use serde::Deserialize;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::time::{Instant, sleep_until, timeout};

/// The most bytes of a page's message.
pub(crate) const MOST_MESSAGE: usize = 64 * 1024;

/// Sends a page what it asks for, until it goes, asks for what there is not, or the server stops.
pub(crate) async fn serve(socket: WebSocket, app: Arc<App>) {
    app.counts.pages.add(1);
    let (mut to, mut from) = socket.split();
    let wanted = Wanted::default();
    let mut stop = app.stop.clone();
    let end = tokio::select! {
        end = listen(&mut from, &wanted, &app) => end,
        end = show(&mut to, &wanted, &app) => end,
        _ = stop.wait_for(|stop| *stop) => End::Stopped,
    };
    if let Some(frame) = end.frame() {
        let _ = timeout(GOODBYE, to.send(Message::Close(Some(frame)))).await;
    }
    app.counts.pages.subtract(1);
}

/// What a page asks for.
#[derive(Debug)]
struct Wanted {
    rate_hz: AtomicU8,
    plot: Mutex<Option<Arc<Mutex<Plot>>>>,
}

impl Default for Wanted {
    fn default() -> Self {
        Self {
            rate_hz: AtomicU8::new(USUAL_RATE),
            plot: Mutex::default(),
        }
    }
}

impl Wanted {
    fn period(&self) -> Duration {
        Duration::from_secs(1) / u32::from(self.rate_hz.load(Ordering::Relaxed))
    }

    fn plot(&self) -> Option<Arc<Mutex<Plot>>> {
        lock(&self.plot).clone()
    }
}

/// How it ends with a page.
#[derive(Debug)]
enum End {
    /// It has gone.
    Gone,
    /// It sent what it must not.
    Refused(&'static str),
    /// The server stops.
    Stopped,
}

impl End {
    fn frame(self) -> Option<CloseFrame> {
        let (code, reason) = match self {
            Self::Gone => return None,
            Self::Refused(reason) => (close_code::POLICY, reason),
            Self::Stopped => (close_code::AWAY, "the server stops"),
        };
        Some(CloseFrame {
            code,
            reason: reason.into(),
        })
    }
}

/// A page's message.
#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
enum Request {
    Rate { hz: u8 },
    Plot { channels: Vec<Wish> },
}

async fn listen(from: &mut SplitStream<WebSocket>, wanted: &Wanted, app: &App) -> End {
    let mut pace = Pace::new();
    while let Some(message) = from.next().await {
        let refused = match message {
            Ok(Message::Text(_)) if !pace.allows() => Some("too many messages"),
            Ok(Message::Text(text)) => heed(&text, wanted, app),
            Ok(Message::Binary(_)) => Some("expected JSON"),
            Ok(Message::Close(_)) => return End::Gone,
            Ok(Message::Ping(_) | Message::Pong(_)) if pace.allows() => None,
            Ok(_) => Some("too many messages"),
            Err(error) => match fault(&error) {
                Some(fault) => Some(fault),
                None => return End::Gone,
            },
        };
        if let Some(reason) = refused {
            app.counts.refused.message.add(1);
            return End::Refused(reason);
        }
    }
    End::Gone
}

/// Does what a message asks for, or says why not.
fn heed(text: &str, wanted: &Wanted, app: &App) -> Option<&'static str> {
    match serde_json::from_str(text) {
        Ok(Request::Rate { hz: hz @ 1..=MOST_RATE }) => {
            wanted.rate_hz.store(hz, Ordering::Relaxed);
            None
        }
        Ok(Request::Rate { .. }) => Some("expected a rate from 1 to 120"),
        Ok(Request::Plot { channels }) if channels.len() <= MOST_CHANNELS => {
            *lock(&wanted.plot) = app.feed().map(|feed| feed.plot(channels));
            None
        }
        Ok(Request::Plot { .. }) => Some("expected at most 16 channels"),
        Err(_) => Some("expected JSON that asks for a rate or a plot"),
    }
}

/// What is wrong with what a page sent, unless it has just gone.
fn fault(error: &axum::Error) -> Option<&'static str> {
    let told = std::error::Error::source(error)?.to_string();
    let is = |beginning: &str| told.starts_with(beginning);
    if is("Space limit exceeded") {
        return Some("a message is at most 64 KiB long");
    }
    let has_gone = told.ends_with("Connection reset without closing handshake");
    ((is("WebSocket protocol error") && !has_gone) || is("UTF-8 encoding error"))
        .then_some("expected a WebSocket's frames")
}

async fn show(to: &mut SplitSink<WebSocket, Message>, wanted: &Wanted, app: &App) -> End {
    let ended = match app.feed() {
        Some(feed) => show_live(to, feed, wanted, app).await,
        None => show_takes(to, app).await,
    };
    // A page that can be sent nothing has gone.
    drop(ended);
    End::Gone
}

/// A page plays takes itself: it only has to hear what there is, and that the server is still there.
async fn show_takes(to: &mut SplitSink<WebSocket, Message>, app: &App) -> Result<(), axum::Error> {
    to.send(Message::text(app.scene(true))).await?;
    loop {
        tokio::time::sleep(SIGN_OF_LIFE).await;
        to.send(Message::Ping(axum::body::Bytes::new())).await?;
    }
}

/// Sends a tick whenever one is due and the page has taken the one before; those between are skipped.
async fn show_live(
    to: &mut SplitSink<WebSocket, Message>,
    feed: &Feed,
    wanted: &Wanted,
    app: &App,
) -> Result<(), axum::Error> {
    let mut view = LiveView::new();
    let mut next = Instant::now();
    loop {
        for words in view.words(feed, app) {
            to.send(Message::text(words)).await?;
        }
        let tick = view.tick(feed);
        app.counts.bytes.add(tick.len() as u64);
        to.send(Message::binary(tick)).await?;
        app.counts.ticks.add(1);
        for series in wanted.plot().map_or_else(Vec::new, |plot| view.series(&plot)) {
            to.send(Message::binary(series)).await?;
        }
        let missed = due_after(&mut next, wanted.period());
        app.counts.skipped.add(missed.into());
        view.go_on(missed);
        sleep_until(next).await;
    }
}

/// Moves `next` on to the first tick that is not past, and says how many it went over.
fn due_after(next: &mut Instant, period: Duration) -> u32 {
    *next += period;
    let late = Instant::now().saturating_duration_since(*next);
    let missed = (late.as_secs_f64() / period.as_secs_f64()).ceil() as u32;
    *next += period * missed;
    missed
}

/// How many messages a page may send.
struct Pace {
    second: Instant,
    count: u32,
}

impl Pace {
    fn new() -> Self {
        Self {
            second: Instant::now(),
            count: 0,
        }
    }

    fn allows(&mut self) -> bool {
        if self.second.elapsed() >= Duration::from_secs(1) {
            *self = Self::new();
        }
        self.count += 1;
        self.count <= MOST_MESSAGES_A_SECOND
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

const USUAL_RATE: u8 = 30;
const MOST_RATE: u8 = 120;
const MOST_MESSAGES_A_SECOND: u32 = 200;
const SIGN_OF_LIFE: Duration = Duration::from_secs(15);
const GOODBYE: Duration = Duration::from_secs(1);
