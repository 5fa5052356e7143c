//! The time that a source goes by.

use crate::clock::Clock;
use posewire_motion::Stamp;
use std::time::Duration;

/// The time that a source goes by: that of the system, or for a capture that is played, when its datagrams came.
#[derive(Clone, Copy, Debug)]
pub(super) enum Timeline {
    Live(Clock),
    Played {
        now: Stamp,
        /// The latest that it has been.
        steady: Stamp,
    },
}

impl Timeline {
    pub(super) fn live() -> Self {
        Self::Live(Clock::new())
    }

    /// That of a capture which begins then.
    pub(super) const fn played(at: Stamp) -> Self {
        Self::Played { now: at, steady: at }
    }

    /// UTC, which goes back where the clock is set back.
    pub(super) fn now(&self) -> Stamp {
        match self {
            Self::Live(clock) => clock.now(),
            Self::Played { now, .. } => *now,
        }
    }

    /// A time that never goes back.
    pub(super) fn steady(&self) -> Stamp {
        match self {
            Self::Live(clock) => clock.steady(),
            Self::Played { steady, .. } => *steady,
        }
    }

    /// When something with this stamp arrived, on the time that never goes back, at most `longest` ago; what is played comes
    /// when its time has come.
    pub(super) fn arrival(&self, stamp: Stamp, longest: Duration) -> Stamp {
        match self {
            Self::Live(clock) => clock.arrival(stamp, longest),
            Self::Played { steady, .. } => *steady,
        }
    }

    /// Goes on to a time of a capture. What is live goes on by itself.
    pub(super) fn go_on(&mut self, to: Stamp) {
        if let Self::Played { now, steady } = self {
            (*now, *steady) = (to, to.max(*steady));
        }
    }

    pub(super) const fn is_live(&self) -> bool {
        matches!(self, Self::Live(_))
    }
}
