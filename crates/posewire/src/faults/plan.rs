//! What is to go wrong.

use std::fmt;
use std::time::Duration;

/// What is to go wrong in a stream, and how often.
///
/// As text it is a list with commas: `loss=1%,burst=0.1%x20,dup=0.5%,reorder=1%,jitter=5ms,drift=200ppm,reset@10s,`
/// `rewind@15s,truncate=0.1%,flip=0.01%,nan=0.1%,silence@20s+3s,seed=7`. Shares are of all datagrams. Times are since
/// the stream began, in `s`, `ms` or `us`; resets, rewinds and silences may be given several times. `rewind@15s-3s` says
/// how far back, which is 2 s where nothing is said. Printed, it reads as the same plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaultPlan {
    /// Datagrams that do not leave, in a hundred.
    pub loss: f64,
    /// Datagrams in a row that do not leave.
    pub burst: Option<Burst>,
    /// Datagrams that leave twice, in a hundred.
    pub duplicate: f64,
    /// Datagrams that leave after later ones of their streams, in a hundred.
    pub reorder: f64,
    /// Each datagram leaves later by less than this. More than the time between samples changes their order.
    pub jitter: Duration,
    /// How much too fast the sender's clock is, in parts of a million; slow below 0.
    pub drift_ppm: f64,
    /// When the sender begins anew, in ascending order.
    pub resets: Vec<Duration>,
    /// When the sender winds back, in ascending order.
    pub rewinds: Vec<Rewind>,
    /// Datagrams that are cut short, in a hundred.
    pub truncate: f64,
    /// Datagrams of which a bit is flipped, in a hundred.
    pub flip: f64,
    /// Datagrams of which a float is not a number, in a hundred.
    pub nan: f64,
    /// When nothing leaves.
    pub silences: Vec<Silence>,
    /// Which of all faults of this kind they are.
    pub seed: u64,
}

/// Datagrams in a row that do not leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burst {
    /// Datagrams that begin a burst, in a hundred.
    pub percent: f64,
    /// How many are lost with each.
    pub length: u32,
}

/// A sender that winds back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rewind {
    /// When, since the stream began.
    pub at: Duration,
    /// How far; its counter does not go below 0.
    pub back: Duration,
}

/// A time in which nothing leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Silence {
    /// Since when, since the stream began.
    pub at: Duration,
    /// For how long.
    pub length: Duration,
}

impl Silence {
    pub(super) fn contains(&self, now: Duration) -> bool {
        now.checked_sub(self.at).is_some_and(|since| since < self.length)
    }
}

impl fmt::Display for FaultPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |name: &str, percent: f64| (percent != 0.0).then(|| format!("{name}={percent}%"));
        let burst = |burst: Burst| format!("burst={}%x{}", burst.percent, burst.length);
        let rewind = |rewind: &Rewind| format!("rewind@{}-{}", Time(rewind.at), Time(rewind.back));
        let silence = |silence: &Silence| format!("silence@{}+{}", Time(silence.at), Time(silence.length));
        let items = share("loss", self.loss)
            .into_iter()
            .chain(self.burst.map(burst))
            .chain(share("dup", self.duplicate))
            .chain(share("reorder", self.reorder))
            .chain((!self.jitter.is_zero()).then(|| format!("jitter={}", Time(self.jitter))))
            .chain((self.drift_ppm != 0.0).then(|| format!("drift={}ppm", self.drift_ppm)))
            .chain(self.resets.iter().map(|at| format!("reset@{}", Time(*at))))
            .chain(self.rewinds.iter().map(rewind))
            .chain(share("truncate", self.truncate))
            .chain(share("flip", self.flip))
            .chain(share("nan", self.nan))
            .chain(self.silences.iter().map(silence))
            .chain([format!("seed={}", self.seed)]);
        f.write_str(&items.collect::<Vec<_>>().join(","))
    }
}

/// A time in the largest unit that it is a whole number of; nanoseconds are fractions of a microsecond.
struct Time(Duration);

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let nanoseconds = self.0.as_nanos();
        match () {
            () if nanoseconds.is_multiple_of(1_000_000_000) => write!(f, "{}s", nanoseconds / 1_000_000_000),
            () if nanoseconds.is_multiple_of(1_000_000) => write!(f, "{}ms", nanoseconds / 1_000_000),
            () => write!(f, "{}.{:03}us", nanoseconds / 1000, nanoseconds % 1000),
        }
    }
}
