//! What can go wrong with the viewer.

use std::net::SocketAddr;

/// A result whose error is the viewer's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// What went wrong: each variant says where, what was expected and what was found.
///
/// [`Error::help`] adds what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The page cannot be served at an address.
    #[error("cannot serve the page on {address}: {reason}")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// The kind of failure.
        kind: std::io::ErrorKind,
        /// What the system says.
        reason: String,
    },
    /// The system gives no random bytes for a token.
    #[error("the system gives no random bytes for the page's token: {reason}")]
    Token {
        /// What the system says.
        reason: String,
    },
    /// A page asked for a take that is not there.
    #[error("expected a take below {takes}, found {found}")]
    NoTake {
        /// The number asked for.
        found: u32,
        /// How many takes there are.
        takes: usize,
    },
    /// A page asked for a frame behind the end of a take.
    #[error("expected a frame below {frames}, found {found}")]
    NoFrame {
        /// The place asked for.
        found: usize,
        /// How many frames the take has.
        frames: usize,
    },
    /// A page asked for more frames at once than it gets.
    #[error("expected at most 600 frames, found {found}")]
    TooManyFrames {
        /// How many were asked for.
        found: usize,
    },
    /// A page asked for a channel that a take does not have.
    #[error("expected a channel of the take, as position/Pelvis/z, found {found:?}")]
    NoChannel {
        /// The name asked for.
        found: String,
    },
}

impl Error {
    /// What to do about it, where there is something to do, by `posewire view`.
    pub fn help(&self) -> Option<String> {
        self.help_with("--listen ")
    }

    /// The same by a command whose option for the address is written so, as in `--view=`.
    pub fn help_with(&self, option: &str) -> Option<String> {
        let name = option.trim_end_matches([' ', '=']);
        match self {
            Self::Listen { address, kind, .. } => Some(listen_help(*address, *kind, option)),
            Self::Token { .. } => Some(format!(
                "serve it to this machine alone: leave the address of {name} out"
            )),
            Self::NoTake { .. } | Self::NoFrame { .. } | Self::NoChannel { .. } => {
                Some("GET /api/scene lists the takes, their frames and channels".into())
            }
            Self::TooManyFrames { .. } => Some("ask for them in several requests".into()),
        }
    }
}

fn listen_help(address: SocketAddr, kind: std::io::ErrorKind, option: &str) -> String {
    use std::io::ErrorKind;
    let name = option.trim_end_matches([' ', '=']);
    let (host, port) = (address.ip(), address.port());
    match kind {
        ErrorKind::AddrInUse => format!(
            "another program, perhaps another posewire, has port {port}: `ss -ltnp 'sport = :{port}'` names it; stop it or \
             choose another port, as in {option}{}",
            SocketAddr::new(host, port.wrapping_add(1).max(1024))
        ),
        ErrorKind::AddrNotAvailable => {
            format!("{host} is not an address of this machine: use one of its own, or 0.0.0.0 for all")
        }
        ErrorKind::PermissionDenied => format!("ports below 1024 need privileges: choose a higher one with {name}"),
        _ => format!("choose another address with {name}"),
    }
}
