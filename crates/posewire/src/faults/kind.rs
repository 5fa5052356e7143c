//! The kinds of faults.

use std::fmt;

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum FaultKind {
    /// A datagram does not leave.
    Loss,
    /// A datagram does not leave, and neither did or do those before or after it.
    Burst,
    /// A datagram leaves twice.
    Duplicate,
    /// A datagram leaves after one to three later ones of its stream.
    Reorder,
    /// A datagram leaves up to so much later.
    Jitter,
    /// A datagram has the time of a clock that is too fast or too slow.
    Drift,
    /// The sender begins anew: its sample counter and its time restart at 0.
    Reset,
    /// The sender winds back: its sample counter and its time go back.
    Rewind,
    /// A datagram is cut short.
    Truncate,
    /// One bit of a datagram is flipped.
    Flip,
    /// A float of a datagram is not a number.
    Nan,
    /// For a while nothing leaves.
    Silence,
}

impl FaultKind {
    /// All kinds.
    pub const ALL: [Self; 12] = [
        Self::Loss,
        Self::Burst,
        Self::Duplicate,
        Self::Reorder,
        Self::Jitter,
        Self::Drift,
        Self::Reset,
        Self::Rewind,
        Self::Truncate,
        Self::Flip,
        Self::Nan,
        Self::Silence,
    ];

    /// The word for it in a plan. Stable: `--json` output has it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Loss => "loss",
            Self::Burst => "burst",
            Self::Duplicate => "dup",
            Self::Reorder => "reorder",
            Self::Jitter => "jitter",
            Self::Drift => "drift",
            Self::Reset => "reset",
            Self::Rewind => "rewind",
            Self::Truncate => "truncate",
            Self::Flip => "flip",
            Self::Nan => "nan",
            Self::Silence => "silence",
        }
    }
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
