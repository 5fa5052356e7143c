//! Where motion comes from and goes to, as a URL or a path.
//!
//! ```text
//! mxtp://HOST[:9763][?interface=NAME-or-ADDR&ttl=N]                MXTP over UDP
//! mxtp+tcp://HOST[:9763][?mode=listen|connect]                     MXTP over TCP
//! natnet://HOST[:1510][?mode=unicast|multicast&version=M.m         NatNet: the server's host
//!     &data-port=1511&group=239.255.42.99&interface=NAME-or-ADDR
//!     &up=y|z&skeleton=global|local&copy=false]
//! synthetic:walk[?people=1&rate=240&props=0&fingers=false]         the built-in walker
//! PATH                                                             .mvnx, .mvnx.gz, .mcap, .pcap, .pcapng
//! ```
//!
//! Parsing touches neither the network nor the disk: host names are looked up when a socket is
//! opened, paths when a file is.

mod address;
mod file;
mod natnet;
mod url;
mod walk;

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use crate::{Error, Result};

pub use address::{DEFAULT_PORT, Host, Interface, TcpAddress, TcpMode, UdpAddress};
pub use file::FileFormat;
pub use natnet::NatNetAddress;
pub use walk::Walk;

/// A place that motion comes from or goes to.
///
/// `Display` gives the canonical text, with the defaults that matter spelled out; parsing that text
/// gives an equal endpoint.
///
/// ```
/// use posewire::endpoint::{Endpoint, FileFormat};
///
/// let take: Endpoint = "takes/walk.mvnx.gz".parse()?;
/// assert!(matches!(take, Endpoint::File { format: FileFormat::MvnxGz, .. }));
/// # Ok::<(), posewire::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Endpoint {
    /// MXTP datagrams over UDP: the address to bind as a source, to send to as a sink.
    MxtpUdp(UdpAddress),
    /// MXTP as a byte stream over TCP.
    MxtpTcp(TcpAddress),
    /// A NatNet server: the one to connect to as a source, to be as a sink.
    NatNet(NatNetAddress),
    /// The built-in procedural walker. Only a source.
    Synthetic(Walk),
    /// A file of datagrams as they were captured: `.mcap`, `.pcap` or `.pcapng`; which of them, its content tells.
    Capture {
        /// Where the file is.
        path: PathBuf,
    },
    /// A file of a take, its format told by its name.
    File {
        /// Where the file is.
        path: PathBuf,
        /// What the name's ending says it holds.
        format: FileFormat,
    },
}

impl FromStr for Endpoint {
    type Err = Error;

    /// # Errors
    /// [`Error::Url`] and [`Error::UnknownOption`] for a malformed URL, [`Error::UnknownScheme`],
    /// [`Error::NotSupportedYet`] for a planned scheme or format, [`Error::Proprietary`] for a
    /// `.mvn` file and [`Error::UnknownFormat`] for any other path.
    fn from_str(text: &str) -> Result<Self> {
        match split_scheme(text) {
            Some((scheme, body)) => parse_url(text, scheme, body),
            None if file::names_a_capture(text) => Ok(Self::Capture { path: text.into() }),
            None => Ok(Self::File {
                path: PathBuf::from(text),
                format: FileFormat::of(text)?,
            }),
        }
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MxtpUdp(address) => address.fmt(f),
            Self::MxtpTcp(address) => address.fmt(f),
            Self::NatNet(address) => address.fmt(f),
            Self::Synthetic(walk) => walk.fmt(f),
            Self::Capture { path } | Self::File { path, .. } => path.display().fmt(f),
        }
    }
}

/// Splits `scheme:body` if the scheme is one of ours or a `//` follows; a drive letter or a colon
/// in a file's name is no scheme.
fn split_scheme(text: &str) -> Option<(&str, &str)> {
    let (scheme, body) = text.split_once(':').unwrap_or((text, ""));
    let named = KNOWN.contains(&scheme) || PLANNED.iter().any(|(planned, _)| *planned == scheme);
    let spelled = scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    (named || spelled && body.starts_with("//")).then_some((scheme, body))
}

fn parse_url(text: &str, scheme: &str, body: &str) -> Result<Endpoint> {
    if let Some((_, what)) = PLANNED.iter().find(|(planned, _)| *planned == scheme) {
        return Err(Error::NotSupportedYet {
            endpoint: text.into(),
            what,
        });
    }
    match scheme {
        "mxtp" => UdpAddress::parse(text, body).map(Endpoint::MxtpUdp),
        "mxtp+tcp" => TcpAddress::parse(text, body).map(Endpoint::MxtpTcp),
        "natnet" => NatNetAddress::parse(text, body).map(Endpoint::NatNet),
        "synthetic" => Walk::parse(text, body).map(Endpoint::Synthetic),
        _ => Err(Error::UnknownScheme {
            url: text.into(),
            found: scheme.into(),
            known: KNOWN,
        }),
    }
}

const KNOWN: &[&str] = &["mxtp", "mxtp+tcp", "natnet", "synthetic"];
const PLANNED: &[(&str, &str)] = &[("xtlp", "XTLP")];

