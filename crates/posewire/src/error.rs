//! What can go wrong in the engine.

mod help;

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
    /// A recording of samples without a datagram, as that of the walker, where datagrams are needed.
    #[error("{}: expected datagrams, found poses alone", path.display())]
    PosesAlone {
        /// The file.
        path: PathBuf,
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
    /// A target of a protocol of which a capture has nothing to send again.
    #[error("{}: expected {expected} for {endpoint}, found {}", path.display(), found.join(", "))]
    NothingForTarget {
        /// The file.
        path: PathBuf,
        /// The target.
        endpoint: String,
        /// What it takes.
        expected: &'static str,
        /// The sources that there are, each its number and endpoint.
        found: Vec<String>,
    },
    /// A part of a capture in which nothing came.
    #[error("{}: expected datagrams in that time, found none: it lasts {:.3} s", path.display(), lasts.as_secs_f64())]
    NothingInTime {
        /// The file.
        path: PathBuf,
        /// From its first datagram to its last.
        lasts: Duration,
    },
    /// A recording that was split, of which a file is not there.
    #[error("{}: part {part} of the recording is missing, expected before {}", path.display(), next.display())]
    MissingPart {
        /// The first file.
        path: PathBuf,
        /// Which part is missing, from 1.
        part: u32,
        /// The file that comes after it.
        next: PathBuf,
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
    /// A section that was asked for, a take lacks, and its poses do not tell.
    #[error("the take has no {wanted}: it has {}", if found.is_empty() { "nothing".to_owned() } else { found.join(", ") })]
    NoSection {
        /// The section's name.
        wanted: &'static str,
        /// Those that it has.
        found: Vec<&'static str>,
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
    /// A file that would be replaced by what is made of it.
    #[error("{} would be written over itself", path.display())]
    OntoItself {
        /// The file.
        path: PathBuf,
    },
    /// A file that was to be replaced while somebody records into it.
    #[error("{} is being recorded", path.display())]
    BeingRecorded {
        /// The file.
        path: PathBuf,
    },
    /// A file that somebody removed or replaced while it was recorded, with what was in it.
    #[error("{} was removed or replaced while it was recorded", path.display())]
    Removed {
        /// The file.
        path: PathBuf,
    },
    /// A recording that was to be called as a file of another format.
    #[error("record writes MCAP files, {} says {ending}", path.display())]
    NotAsRecorded {
        /// The file.
        path: PathBuf,
        /// How the files of the other format end.
        ending: &'static str,
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
    /// A recording that has damage in it, where it was to be replaced by what comes before that.
    #[error("{path} is damaged, and what follows the damage would be lost: {problem}")]
    DamagedWithin {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
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
    /// A take that is to begin while another is recorded.
    #[error("{} is being recorded", file.display())]
    TakeRuns {
        /// The file of the take that is recorded.
        file: PathBuf,
    },
    /// More targets than a stream can have.
    #[error("expected at most {limit} targets")]
    TooManyTargets {
        /// How many it can have.
        limit: usize,
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
                | Self::NothingForTarget { .. }
                | Self::NothingInTime { .. }
                | Self::CaptureRate { .. }
                | Self::Faults { .. }
                | Self::Format { .. }
                | Self::WriteOnly { .. }
                | Self::Fixed { .. }
                | Self::Exists { .. }
                | Self::OntoItself { .. }
                | Self::NotAsRecorded { .. }
                | Self::NoSamples { .. }
                | Self::NoSection { .. }
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

/// "a", "a or b", "a, b or c".
fn listed(words: &[&str]) -> String {
    match words {
        [] => "none".into(),
        [only] => (*only).into(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
