//! The page, served.

use super::qr;
use crate::context::say;
use crate::error::Failure;
use posewire::Sink;
use posewire::endpoint::Endpoint;
use posewire_viewer::{Content, Feed, Options, Server, ViewerSink};
use std::io::IsTerminal;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::process::{Command, Stdio};

/// The page, served until it is dropped.
#[derive(Debug)]
pub(crate) struct Browser {
    feed: Feed,
    server: Server,
    url: String,
}

impl Browser {
    /// Serves what comes from these sources, if it is to be shown, and says where.
    pub(crate) fn beside(listen: Option<SocketAddr>, sources: &[Endpoint]) -> anyhow::Result<Option<Self>> {
        let listen = listen.map(|listen| {
            Self::live(
                &Options {
                    listen,
                    ..Options::default()
                },
                sources,
            )
        });
        let browser = listen.transpose().map_err(|error| failure(&error))?;
        browser.iter().for_each(Self::announce);
        Ok(browser)
    }

    /// The same on a port of the system's choice where the usual one is taken.
    pub(crate) fn anywhere(listen: Option<SocketAddr>, sources: &[Endpoint]) -> anyhow::Result<Option<Self>> {
        let options = Options::default();
        let elsewhere = Options {
            listen: SocketAddr::new(options.listen.ip(), 0),
            ..Options::default()
        };
        let browser = match listen {
            Some(listen) => Self::live(
                &Options {
                    listen,
                    ..Options::default()
                },
                sources,
            ),
            None => Self::live(&options, sources).or_else(|_| Self::live(&elsewhere, sources)),
        };
        let browser = browser.map_err(|error| failure(&error))?;
        browser.announce();
        Ok(Some(browser))
    }

    /// Serves what comes from these sources.
    pub(crate) fn live(options: &Options, sources: &[Endpoint]) -> posewire_viewer::Result<Self> {
        Self::of(Feed::new(sources), None, options)
    }

    /// Serves takes.
    pub(crate) fn takes(takes: posewire_viewer::Takes, options: &Options) -> posewire_viewer::Result<Self> {
        Self::of(Feed::new(&[]), Some(takes), options)
    }

    fn of(feed: Feed, takes: Option<posewire_viewer::Takes>, options: &Options) -> posewire_viewer::Result<Self> {
        let content = takes.map_or_else(|| Content::Live(feed.clone()), Content::Takes);
        let server = Server::start(content, options)?;
        let url = server.url(own_address());
        Ok(Self { feed, server, url })
    }

    /// The sink that feeds it.
    pub(crate) fn sink(&self) -> Box<dyn Sink> {
        Box::new(ViewerSink::new(&self.feed))
    }

    /// Where it is served, with the token that it needs.
    pub(crate) fn url(&self) -> &str {
        &self.url
    }

    /// Says where it is served; to phones and tablets with a picture.
    pub(crate) fn announce(&self) {
        say(format_args!("open {}", self.url));
        if !self.server.address().ip().is_loopback() && std::io::stderr().is_terminal() {
            qr::code(&self.url).into_iter().for_each(say);
        }
    }

    /// Opens it in the browser of this machine.
    pub(crate) fn open(&self) {
        let (program, arguments): (_, &[&str]) = match std::env::consts::OS {
            "macos" => ("open", &[]),
            "windows" => ("cmd", &["/C", "start", ""]),
            _ => ("xdg-open", &[]),
        };
        let quiet = Command::new(program)
            .args(arguments)
            .arg(&self.url)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        if let Err(error) = quiet {
            say(format_args!("no browser could be opened with {program}: {error}"));
        }
    }
}

/// Why a page beside another verb is not served: its address is that of `--view`.
fn failure(error: &posewire_viewer::Error) -> Failure {
    Failure {
        problem: error.to_string(),
        help: error.help_with("--view=").unwrap_or_default(),
    }
}

/// The address by which others reach this machine, as far as the system's routes tell. Nothing is sent to find out.
fn own_address() -> IpAddr {
    let asked = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).and_then(|socket| {
        socket.connect(("192.0.2.1", 9))?;
        socket.local_addr()
    });
    asked.map_or(Ipv4Addr::LOCALHOST.into(), |own| own.ip())
}
