//! Network addresses as an endpoint spells them.

use std::fmt;
use std::net::{IpAddr, Ipv6Addr};

use super::url::Url;
use crate::Result;

/// The port that MVN's Network Streamer sends to unless told otherwise.
pub const DEFAULT_PORT: u16 = 9763;

/// A host: a numeric address, or a name that is looked up when a socket is opened.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Host {
    /// An IPv4 or IPv6 address.
    Address(IpAddr),
    /// A host name, as given.
    Name(String),
}

/// A network interface, by either of the ways people name one.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Interface {
    /// The interface that has this address.
    Address(IpAddr),
    /// The interface of this name, as the system spells it: `eth0`, `lo`.
    Name(String),
}

/// Where MXTP datagrams go to or arrive at: `mxtp://HOST[:9763][?interface=..&ttl=..]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct UdpAddress {
    /// The target of a sink; the address a source binds, or the multicast group it joins.
    pub host: Host,
    /// The UDP port. 0 lets the system choose one when binding.
    pub port: u16,
    /// The interface to send from or receive on; the system's choice if absent.
    pub interface: Option<Interface>,
    /// How many routers a sent datagram may pass; for multicast 1 if absent.
    pub ttl: Option<u8>,
}

/// Where an MXTP byte stream comes from or goes to: `mxtp+tcp://HOST[:9763][?mode=..]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct TcpAddress {
    /// The host to connect to, or the address to listen on.
    pub host: Host,
    /// The TCP port. 0 lets the system choose one when listening.
    pub port: u16,
    /// Who calls whom; if absent, a sink connects and a source listens, as MVN has it.
    pub mode: Option<TcpMode>,
}

/// Which side of a TCP connection this program takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TcpMode {
    /// Wait for the other side to connect.
    Listen,
    /// Connect to the other side.
    Connect,
}

impl UdpAddress {
    /// The address of `host` and `port`, with the system's interface and time to live.
    pub fn new(host: Host, port: u16) -> Self {
        Self {
            host,
            port,
            interface: None,
            ttl: None,
        }
    }

    pub(super) fn parse(whole: &str, body: &str) -> Result<Self> {
        let url = Url::cut(whole, body, &["interface", "ttl"])?;
        let (host, port) = parse_place(&url, DEFAULT_PORT)?;
        Ok(Self {
            host,
            port,
            interface: parse_interface(&url)?,
            ttl: url.parsed("ttl", "a number from 0 to 255", |_| true)?,
        })
    }
}

impl TcpAddress {
    /// The address of `host` and `port`, with each role's usual mode.
    pub fn new(host: Host, port: u16) -> Self {
        Self { host, port, mode: None }
    }

    pub(super) fn parse(whole: &str, body: &str) -> Result<Self> {
        let url = Url::cut(whole, body, &["mode"])?;
        let (host, port) = parse_place(&url, DEFAULT_PORT)?;
        let mode = match url.option("mode") {
            None => None,
            Some("listen") => Some(TcpMode::Listen),
            Some("connect") => Some(TcpMode::Connect),
            Some(other) => return Err(url.mistake("mode", "listen or connect", other)),
        };
        Ok(Self { host, port, mode })
    }
}

/// `//HOST[:PORT][/]`, with the port that is meant where none is given.
pub(super) fn parse_place(url: &Url<'_>, usual_port: u16) -> Result<(Host, u16)> {
    let Some(place) = url.place.strip_prefix("//") else {
        return Err(url.mistake("address", "// after the scheme", url.place));
    };
    let place = place.strip_suffix('/').unwrap_or(place);
    if let Some(bracketed) = place.strip_prefix('[') {
        return parse_bracketed(url, bracketed, usual_port);
    }
    let (host, port) = match place.split_once(':') {
        Some((_, rest)) if rest.contains(':') => {
            return Err(url.mistake("host", "an IPv6 address in brackets", place));
        }
        Some((host, port)) => (host, parse_port(url, port)?),
        None => (place, usual_port),
    };
    Ok((parse_host(url, host)?, port))
}

/// What follows a `[`: `ADDRESS][:PORT]`.
fn parse_bracketed(url: &Url<'_>, text: &str, usual_port: u16) -> Result<(Host, u16)> {
    let Some((address, rest)) = text.split_once(']') else {
        return Err(url.mistake("host", "a closing bracket", text));
    };
    let Ok(address) = address.parse::<Ipv6Addr>() else {
        return Err(url.mistake("host", "an IPv6 address in brackets", address));
    };
    let port = match (rest, rest.strip_prefix(':')) {
        ("", _) => usual_port,
        (_, Some(port)) => parse_port(url, port)?,
        (_, None) => return Err(url.mistake("port", "a colon and a number", rest)),
    };
    Ok((Host::Address(address.into()), port))
}

fn parse_port(url: &Url<'_>, text: &str) -> Result<u16> {
    let digits = text.bytes().all(|byte| byte.is_ascii_digit());
    match text.parse() {
        Ok(port) if digits => Ok(port),
        _ => Err(url.mistake("port", "a number from 0 to 65535", text)),
    }
}

fn parse_host(url: &Url<'_>, text: &str) -> Result<Host> {
    if let Ok(address) = text.parse() {
        return Ok(Host::Address(address));
    }
    if !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit() || b == b'.') {
        return Err(url.mistake("host", "four numbers from 0 to 255", text));
    }
    let named = text
        .chars()
        .all(|c| c.is_alphanumeric() || matches!(c, '.' | '-' | '_'));
    if text.is_empty() || text.len() > LONGEST_NAME || !named {
        return Err(url.mistake("host", "a name or an address", text));
    }
    Ok(Host::Name(text.into()))
}

pub(super) fn parse_interface(url: &Url<'_>) -> Result<Option<Interface>> {
    let Some(text) = url.option("interface") else {
        return Ok(None);
    };
    let bare = text.strip_prefix('[').and_then(|t| t.strip_suffix(']'));
    if let Ok(address) = bare.unwrap_or(text).parse() {
        return Ok(Some(Interface::Address(address)));
    }
    if text.is_empty() || text.len() > LONGEST_NAME {
        return Err(url.mistake("interface", "a name or an address", text));
    }
    Ok(Some(Interface::Name(text.into())))
}

/// The longest name that the domain name system carries, in bytes.
const LONGEST_NAME: usize = 253;

impl fmt::Display for Host {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Address(IpAddr::V6(address)) => write!(f, "[{address}]"),
            Self::Address(IpAddr::V4(address)) => address.fmt(f),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for Interface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Address(address) => address.fmt(f),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for UdpAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "mxtp://{}:{}", self.host, self.port)?;
        if let Some(interface) = &self.interface {
            write!(f, "?interface={interface}")?;
        }
        if let Some(ttl) = self.ttl {
            let mark = if self.interface.is_some() { '&' } else { '?' };
            write!(f, "{mark}ttl={ttl}")?;
        }
        Ok(())
    }
}

impl fmt::Display for TcpAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "mxtp+tcp://{}:{}", self.host, self.port)?;
        match self.mode {
            None => Ok(()),
            Some(TcpMode::Listen) => f.write_str("?mode=listen"),
            Some(TcpMode::Connect) => f.write_str("?mode=connect"),
        }
    }
}
