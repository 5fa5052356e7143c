//! A server on a port of the system's choice, pages that are connected to it, and plain requests.

use crate::decode::{self, Series, Tick};
use posewire::{Item, Sink, SourceId};
use posewire_motion::{DVec3, Frame, Skeleton, Subject};
use posewire_viewer::{Content, Feed, Options, Server, ViewerSink};
use serde_json::Value;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::time::Duration;
use tungstenite::client::IntoClientRequest;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::{Message, WebSocket};

/// How long anything may take that is waited for: a test that waits so long has failed.
pub(crate) const LONG: Duration = Duration::from_secs(20);

/// A server of a feed, which the test fills by hand.
pub(crate) struct Stage {
    pub(crate) server: Server,
    sink: ViewerSink,
}

impl Stage {
    pub(crate) fn new() -> Self {
        Self::with(&Options {
            listen: ([127, 0, 0, 1], 0).into(),
            ..Options::default()
        })
    }

    pub(crate) fn with(options: &Options) -> Self {
        let feed = Feed::new(&["mxtp://127.0.0.1:9763".parse().unwrap()]);
        let server = Server::start(Content::Live(feed.clone()), options).unwrap();
        let sink = ViewerSink::new(&feed);
        Self { server, sink }
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.server.address()
    }

    pub(crate) fn push(&mut self, item: &Item) {
        self.sink.accept(SourceId(0), item).unwrap();
    }

    /// A sample of a subject whose pelvis is at `x`.
    pub(crate) fn walk(&mut self, subject: &Arc<Subject>, sample: u32, x: f64) {
        let mut frame = Frame::new(Arc::clone(subject));
        frame.sample = sample;
        frame.time = Duration::from_millis(u64::from(sample));
        frame.position = vec![Some(DVec3::new(x, 0.0, 1.0)); subject.skeleton.segments.len()];
        self.show(frame);
    }

    pub(crate) fn show(&mut self, frame: Frame) {
        let frame = Arc::new(frame);
        self.push(&Item::Frame { frame, due: None });
    }

    pub(crate) fn page(&self) -> Page {
        Page::open(self.address())
    }

    /// A number of `/metrics`.
    pub(crate) fn metric(&self, name: &str) -> u64 {
        metric(self.address(), name)
    }
}

pub(crate) fn ada() -> Arc<Subject> {
    Arc::new(Subject::new("Ada", Skeleton::standard(0, false)))
}

/// A page that is connected.
pub(crate) struct Page {
    socket: WebSocket<TcpStream>,
}

impl Page {
    pub(crate) fn open(address: SocketAddr) -> Self {
        Self::try_open(address).unwrap()
    }

    pub(crate) fn try_open(address: SocketAddr) -> Result<Self, Box<dyn std::error::Error>> {
        let mut request = format!("ws://{address}/ws").into_client_request()?;
        let origin = format!("http://{address}").parse()?;
        request.headers_mut().insert("origin", origin);
        let stream = TcpStream::connect(address)?;
        stream.set_read_timeout(Some(LONG))?;
        let (socket, _) = tungstenite::client(request, stream).map_err(|error| error.to_string())?;
        Ok(Self { socket })
    }

    pub(crate) fn send(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    pub(crate) fn send_message(&mut self, message: Message) {
        // One that is refused while it is sent is closed all the same.
        let _ = self.socket.send(message);
    }

    /// Sends bytes beside the WebSocket.
    pub(crate) fn send_bytes(&mut self, bytes: &[u8]) {
        self.socket.get_mut().write_all(bytes).unwrap();
    }

    /// Reads until the server has closed the connection.
    pub(crate) fn ended(&mut self) {
        while self.socket.read().is_ok() {}
    }

    pub(crate) fn read(&mut self) -> Message {
        self.socket.read().unwrap()
    }

    /// The next words of a type.
    pub(crate) fn words(&mut self, kind: &str) -> Value {
        loop {
            if let Message::Text(text) = self.read() {
                let words: Value = serde_json::from_str(&text).unwrap();
                if words["type"] == kind {
                    return words;
                }
            }
        }
    }

    /// The next tick that has a record.
    pub(crate) fn moved(&mut self) -> Tick {
        loop {
            let tick = self.tick();
            if !tick.records.is_empty() {
                return tick;
            }
        }
    }

    pub(crate) fn tick(&mut self) -> Tick {
        loop {
            if let Message::Binary(bytes) = self.read()
                && bytes[0] == 1
            {
                return decode::tick(&bytes).unwrap();
            }
        }
    }

    pub(crate) fn series(&mut self) -> Series {
        loop {
            if let Message::Binary(bytes) = self.read()
                && bytes[0] == 2
            {
                return decode::series(&bytes).unwrap();
            }
        }
    }

    /// What is plotted until a tick has this sample.
    pub(crate) fn series_until_sample(&mut self, sample: u32) -> Vec<(f64, f32)> {
        let mut plotted = Vec::new();
        loop {
            let Message::Binary(bytes) = self.read() else { continue };
            if let Some(series) = decode::series(&bytes) {
                plotted.extend(series.samples());
            } else if decode::tick(&bytes)
                .unwrap()
                .records
                .iter()
                .any(|record| record.sample == sample)
            {
                return plotted;
            }
        }
    }

    /// What the server closes the connection with.
    pub(crate) fn closed(&mut self) -> CloseCode {
        loop {
            match self.socket.read() {
                Ok(Message::Close(Some(frame))) => return frame.code,
                Ok(_) => {}
                Err(error) => panic!("closed without a word: {error}"),
            }
        }
    }
}

/// The answer to a request: its status, head and body.
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: Vec<u8>,
}

impl Answer {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap()
    }
}

/// Asks with the right host.
pub(crate) fn ask(address: SocketAddr, path: &str) -> Answer {
    send(
        address,
        &format!("GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n"),
    )
    .unwrap()
}

/// Sends bytes and reads to the end.
pub(crate) fn send(address: SocketAddr, request: &str) -> std::io::Result<Answer> {
    let mut stream = TcpStream::connect(address)?;
    stream.set_read_timeout(Some(LONG))?;
    stream.write_all(request.as_bytes())?;
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes)?;
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
    let end = end.ok_or(std::io::ErrorKind::UnexpectedEof)?;
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    Ok(Answer {
        status: head[9..12].parse().unwrap_or_default(),
        head: head.to_lowercase(),
        body: bytes[end + 4..].to_vec(),
    })
}

/// A number of `/metrics`, with its labels in the name.
pub(crate) fn metric(address: SocketAddr, name: &str) -> u64 {
    let text = String::from_utf8(ask(address, "/metrics").body).unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    line.unwrap_or_else(|| panic!("no {name} in {text}")).parse().unwrap()
}
