//! The words of the file: topics, schemas, and the keys of channels and metadata records.

use crate::{SourceId, Wire};
use std::collections::BTreeMap;
use std::net::SocketAddr;

/// The key of a channel's metadata that says what its messages are: [`RAW`], [`REPEATED`] or [`POSES`].
pub const KIND: &str = "posewire";
/// The kind of channels with datagrams as they arrived.
pub const RAW: &str = "raw";
/// The kind of channels with datagrams of an earlier file that describe what is in this one.
pub const REPEATED: &str = "repeated";
/// The kind of channels with decoded poses.
pub const POSES: &str = "poses";

/// The key of a source's number.
pub const SOURCE: &str = "source";
/// The key of a [`Wire`]'s name.
pub const WIRE: &str = "wire";
/// The key of the sender's address.
pub const FROM: &str = "from";
/// The key of the address that was received at.
pub const TO: &str = "to";
/// The key of a subject's number at its source.
pub const SUBJECT: &str = "subject";
/// The key of a subject's name.
pub const NAME: &str = "name";

/// The metadata record that every file begins with.
pub const RECORDING: &str = "posewire.recording";
/// The metadata record of a source.
pub const SOURCE_RECORD: &str = "posewire.source";
/// The metadata record of a subject's description.
pub const SUBJECT_RECORD: &str = "posewire.subject";
/// The metadata record that a finished file ends with.
pub const END: &str = "posewire.end";
/// Its key that says whether the recording goes on in another file: `true` or `false`.
pub const CONTINUED: &str = "continued";

/// Whether a record [`END`] says that the recording goes on in another file.
pub(crate) fn is_continued(end: &BTreeMap<String, String>) -> bool {
    end.get(CONTINUED).is_some_and(|value| value == "true")
}

/// Text by key, as channels and metadata records have it.
pub(super) type Keys = BTreeMap<String, String>;

pub(super) fn keys<const N: usize>(pairs: [(&str, String); N]) -> Keys {
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}

pub(super) fn raw_topic(source: SourceId, kind: &str) -> String {
    format!("/{}/{kind}", source.0)
}

pub(super) fn raw_keys(kind: &str, source: SourceId, wire: Wire, from: SocketAddr, to: SocketAddr) -> Keys {
    keys([
        (KIND, kind.to_owned()),
        (SOURCE, source.0.to_string()),
        (WIRE, wire.to_string()),
        (FROM, from.to_string()),
        (TO, to.to_string()),
    ])
}

/// The encoding of raw messages.
pub(super) const fn protocol(wire: Wire) -> &'static str {
    match wire {
        Wire::MxtpUdp | Wire::MxtpTcp => "mxtp",
        Wire::NatNetCommand | Wire::NatNetData => "natnet",
    }
}
