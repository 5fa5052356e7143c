//! What can go wrong in the engine, and what to do about it.

use crate::endpoint::FileFormat;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A result whose error is the engine's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// What went wrong: each variant says where, what was expected and what was found.
///
/// [`Error::help`] adds what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A part of an endpoint URL is not what it must be.
    #[error("{url}: expected {expected} as the {part}, found {found:?}")]
    Url {
        /// The whole endpoint as given.
        url: String,
        /// The part at fault: "port", "host", the name of an option ...
        part: &'static str,
        /// What that part must be.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// An endpoint URL has an option that its scheme does not know.
    #[error("{url}: unknown option {found:?}, expected {}", listed(known))]
    UnknownOption {
        /// The whole endpoint as given.
        url: String,
        /// The unknown key.
        found: String,
        /// The keys that the scheme knows.
        known: &'static [&'static str],
    },
    /// An endpoint URL names a scheme that does not exist here.
    #[error("{url}: unknown scheme {found:?}, expected {}", listed(known))]
    UnknownScheme {
        /// The whole endpoint as given.
        url: String,
        /// The scheme found.
        found: String,
        /// The schemes that exist.
        known: &'static [&'static str],
    },
    /// A scheme or file format that is planned but not there yet.
    #[error("{endpoint}: {what} is not supported yet")]
    NotSupportedYet {
        /// The whole endpoint as given.
        endpoint: String,
        /// The scheme or format.
        what: &'static str,
    },
    /// A file in MVN's own closed format.
    #[error("{path}: the .mvn format is proprietary: export MVNX from MVN")]
    Proprietary {
        /// The file as given.
        path: String,
    },
    /// A path whose ending names no known format.
    #[error("{path}: expected a file that ends in {}, or a URL", listed(known))]
    UnknownFormat {
        /// The path as given.
        path: String,
        /// The known endings.
        known: &'static [&'static str],
    },
    /// A host name that leads to no address.
    #[error("cannot find the address of host {host:?}: {reason}")]
    Resolve {
        /// The host name.
        host: String,
        /// What the system's resolver says.
        reason: String,
    },
    /// Several servers where one was to be found.
    #[error("expected one NatNet server, found {}: {}", found.len(), found.join(", "))]
    SeveralServers {
        /// Each of them, as `Motive at 10.0.0.5:1510`.
        found: Vec<String>,
    },
    /// A second source for a sink that can send one alone.
    #[error("expected one source to stream, found several, whose subjects would share their numbers")]
    SeveralSources,
    /// A network interface that is not there, or lacks an address of the needed kind.
    #[error("network interface {name:?} {problem}")]
    Interface {
        /// The interface's name or address as given.
        name: String,
        /// What it lacks.
        problem: &'static str,
        /// The interfaces that are there, each with its addresses.
        available: Vec<String>,
    },
    /// The operating system refused an action on a socket.
    #[error("cannot {action} {address}: {reason}")]
    Socket {
        /// What was tried: "listen on", "connect to", "send to" ...
        action: &'static str,
        /// The address, as `transport HOST:PORT`.
        address: String,
        /// The kind of failure.
        kind: io::ErrorKind,
        /// What the system says.
        reason: String,
    },
    /// A peer took no more data within the limit.
    #[error("{peer} took {written} of {length} bytes within {limit:?}")]
    Stalled {
        /// The peer's address.
        peer: String,
        /// How many bytes it took.
        written: usize,
        /// How many bytes there were.
        length: usize,
        /// The time it had.
        limit: Duration,
    },
    /// A file that cannot be opened or read.
    #[error("cannot read {path}: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The kind of failure.
        kind: io::ErrorKind,
        /// What the system says.
        reason: String,
    },
    /// A file that is not the take that its name says.
    #[error("{path}: {error}")]
    Take {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and where.
        error: posewire_mvnx::Error,
        /// How many whole frames stand before that.
        frames: u64,
    },
    /// A file that is no capture of datagrams.
    #[error("{path}: expected a pcap, pcapng or MCAP file, found \"{}\"", found.escape_ascii())]
    NotACapture {
        /// The file.
        path: PathBuf,
        /// Its first bytes.
        found: Vec<u8>,
    },
    /// A capture without a single datagram that posewire speaks.
    #[error("{path}: expected MXTP or NatNet, found {found}")]
    NoDatagrams {
        /// The file.
        path: PathBuf,
        /// What there is instead.
        found: String,
    },
    /// A capture in which not one source is meant, but none or several.
    #[error("{path}: expected one source{}, found {}", wanted.as_ref().map_or(String::new(), |wanted| format!(" {wanted:?}")), found.join(", "))]
    CapturedSources {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        wanted: Option<String>,
        /// The sources that there are, each its number and endpoint.
        found: Vec<String>,
    },
    /// A stream rate for a capture, whose datagrams come when they came.
    #[error("expected no rate for a capture, found {found}")]
    CaptureRate {
        /// The rate as given.
        found: String,
    },
    /// A datagram that no IP packet has room for.
    #[error("expected at most 65507 bytes in a datagram, found {found}")]
    TooLongForIp {
        /// How many bytes it has.
        found: usize,
    },
    /// A take without a single frame.
    #[error("{path}: expected frames, found none")]
    NoFrames {
        /// The file.
        path: String,
    },
    /// A stream rate that the captured samples cannot give.
    #[error("expected a rate above 0 and at most {captured} Hz, which is what was captured, found {found}")]
    Rate {
        /// Samples a second that there are.
        captured: String,
        /// The rate as given.
        found: String,
    },
    /// An endpoint that motion cannot be sent to.
    #[error(
        "{endpoint}: motion cannot be sent there, expected mxtp://HOST:PORT, mxtp+tcp://HOST:PORT or natnet://HOST"
    )]
    NotATarget {
        /// The endpoint.
        endpoint: String,
    },
    /// More subjects than a NatNet server can describe.
    #[error("the descriptions of {subjects} subjects do not fit into one NatNet datagram: {error}")]
    Descriptions {
        /// How many subjects there are.
        subjects: usize,
        /// How large their descriptions are.
        error: posewire_natnet::Error,
    },
    /// More subjects than character numbers.
    #[error("expected a character number from 0 to 255, found {found}")]
    Character {
        /// The number that a subject would have.
        found: u32,
    },
    /// A sink that could not write what it was given.
    #[error("cannot write to {place}: {reason}")]
    Write {
        /// Where to.
        place: String,
        /// The kind of failure.
        kind: io::ErrorKind,
        /// What the system says.
        reason: String,
    },
    /// A word that names no file format.
    #[error("unknown format {found:?}, expected {}", formats())]
    Format {
        /// The word as given.
        found: String,
    },
    /// A file of a format that takes are written in and not read from.
    #[error("{path}: {format} can be written, not read")]
    WriteOnly {
        /// The file.
        path: String,
        /// The format's name.
        format: &'static str,
    },
    /// Axes or a unit that a format cannot have.
    #[error("{format}: expected {expected} as the {what}, which the format fixes, found {found}")]
    Fixed {
        /// The format's name.
        format: &'static str,
        /// "axes" or "unit".
        what: &'static str,
        /// What the format has.
        expected: String,
        /// What was asked for.
        found: String,
    },
    /// A take that has nothing of what a format holds, or of which none of that was asked for.
    #[error("{format} holds {what}, and there are none to write")]
    Lacks {
        /// The format's name.
        format: &'static str,
        /// What it holds.
        what: &'static str,
    },
    /// Sample numbers of which a take has none.
    #[error("expected samples {}, found those from {first} to {last}", numbers(*from, *to))]
    NoSamples {
        /// The first number asked for.
        from: u32,
        /// The last number asked for.
        to: u32,
        /// The first number there is.
        first: u32,
        /// The last number there is.
        last: u32,
    },
    /// A rate that a take cannot be given.
    #[error(
        "expected a rate from 0.001 Hz, below 1,000,000 Hz and at most 1,000 times the {captured} Hz of the take, found {found}"
    )]
    NewRate {
        /// Samples a second that there are.
        captured: String,
        /// The rate as given.
        found: String,
    },
    /// A file that is there already.
    #[error("{} is there already", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A file that is no MCAP file.
    #[error("{path} is not an MCAP file")]
    NotMcap {
        /// The file.
        path: PathBuf,
    },
    /// A recording whose chunks somebody has compressed.
    #[error("the chunks of {path} are compressed")]
    Compressed {
        /// The file.
        path: PathBuf,
    },
    /// Work that was stopped before its end.
    #[error("stopped while {what}")]
    Stopped {
        /// What was being done.
        what: String,
    },
    /// Something that this program was built without.
    #[error("{what} is not in this build of posewire")]
    Feature {
        /// What is missing.
        what: &'static str,
        /// The feature of Cargo that brings it.
        feature: &'static str,
    },
    /// A playback speed that no clock can run at.
    #[error("expected a finite playback speed above 0, found {found}")]
    Speed {
        /// The speed as given.
        found: String,
    },
    /// A plan of faults that is none.
    #[error("faults: expected {expected} at character {offset}, found {found:?}")]
    Faults {
        /// Where in the text, in bytes from 0.
        offset: usize,
        /// What must stand there.
        expected: &'static str,
        /// What does.
        found: String,
    },
}

