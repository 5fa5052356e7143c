//! Which protocol is monitored, and its words.

use posewire::endpoint::Endpoint;

/// Which protocol is monitored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Protocol {
    /// Characters, each with datagrams of several types.
    #[default]
    Mxtp,
    /// A server with frames that hold every subject.
    NatNet,
}

impl Protocol {
    pub(super) const fn of(endpoint: &Endpoint) -> Self {
        match endpoint {
            Endpoint::NatNet(_) => Self::NatNet,
            _ => Self::Mxtp,
        }
    }

    /// What moves.
    pub(super) const fn subject(self) -> &'static str {
        match self {
            Self::Mxtp => "character",
            Self::NatNet => "subject",
        }
    }

    /// What comes of it.
    pub(super) const fn sample(self) -> &'static str {
        match self {
            Self::Mxtp => "sample",
            Self::NatNet => "frame",
        }
    }
}
