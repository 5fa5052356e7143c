//! Kinds of datagrams, and what is odd about some of them.

use std::fmt;

use posewire_mxtp::MessageType;

/// A kind of datagram that is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum DatagramKind {
    /// An MXTP datagram of this type.
    Mxtp(MessageType),
    /// A NatNet frame.
    NatNetFrame,
}

impl DatagramKind {
    /// What it is, in words: `pose, quaternion`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mxtp(message_type) => message_type.name(),
            Self::NatNetFrame => "frame of mocap data",
        }
    }

    /// The MXTP type, if it is one.
    pub const fn message_type(self) -> Option<MessageType> {
        match self {
            Self::Mxtp(message_type) => Some(message_type),
            Self::NatNetFrame => None,
        }
    }
}

impl From<MessageType> for DatagramKind {
    fn from(message_type: MessageType) -> Self {
        Self::Mxtp(message_type)
    }
}

impl fmt::Display for DatagramKind {
    /// The MXTP type's two digits, or `frame`. Stable: `--json` output has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mxtp(message_type) => message_type.fmt(f),
            Self::NatNetFrame => f.pad("frame"),
        }
    }
}

/// A deviation from a protocol's specification that is accepted and counted. Ordered as the protocol's crate has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Quirk {
    /// Of an MXTP sender.
    Mxtp(posewire_mxtp::Quirk),
    /// Of a NatNet server.
    NatNet(posewire_natnet::Quirk),
}

impl Quirk {
    /// The stable name, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mxtp(quirk) => quirk.name(),
            Self::NatNet(quirk) => quirk.name(),
        }
    }

    /// What it means, in one line.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Mxtp(quirk) => quirk.meaning(),
            Self::NatNet(quirk) => quirk.meaning(),
        }
    }
}

impl From<posewire_mxtp::Quirk> for Quirk {
    fn from(quirk: posewire_mxtp::Quirk) -> Self {
        Self::Mxtp(quirk)
    }
}

impl From<posewire_natnet::Quirk> for Quirk {
    fn from(quirk: posewire_natnet::Quirk) -> Self {
        Self::NatNet(quirk)
    }
}

impl fmt::Display for Quirk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