#[cfg(test)]
mod tests {
    use posewire_motion::Up;
    use posewire_natnet::Version;
    use posewire_natnet::client::Mode;
    use posewire_natnet::motion::Coordinates;
    use proptest::prelude::*;

    use super::*;

    fn parse(text: &str) -> Result<Endpoint> {
        text.parse()
    }

    #[test]
    fn the_canonical_text_spells_the_defaults_out() {
        for (given, canonical) in [
            ("mxtp://127.0.0.1", "mxtp://127.0.0.1:9763"),
            ("mxtp://[::1]:5000/", "mxtp://[::1]:5000"),
            (
                "mxtp://239.1.2.3?ttl=4&interface=192.168.0.7",
                "mxtp://239.1.2.3:9763?interface=192.168.0.7&ttl=4",
            ),
            (
                "mxtp://[ff02::1]:9763?interface=eth0",
                "mxtp://[ff02::1]:9763?interface=eth0",
            ),
            ("mxtp+tcp://studio-pc.local", "mxtp+tcp://studio-pc.local:9763"),
            (
                "mxtp+tcp://0.0.0.0:7000?mode=listen",
                "mxtp+tcp://0.0.0.0:7000?mode=listen",
            ),
            ("natnet://motive-pc", "natnet://motive-pc:1510?mode=unicast"),
            (
                "natnet://10.0.0.5:1600?skeleton=local&up=z&interface=eth0&group=239.1.1.1&data-port=0\
                 &version=3.1&mode=multicast",
                "natnet://10.0.0.5:1600?mode=multicast&version=3.1&data-port=0&group=239.1.1.1&interface=eth0&up=z\
                 &skeleton=local",
            ),
            ("natnet://h?up=Z&mode=Multicast", "natnet://h:1510?mode=multicast&up=z"),
            ("natnet://h?copy=true", "natnet://h:1510?mode=unicast&copy=true"),
            (
                "natnet://[::1]?data-port=1511&group=239.255.42.99&up=y&skeleton=global&copy=false",
                "natnet://[::1]:1510?mode=unicast",
            ),
            (
                "synthetic:walk",
                "synthetic:walk?people=1&rate=240&props=0&fingers=false",
            ),
            (
                "synthetic:walk?people=2&rate=59.94&props=1&fingers=true",
                "synthetic:walk?people=2&rate=59.94&props=1&fingers=true",
            ),
            ("a:b.mvnx", "a:b.mvnx"),
            ("C:\\takes\\walk.MVNX", "C:\\takes\\walk.MVNX"),
        ] {
            assert_eq!(parse(given).unwrap().to_string(), canonical, "{given}");
        }
    }

    #[test]
    fn a_mistake_is_named_with_its_place() {
        for (given, message) in [
            (
                "mxtp://localhost:99999",
                "mxtp://localhost:99999: expected a number from 0 to 65535 as the port, found \"99999\"",
            ),
            (
                "mxtp://",
                "mxtp://: expected a name or an address as the host, found \"\"",
            ),
            (
                "mxtp:9763",
                "mxtp:9763: expected // after the scheme as the address, found \"9763\"",
            ),
            (
                "mxtp://fe80::1:9763",
                "mxtp://fe80::1:9763: expected an IPv6 address in brackets as the host, found \"fe80::1:9763\"",
            ),
            (
                "mxtp://256.0.0.1",
                "mxtp://256.0.0.1: expected four numbers from 0 to 255 as the host, found \"256.0.0.1\"",
            ),
            (
                "mxtp+tcp://h?mode=serve",
                "mxtp+tcp://h?mode=serve: expected listen or connect as the mode, found \"serve\"",
            ),
            (
                "mxtp+tcp://h?interface=lo",
                "mxtp+tcp://h?interface=lo: unknown option \"interface\", expected mode",
            ),
            (
                "mxtp://h?ttl=1&ttl=2",
                "mxtp://h?ttl=1&ttl=2: expected only one as the ttl, found \"2\"",
            ),
            (
                "synthetic:walk?people=65",
                "synthetic:walk?people=65: expected a number from 1 to 64 as the people, found \"65\"",
            ),
            (
                "synthetic:run",
                "synthetic:run: expected walk as the generator, found \"run\"",
            ),
            (
                "http://h",
                "http://h: unknown scheme \"http\", expected mxtp, mxtp+tcp, natnet or synthetic",
            ),
            ("xtlp://h", "xtlp://h: XTLP is not supported yet"),
            (
                "natnet://239.255.42.99",
                "natnet://239.255.42.99: expected the address of one host as the server, found \"239.255.42.99\"",
            ),
            (
                "natnet://h?group=10.0.0.1",
                "natnet://h?group=10.0.0.1: expected an IPv4 group from 224.0.0.0, or 255.255.255.255 as the group, \
                 found \"10.0.0.1\"",
            ),
            (
                "natnet://h?group=239.1.1.1",
                "natnet://h?group=239.1.1.1: expected multicast as the mode of a group, found \"unicast\"",
            ),
            (
                "natnet://h?mode=multicast&copy=true",
                "natnet://h?mode=multicast&copy=true: expected unicast as the mode of copies, found \"multicast\"",
            ),
            (
                "natnet://h?version=4.6",
                "natnet://h?version=4.6: expected a number from 1.4 to 4.5 as the version, found \"4.6\"",
            ),
            (
                "natnet://h?up=x",
                "natnet://h?up=x: expected y or z as the up, found \"x\"",
            ),
            (
                "natnet://h?ttl=1",
                "natnet://h?ttl=1: unknown option \"ttl\", expected mode, version, data-port, group, interface, up, \
                 skeleton or copy",
            ),
            (
                "take.mvn",
                "take.mvn: the .mvn format is proprietary: export MVNX from MVN",
            ),
            (
                "take.txt",
                "take.txt: expected a file that ends in .mvnx, .mvnx.gz, .mcap, .pcap or .pcapng, or a URL",
            ),
        ] {
            let error = parse(given).unwrap_err();
            assert_eq!(error.to_string(), message);
            assert!(error.help().is_some(), "{given} has no help");
        }
    }