impl Error {
    /// What to do about the error, as one sentence without a full stop, where there is something
    /// to do.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Url { part, .. } => Some(url_help(part)),
            Self::UnknownOption { known: [], .. } => Some("remove the part after the ?".into()),
            Self::UnknownOption { known, .. } => Some(format!("use {}", listed(known))),
            Self::UnknownScheme { known, .. } => Some(format!("use {}, or the path of a file", listed(known))),
            Self::NotSupportedYet { .. } => {
                Some("use mxtp://, mxtp+tcp://, natnet://, synthetic:walk or an .mvnx file".into())
            }
            Self::Proprietary { .. } => Some("open the take in MVN, export it as MVNX and use the .mvnx file".into()),
            Self::UnknownFormat { path, .. } => Some(path_help(path)),
            Self::Resolve { host, .. } => Some(format!("check the spelling of {host:?}, or use the numeric address")),
            Self::SeveralServers { .. } => Some("name one of them, as in natnet://HOST:1510".into()),
            Self::SeveralSources => Some("stream each by itself, to targets of its own".into()),
            Self::Interface { available, .. } => Some(format!("this machine has: {}", available.join(", "))),
            Self::Socket {
                action, address, kind, ..
            } => socket_help(action, address, *kind),
            Self::Stalled { peer, .. } => Some(format!("check that the program at {peer} reads its connection")),
            Self::Read { kind, .. } => read_help(*kind),
            Self::Take { error, frames, .. } => Some(take_help(error, *frames).into()),
            Self::NotACapture { .. } => Some("record one: posewire record mxtp://0.0.0.0:9763 -o take.mcap".into()),
            Self::NoDatagrams { .. } => {
                Some("posewire explain FILE --protocol mxtp takes every datagram for MXTP".into())
            }
            Self::CapturedSources { .. } => Some("choose one by number or name, as in --only 0".into()),
            Self::CaptureRate { .. } => Some("leave --rate out; --speed plays it faster or slower".into()),
            Self::TooLongForIp { .. } => None,
            Self::NoFrames { .. } => Some("posewire inspect says what it holds; export it again from MVN".into()),
            Self::Rate { .. } => Some("leave --rate out to send every sample".into()),
            Self::NotATarget { .. } => {
                Some("give a network address, as in --to mxtp://127.0.0.1:9763; posewire convert writes files".into())
            }
            Self::Descriptions { .. } => Some("stream fewer people to NatNet".into()),
            Self::Character { .. } => Some("start at a lower --character, or stream fewer people".into()),
            Self::Write { kind, .. } => Some(write_help(*kind).into()),
            Self::Format { .. } => Some("name one of these, as in --format csv".into()),
            Self::WriteOnly { .. } => Some("give the .mvnx file that it was made from".into()),
            Self::Fixed { what, .. } => Some(format!(
                "leave the {what} out, or choose a format that is free in it, as CSV is"
            )),
            Self::Lacks { .. } => Some("posewire inspect says what the take holds".into()),
            Self::NoSamples { .. } => Some("posewire inspect says which samples a take has".into()),
            Self::NewRate { .. } => Some("leave the rate out to keep every sample".into()),
            Self::Exists { .. } => Some("choose another name, or replace it with --overwrite".into()),
            Self::Stopped { .. } => Some("nothing was left half written; start again when you like".into()),
            Self::Feature { feature, .. } => Some(format!("cargo install --path crates/cli --features {feature}")),
            Self::NotMcap { .. } => Some("give a file that posewire record has written".into()),
            Self::Compressed { .. } => {
                Some("mcap compress --compression none, a tool of mcap.dev, writes it anew".into())
            }
            Self::Speed { .. } => Some("1 is real time, 0.5 half as fast".into()),
            Self::Faults { .. } => Some("as in --faults loss=1%,reorder=0.5%,reset@10s,seed=7".into()),
        }
    }

    /// The failure to open or read a file.
    pub fn read(path: &Path, error: &io::Error) -> Self {
        Self::Read {
            path: path.to_owned(),
            kind: error.kind(),
            reason: reason(error),
        }
    }

    /// What is wrong with a take, behind so many whole frames.
    pub fn take(path: &Path, error: posewire_mvnx::Error, frames: u64) -> Self {
        Self::Take {
            path: path.to_owned(),
            error,
            frames,
        }
    }

    /// The failure to write to `place`.
    pub fn write(place: impl Into<String>, error: &io::Error) -> Self {
        Self::Write {
            place: place.into(),
            kind: error.kind(),
            reason: reason(error),
        }
    }

    /// Whether the arguments that led here were wrong, rather than what they led to.
    pub fn is_usage(&self) -> bool {
        matches!(
            self,
            Self::Url { .. }
                | Self::UnknownOption { .. }
                | Self::UnknownScheme { .. }
                | Self::NotSupportedYet { .. }
                | Self::Proprietary { .. }
                | Self::UnknownFormat { .. }
                | Self::Rate { .. }
                | Self::NotATarget { .. }
                | Self::Character { .. }
                | Self::Speed { .. }
                | Self::CapturedSources { .. }
                | Self::CaptureRate { .. }
                | Self::Faults { .. }
                | Self::Format { .. }
                | Self::WriteOnly { .. }
                | Self::Fixed { .. }
                | Self::Exists { .. }
                | Self::NoSamples { .. }
                | Self::NewRate { .. }
                | Self::Feature { .. }
        )
    }

    /// What a NatNet server's command port is bound for.
    pub(crate) const SERVE_COMMANDS: &str = "serve NatNet commands on";
    /// What a NatNet server's data port is bound for.
    pub(crate) const SERVE_FRAMES: &str = "send NatNet frames from";

    /// The refusal of `action` ("listen on", "send to" ...) on `address` by the system.
    pub(crate) fn socket(action: &'static str, address: String, error: &io::Error) -> Self {
        Self::Socket {
            action,
            address,
            kind: error.kind(),
            reason: reason(error),
        }
    }
}

