//! A NatNet server as an endpoint spells it.

use std::fmt;
use std::net::Ipv4Addr;

use posewire_motion::Up;
use posewire_natnet::Version;
use posewire_natnet::client::Mode;
use posewire_natnet::motion::{Coordinates, Settings};
use posewire_natnet::server::Delivery;

use super::address::{Host, Interface, parse_interface, parse_place};
use super::url::Url;
use crate::Result;

/// Where a NatNet server is, or is to be, and what no packet of it tells: `natnet://HOST[:1510][?mode=..&version=..]`.
///
/// ```
/// use posewire::endpoint::{Endpoint, NatNetAddress};
/// use posewire_natnet::client::Mode;
///
/// let Endpoint::NatNet(motive) = "natnet://10.0.0.5?mode=multicast&version=3.1&up=z".parse()? else { panic!() };
/// assert_eq!((motive.mode, motive.port, motive.data_port), (Mode::Multicast, 1510, 1511));
/// assert_eq!(motive.group, NatNetAddress::GROUP);
/// # Ok::<(), posewire::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct NatNetAddress {
    /// The server that a source connects to; 0.0.0.0 or 255.255.255.255 is the one that answers a broadcast. The address
    /// that a sink serves at.
    pub host: Host,
    /// The server's command port: 1510 unless set. 0 lets the system choose one for a sink.
    pub port: u16,
    /// How frames travel: to each client, which is the default, or to a group.
    pub mode: Mode,
    /// The bitstream that a source asks for and a sink sends at most; if absent, the server's own.
    pub version: Option<Version>,
    /// The port that frames are sent to in a group, and from to a single client: 1511 unless set. 0 lets the system choose
    /// one for a sink.
    pub data_port: u16,
    /// The group that frames go to when they are multicast; 255.255.255.255 for a broadcast.
    pub group: Ipv4Addr,
    /// The interface that the group is joined on, commands leave by and frames are sent from; the one that the route
    /// leads to if absent.
    pub interface: Option<Interface>,
    /// Which axis of the server's points up: Y unless set.
    pub up: Up,
    /// What the server's bones are relative to: the world unless set.
    pub skeleton: Coordinates,
    /// Whether a sink also sends each frame to the data port of a client's host, where some clients listen only.
    pub copy: bool,
}

impl NatNetAddress {
    /// The command port that Motive has unless told otherwise.
    pub const COMMAND_PORT: u16 = 1510;
    /// The data port that Motive has unless told otherwise.
    pub const DATA_PORT: u16 = 1511;
    /// The group that Motive sends to unless told otherwise.
    pub const GROUP: Ipv4Addr = Delivery::MOTIVE_GROUP;

    /// The server at `host` and `port`, all else as Motive has it, with frames sent to each client.
    pub fn new(host: Host, port: u16) -> Self {
        Self {
            host,
            port,
            mode: Mode::Unicast,
            version: None,
            data_port: Self::DATA_PORT,
            group: Self::GROUP,
            interface: None,
            up: Up::Y,
            skeleton: Coordinates::Global,
            copy: false,
        }
    }

    /// What positions and bones of the server mean.
    pub(crate) fn settings(&self) -> Settings {
        Settings {
            up: self.up,
            skeleton: self.skeleton,
            ..Settings::default()
        }
    }

    pub(super) fn parse(whole: &str, body: &str) -> Result<Self> {
        let url = Url::cut(whole, body, OPTIONS)?;
        let (host, port) = parse_place(&url, Self::COMMAND_PORT)?;
        if let Host::Address(address) = &host
            && address.is_multicast()
        {
            return Err(url.mistake("server", "the address of one host", &host.to_string()));
        }
        let data_port = url.parsed("data-port", "a number from 0 to 65535", |_| true)?;
        let group = url.parsed("group", "an IPv4 group from 224.0.0.0, or 255.255.255.255", |group| {
            is_group(*group)
        })?;
        let copy = url.parsed("copy", "true or false", |_| true)?;
        let mode = choice(&url, "mode", "unicast or multicast", &MODES)?.unwrap_or(Mode::Unicast);
        match mode {
            Mode::Unicast if group.is_some_and(|group| group != Self::GROUP) => {
                return Err(url.mistake("mode of a group", "multicast", word(&mode, &MODES)));
            }
            Mode::Multicast if copy == Some(true) => {
                return Err(url.mistake("mode of copies", "unicast", word(&mode, &MODES)));
            }
            _ => {}
        }
        Ok(Self {
            mode,
            version: url.parsed("version", "a number from 1.4 to 4.5", |version: &Version| {
                version.is_known()
            })?,
            data_port: data_port.unwrap_or(Self::DATA_PORT),
            group: group.unwrap_or(Self::GROUP),
            interface: parse_interface(&url)?,
            up: choice(&url, "up", "y or z", &UPS)?.unwrap_or(Up::Y),
            skeleton: choice(&url, "skeleton", "global or local", &COORDINATES)?.unwrap_or(Coordinates::Global),
            copy: copy.unwrap_or_default(),
            ..Self::new(host, port)
        })
    }
}

impl fmt::Display for NatNetAddress {
    /// With the mode, and all else that is not as Motive has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let usual = Self::new(self.host.clone(), self.port);
        let mode = word(&self.mode, &MODES);
        write!(f, "natnet://{}:{}?mode={mode}", self.host, self.port)?;
        if let Some(version) = self.version {
            write!(f, "&version={version}")?;
        }
        if self.data_port != usual.data_port {
            write!(f, "&data-port={}", self.data_port)?;
        }
        if self.group != usual.group {
            write!(f, "&group={}", self.group)?;
        }
        if let Some(interface) = &self.interface {
            write!(f, "&interface={interface}")?;
        }
        if self.up != usual.up {
            write!(f, "&up={}", word(&self.up, &UPS))?;
        }
        if self.skeleton != usual.skeleton {
            write!(f, "&skeleton={}", word(&self.skeleton, &COORDINATES))?;
        }
        if self.copy {
            f.write_str("&copy=true")?;
        }
        Ok(())
    }
}

/// The value of an option that has a few words, which people write as Motive does or in small letters.
fn choice<T: Copy>(url: &Url<'_>, key: &'static str, expected: &'static str, words: &[(&str, T)]) -> Result<Option<T>> {
    let Some(text) = url.option(key) else {
        return Ok(None);
    };
    match words.iter().find(|(word, _)| word.eq_ignore_ascii_case(text)) {
        Some((_, value)) => Ok(Some(*value)),
        None => Err(url.mistake(key, expected, text)),
    }
}

fn word<T: PartialEq>(value: &T, words: &[(&'static str, T)]) -> &'static str {
    let found = words.iter().find(|(_, known)| known == value);
    found.map_or("", |(word, _)| word)
}

fn is_group(address: Ipv4Addr) -> bool {
    address.is_multicast() || address.is_broadcast()
}

const OPTIONS: &[&str] = &[
    "mode",
    "version",
    "data-port",
    "group",
    "interface",
    "up",
    "skeleton",
    "copy",
];
const MODES: [(&str, Mode); 2] = [("unicast", Mode::Unicast), ("multicast", Mode::Multicast)];
const UPS: [(&str, Up); 2] = [("y", Up::Y), ("z", Up::Z)];
const COORDINATES: [(&str, Coordinates); 2] = [("global", Coordinates::Global), ("local", Coordinates::Local)];