    fn host() -> impl Strategy<Value = Host> {
        prop_oneof![
            any::<[u8; 4]>().prop_map(|octets| Host::Address(octets.into())),
            any::<[u8; 16]>().prop_map(|octets| Host::Address(octets.into())),
            "[a-z][a-z0-9-]{0,12}(\\.[a-z]{1,5}){0,3}".prop_map(Host::Name),
        ]
    }

    fn interface() -> impl Strategy<Value = Interface> {
        prop_oneof![
            any::<[u8; 4]>().prop_map(|octets| Interface::Address(octets.into())),
            any::<[u8; 16]>().prop_map(|octets| Interface::Address(octets.into())),
            "[a-z]{1,6}[0-9]{1,3}".prop_map(Interface::Name),
        ]
    }

    fn natnet() -> impl Strategy<Value = Endpoint> {
        let version = prop::sample::select(&Version::LAYOUTS[..]);
        let group = (224u8..240, any::<[u8; 3]>()).prop_map(|(first, [b, c, d])| [first, b, c, d].into());
        let place = (
            host().prop_filter(
                "a group",
                |host| !matches!(host, Host::Address(ip) if ip.is_multicast()),
            ),
            any::<[u16; 2]>(),
            proptest::option::of(interface()),
        );
        let settings = (proptest::option::of(version), group, any::<[bool; 4]>());
        (place, settings).prop_map(|((host, [port, data_port], interface), (version, group, bits))| {
            let [multicast, z, local, copy] = bits;
            Endpoint::NatNet(NatNetAddress {
                mode: if multicast { Mode::Multicast } else { Mode::Unicast },
                version,
                data_port,
                group: if multicast { group } else { NatNetAddress::GROUP },
                interface,
                up: if z { Up::Z } else { Up::Y },
                skeleton: if local { Coordinates::Local } else { Coordinates::Global },
                copy: copy && !multicast,
                ..NatNetAddress::new(host, port)
            })
        })
    }

    fn endpoint() -> impl Strategy<Value = Endpoint> {
        let udp = (
            host(),
            any::<u16>(),
            proptest::option::of(interface()),
            proptest::option::of(any::<u8>()),
        )
            .prop_map(|(host, port, interface, ttl)| {
                Endpoint::MxtpUdp(UdpAddress {
                    host,
                    port,
                    interface,
                    ttl,
                })
            });
        let mode = prop_oneof![Just(None), Just(Some(TcpMode::Listen)), Just(Some(TcpMode::Connect))];
        let tcp = (host(), any::<u16>(), mode)
            .prop_map(|(host, port, mode)| Endpoint::MxtpTcp(TcpAddress { host, port, mode }));
        let walk =
            (1u8..=64, 0.001f64..=10_000.0, 0u8..=4, any::<bool>()).prop_map(|(people, rate_hz, props, fingers)| {
                Endpoint::Synthetic(Walk {
                    people,
                    rate_hz,
                    props,
                    fingers,
                })
            });
        let file = "[a-zA-Z0-9_./ -]{1,30}".prop_map(|stem| Endpoint::File {
            path: format!("{stem}.mvnx").into(),
            format: FileFormat::Mvnx,
        });
        prop_oneof![udp, tcp, natnet(), walk, file]
    }

    proptest! {
        #[test]
        fn any_text_parses_or_says_why(text in ".{0,60}") {
            let _ = parse(&text).map_err(|error| (error.to_string(), error.help()));
        }

        #[test]
        fn any_url_parses_or_says_why(text in "(mxtp|mxtp\\+tcp|natnet|synthetic)(://|:walk|:)[\\[\\]a-z0-9.:?&=/%#@-]{0,40}") {
            if let Ok(endpoint) = parse(&text) {
                prop_assert_eq!(parse(&endpoint.to_string()), Ok(endpoint));
            }
        }

        #[test]
        fn the_canonical_text_parses_back_to_the_same(endpoint in endpoint()) {
            prop_assert_eq!(parse(&endpoint.to_string()), Ok(endpoint));
        }
    }
}