/// The system's words without the "(os error 98)" that says nothing to a reader.
pub(crate) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let end = text.find(" (os error").unwrap_or(text.len());
    text[..end].to_lowercase()
}

fn formats() -> String {
    let endings: Vec<_> = FileFormat::ALL.iter().map(|format| format.ending()).collect();
    listed(&endings)
}

/// "from 3 to 5", "from 3 on".
fn numbers(from: u32, to: u32) -> String {
    match (from, to) {
        (from, u32::MAX) => format!("from {from} on"),
        (from, to) => format!("from {from} to {to}"),
    }
}

fn url_help(part: &str) -> String {
    match part {
        "host" | "port" | "address" => "write HOST, HOST:PORT or [IPV6]:PORT, as in mxtp://127.0.0.1:9763".into(),
        "server" => "name the server, with the group behind it: natnet://SERVER?mode=multicast&group=GROUP".into(),
        "interface" => "name it as the system does, as in interface=eth0, or by address".into(),
        "generator" => "write synthetic:walk, as in synthetic:walk?people=2&rate=240".into(),
        "scheme" => "write mxtp://HOST:PORT, mxtp+tcp://HOST:PORT or synthetic:walk".into(),
        "mode of a group" => "add mode=multicast, or leave group out".into(),
        "mode of copies" => "leave copy out: everybody in a group gets its frames".into(),
        "copy of a source" => "leave copy out, which is for servers, behind --to".into(),
        option => format!("correct {option}, or leave it out for its default"),
    }
}

