//! The server: a thread with everything on it.

use crate::app::App;
use crate::counts::Counts;
use crate::guard::Guard;
use crate::token::Token;
use crate::{Error, Feed, Recorder, Result, Takes, connection, routes};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;
use tokio::sync::watch;

/// What pages show.
#[derive(Clone, Debug)]
pub enum Content {
    /// What comes now.
    Live(Feed),
    /// Takes, which each page plays for itself.
    Takes(Takes),
}

/// How the page is served.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where it listens. Any address but a loopback one makes every page need a token; port 0 is one of the system's
    /// choice.
    pub listen: SocketAddr,
    /// Whether pages of this machine need a token too, as where several people share it.
    pub token: bool,
    /// How long a connection may take nothing of what is sent to it before it is closed.
    pub patience: Duration,
    /// What pages may record live streams with.
    pub recorder: Option<Recorder>,
}

impl Default for Options {
    /// Port 9780 of this machine alone, ten seconds of patience, no recorder.
    fn default() -> Self {
        Self {
            listen: SocketAddr::from((Ipv4Addr::LOCALHOST, 9780)),
            token: false,
            patience: Duration::from_secs(10),
            recorder: None,
        }
    }
}

/// A server that runs on a thread of its own, until it is dropped.
#[derive(Debug)]
pub struct Server {
    app: Arc<App>,
    address: SocketAddr,
    stop: watch::Sender<bool>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Starts to serve.
    ///
    /// # Errors
    /// [`Error::Listen`] when the address cannot be served on, [`Error::Token`] when there is no secret to be had for one
    /// that is not loopback.
    pub fn start(content: Content, options: &Options) -> Result<Self> {
        let failed = |error: std::io::Error| listen_error(options.listen, &error);
        let listener = TcpListener::bind(options.listen).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let needs_token = options.token || !address.ip().is_loopback();
        let token = needs_token.then(Token::new).transpose()?;
        let (stop, stopped) = watch::channel(false);
        let patience = options.patience;
        let (record, recorded) = match &options.recorder {
            Some(recorder) => {
                let (record, recorded) = watch::channel(recorder.record());
                (Some(record), Some(recorded))
            }
            None => (None, None),
        };
        let app = Arc::new(App {
            content,
            guard: Guard::new(address, token),
            counts: Arc::new(Counts::default()),
            recorder: options.recorder.clone(),
            recorded,
            written: std::sync::Mutex::default(),
            stop: stopped.clone(),
        });
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(failed)?;
        let served = Arc::clone(&app);
        let thread = thread::spawn(move || {
            if let (Some(recorder), Some(record)) = (served.recorder.clone(), record) {
                runtime.spawn(recorder.watch(record));
            }
            runtime.block_on(serve(listener, served, patience, stopped));
            runtime.shutdown_timeout(GOODBYE);
        });
        Ok(Self {
            app,
            address,
            stop,
            thread: Some(thread),
        })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The address of the page, with the token where one is needed. Where the server listens on all addresses, `host` is
    /// the one to name.
    pub fn url(&self, host: std::net::IpAddr) -> String {
        let ip = if self.address.ip().is_unspecified() {
            host
        } else {
            self.address.ip()
        };
        let address = SocketAddr::new(ip, self.address.port());
        match self.app.guard.token() {
            Some(token) => format!("http://{address}/?token={}", token.digits()),
            None => format!("http://{address}/"),
        }
    }

    /// How many pages are connected now.
    pub fn pages(&self) -> u64 {
        self.app.counts.pages.value()
    }

    /// Stops, after a word to every page.
    pub fn stop(self) {
        drop(self);
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.stop.send(true);
        if let Some(thread) = self.thread.take() {
            // Its panic was told where it happened.
            let _ = thread.join();
        }
    }
}

async fn serve(listener: TcpListener, app: Arc<App>, patience: Duration, stop: watch::Receiver<bool>) {
    // A socket that was bound and set up can be listened on.
    let Ok(listener) = tokio::net::TcpListener::from_std(listener) else {
        return;
    };
    let counts = Arc::clone(&app.counts);
    connection::serve(listener, routes::router(&app), Arc::clone(&counts), patience, stop).await;
    let begun = tokio::time::Instant::now();
    while counts.pages.value() > 0 && begun.elapsed() < GOODBYE {
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
}

fn listen_error(address: SocketAddr, error: &std::io::Error) -> Error {
    let text = error.to_string();
    let end = text.find(" (os error").unwrap_or(text.len());
    Error::Listen {
        address,
        kind: error.kind(),
        reason: text[..end].to_lowercase(),
    }
}

/// How long pages may take to hear that the server stops.
const GOODBYE: Duration = Duration::from_secs(1);
