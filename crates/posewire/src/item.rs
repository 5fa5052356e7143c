//! What travels from a source to its sinks.

use crate::Error;
use crate::stats::Statistics;
use posewire_motion::{Frame, Subject};
use std::fmt;
use std::sync::Arc;
use std::time::Instant;

/// What travels from a source to its sinks: shared, so that a clone for another sink copies no data.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Item {
    /// A subject that is new, or whose description has changed. It comes before its first frame.
    Subject(Arc<Subject>),
    /// One sample of one subject.
    Frame {
        /// The sample.
        frame: Arc<Frame>,
        /// When it was to leave the source, for a source that is paced.
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
    /// Something about the source that people should know, in a sentence without a full stop.
    Remark {
        /// The sentence.
        text: String,
    },
    /// A file ended before its end, and the frames up to there were used.
    Damaged {
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
            Self::Remark { text } => f.write_str(text),
            Self::Damaged { problem } => write!(f, "the file is damaged: {problem}"),
        }
    }
}