/// An address without a scheme is the likely mistake when a "path" looks like one.
fn path_help(path: &str) -> String {
    let looks_like_address = path
        .rsplit_once(':')
        .is_some_and(|(_, port)| port.parse::<u16>().is_ok())
        || path.parse::<std::net::IpAddr>().is_ok();
    if looks_like_address {
        format!("for a network address write mxtp://{path}")
    } else {
        "give an .mvnx file, mxtp://HOST:PORT, or synthetic:walk".into()
    }
}

fn write_help(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "ask for the right to write there, or write elsewhere"
        }
        io::ErrorKind::NotFound => "make the folder first, or write elsewhere",
        io::ErrorKind::IsADirectory | io::ErrorKind::InvalidInput => "name a file",
        io::ErrorKind::InvalidFilename => "choose a shorter name",
        _ => "make room there, or send the output elsewhere",
    }
}

fn take_help(error: &posewire_mvnx::Error, frames: u64) -> &'static str {
    use posewire_mvnx::Error;
    match error {
        Error::Binary { .. } => "open the take in MVN, export it as MVNX and use the .mvnx file",
        Error::Empty | Error::NotMvnx { .. } => "give a take that was exported from MVN as MVNX",
        Error::Version { .. } => "open the take in a current MVN and export it again as MVNX",
        _ if frames > 0 => "--salvage uses the frames before the damage; exporting again from MVN may mend it",
        Error::Io { .. } | Error::Truncated { .. } => {
            "export the take again from MVN: there is no whole frame before the damage"
        }
        _ => "export the take again from MVN, or mend the file at that place",
    }
}

