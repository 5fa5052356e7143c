//! What travels from a source to its sinks.

mod arrival;
mod foremost;
mod weight;

pub use foremost::Foremost;

use crate::stats::Statistics;
use crate::{Datagram, Error};
use posewire_motion::{Frame, Subject};
use std::fmt;
use std::sync::Arc;
use std::time::Instant;

/// Which source of a session something is from: its place among the sources that the session was started with.
///
/// A subject is known by its number within its source; another source may have another subject of the same number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(pub u16);

/// What travels from a source to its sinks: shared, so that a clone for another sink copies no data.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Item {
    /// A datagram as it arrived, before what was read from it; only for sinks that [want](crate::Sink::wants) datagrams.
    Datagram(Arc<Datagram>),
    /// A subject that is new, or whose description has changed. It comes before its first frame.
    Subject(Arc<Subject>),
    /// One sample of one subject.
    Frame {
        /// The sample.
        frame: Arc<Frame>,
        /// When it was to leave the source, for a source that is paced; `None` for one that is live.
        due: Option<Instant>,
    },
    /// A sample that is complete, ahead of its turn: an older one of its subject, of which something seems to be lost, is still
    /// waited for. It comes as a `Frame` too; only for sinks that [want](crate::Wants::ahead) the newest at once.
    Ahead {
        /// The sample.
        frame: Arc<Frame>,
        /// As that of a `Frame`.
        due: Option<Instant>,
    },
    /// How the stream is doing: once a second from a live source, and a last time when it ends.
    Statistics(Arc<Statistics>),
    /// Something that people should know about the source.
    Notice(Notice),
}

/// Something that people should know about a source.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Notice {
    /// A peer is connected.
    Connected {
        /// Its address.
        peer: String,
    },
    /// A peer has gone.
    Disconnected {
        /// Its address.
        peer: String,
        /// Why, in the system's words.
        reason: String,
    },
    /// No connection comes about. It is tried again, and only the first of failures in a row is told.
    NotConnected {
        /// What failed, and where.
        error: Error,
    },
    /// A multicast group was joined.
    Joined {
        /// The group and the port.
        group: String,
        /// The address and the interface that it was joined on, as `192.168.1.5 (eth0)`.
        interface: String,
    },
    /// The source has failed and gives nothing more, while others go on.
    Failed {
        /// What went wrong.
        error: Error,
    },
    /// Something about the source that people should know, in a sentence without a full stop.
    Remark {
        /// The sentence.
        text: String,
    },
    /// Sources of a recording are passed over that have poses and no datagrams, as others of it have datagrams.
    PosesLeftOut {
        /// The file, as it was named.
        file: String,
        /// The sources, each with its number.
        sources: Vec<String>,
    },
    /// A file ended before its end, and the frames up to there were used.
    Damaged {
        /// The file, as it was named.
        file: String,
        /// What is wrong and where.
        problem: String,
    },
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connected { peer } => write!(f, "connected to {peer}"),
            Self::Disconnected { peer, reason } => write!(f, "lost the connection to {peer}: {reason}"),
            Self::NotConnected { error } => write!(f, "{error}; trying again"),
            Self::Joined { group, interface } => write!(f, "joined {group} on {interface}"),
            Self::Failed { error } => write!(f, "{error}; nothing more comes from there"),
            Self::Remark { text } => f.write_str(text),
            Self::PosesLeftOut { file, sources } => {
                let sources = sources.join(", ");
                write!(
                    f,
                    "{file}: left out: the poses of {sources}, without datagrams; choose a source to play them"
                )
            }
            Self::Damaged { file, problem } => write!(f, "{file}: the file is damaged: {problem}"),
        }
    }
}