fn read_help(kind: io::ErrorKind) -> Option<String> {
    match kind {
        io::ErrorKind::NotFound => Some("check the path; a name with spaces needs quotes".into()),
        io::ErrorKind::PermissionDenied => Some("ask for the right to read it".into()),
        io::ErrorKind::IsADirectory => Some("name a file in this folder".into()),
        _ => None,
    }
}

fn socket_help(action: &str, address: &str, kind: io::ErrorKind) -> Option<String> {
    let place = address.split_once(' ').map_or(address, |(_, place)| place);
    let text = match kind {
        io::ErrorKind::AddrInUse if action == Error::SERVE_COMMANDS => {
            format!(
                "another program, such as Motive, has {place}: stop it, or choose other ports as in \
                 natnet://HOST:1520?data-port=1521"
            )
        }
        io::ErrorKind::AddrInUse if action == Error::SERVE_FRAMES => {
            format!(
                "another program has {place}: stop it, or choose other ports as in natnet://HOST:1520?data-port=1521"
            )
        }
        io::ErrorKind::InvalidInput if place.ends_with(":0") => {
            "name the port, as Motive's 1510 or MVN's 9763, or leave it out for that".into()
        }
        io::ErrorKind::AddrInUse => {
            format!("another program listens on {place}: stop it or choose another port")
        }
        io::ErrorKind::AddrNotAvailable => {
            format!("{place} is not an address of this machine: use one of its own, or 0.0.0.0 for all")
        }
        io::ErrorKind::PermissionDenied => {
            "ports below 1024 and some interfaces need privileges: use another port, or check the \
             firewall"
                .into()
        }
        io::ErrorKind::NetworkUnreachable | io::ErrorKind::HostUnreachable => {
            format!("no route leads to {place}: check the cable, the address and the network mask")
        }
        io::ErrorKind::ConnectionRefused => {
            format!("nothing listens on {place}: start the receiving program first, or check the port")
        }
        io::ErrorKind::TimedOut => {
            format!("{place} does not answer: check the address, and that no firewall is in the way")
        }
        _ => return None,
    };
    Some(text)
}

/// "a", "a or b", "a, b or c".
fn listed(words: &[&str]) -> String {
    match words {
        [] => "none".into(),
        [only] => (*only).into(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_in_use_names_the_address_and_the_way_out() {
        let refusal = io::Error::from_raw_os_error(98);
        let error = Error::Socket {
            action: "listen on",
            address: "udp 127.0.0.1:9763".into(),
            kind: io::ErrorKind::AddrInUse,
            reason: reason(&refusal),
        };
        assert!(error.to_string().starts_with("cannot listen on udp 127.0.0.1:9763: "));
        assert!(!error.to_string().contains("os error"));
        assert_eq!(
            error.help().as_deref(),
            Some("another program listens on 127.0.0.1:9763: stop it or choose another port")
        );
    }

    #[test]
    fn a_taken_port_of_motive_is_answered_with_two_others() {
        for action in [Error::SERVE_COMMANDS, Error::SERVE_FRAMES] {
            let help = socket_help(action, "udp 0.0.0.0:1510", io::ErrorKind::AddrInUse).unwrap();
            assert!(help.ends_with("natnet://HOST:1520?data-port=1521"), "{help}");
        }
        let help = socket_help("connect to", "udp 10.0.0.7:0", io::ErrorKind::InvalidInput);
        assert!(help.is_some_and(|help| help.starts_with("name the port")));
    }

    #[test]
    fn an_address_given_as_a_path_is_offered_as_a_url() {
        let error = Error::UnknownFormat {
            path: "192.168.1.5:9763".into(),
            known: &[".mvnx"],
        };
        assert_eq!(
            error.help().as_deref(),
            Some("for a network address write mxtp://192.168.1.5:9763")
        );
    }
}
