//! Faults on purpose: a stream that loses, repeats, delays and damages datagrams as it is told to.
//!
//! A [`FaultPlan`] says what is to go wrong and how often, and reads and writes itself as text. [`Faults`] is a state
//! machine without clock or socket: it takes datagrams that are about to leave and gives back what leaves instead. Two of
//! them with the same plan do the same to the same datagrams, to the byte.
//!
//! ```
//! use posewire::faults::{FaultKind, Faults};
//! use std::time::Duration;
//!
//! let mut faults = Faults::new("loss=50%,seed=7".parse()?);
//! for number in 0..100_u8 {
//!     faults.handle(Duration::from_millis(4) * number.into(), &[number]);
//! }
//! faults.finish();
//! let left = std::iter::from_fn(|| faults.poll()).count() as u64;
//! assert_eq!(left + faults.counts().of(FaultKind::Loss), 100);
//! # Ok::<(), posewire::Error>(())
//! ```

mod counts;
mod damage;
mod delay;
mod draw;
mod kind;
mod live;
mod numbering;
mod outgoing;
mod parse;
mod plan;

pub use counts::{FaultCounts, FaultedStream};
pub use kind::FaultKind;
pub use live::LiveFaults;
pub use plan::{Burst, FaultPlan, Rewind, Silence};

use delay::{Delayed, Held};
use draw::Draw;
use numbering::Numbering;
use outgoing::Outgoing;
use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

/// Makes the faults of a plan in a stream of datagrams.
///
/// Hand it every datagram with the time since the stream began, then take what leaves with [`poll`](Self::poll); call
/// [`handle_timeout`](Self::handle_timeout) when [`timeout`](Self::timeout) says, and [`finish`](Self::finish) at the end.
///
/// A datagram meets at most one of silence, burst, loss, truncate, flip, nan, reorder and dup, in this order, so that the
/// counts add up. Jitter delays what is left of it, and a sender's reset, rewind and drift show in the numbers of all.
/// Which datagrams a kind of fault meets depends on the seed and on their order alone: another kind more or less in the
/// plan changes it only where both meet the same datagram.
///
/// It knows MXTP datagrams and the frames of NatNet. In NatNet frames a reset and a rewind change the frame number, while
/// drift and nan do nothing: where times and floats stand depends on a version that no frame states. What is neither
/// meets only what any bytes can.
#[derive(Debug)]
pub struct Faults {
    plan: FaultPlan,
    /// How many datagrams have come.
    index: u64,
    /// How many more the burst takes.
    burst: u32,
    /// By character; each counts its samples by itself.
    numberings: BTreeMap<Option<u8>, Numbering>,
    delayed: Delayed,
    held: Held,
    ready: VecDeque<Vec<u8>>,
    counts: FaultCounts,
}

impl Faults {
    /// The faults of a plan, for a stream that begins now.
    pub fn new(plan: FaultPlan) -> Self {
        Self {
            plan,
            index: 0,
            burst: 0,
            numberings: BTreeMap::new(),
            delayed: Delayed::default(),
            held: Held::default(),
            ready: VecDeque::new(),
            counts: FaultCounts::default(),
        }
    }

    /// Takes a datagram that is to leave at `now`, a time since the stream began that never goes back.
    pub fn handle(&mut self, now: Duration, datagram: &[u8]) {
        self.handle_timeout(now);
        let mut outgoing = Outgoing::new(datagram);
        let draw = Draw::new(self.plan.seed, self.index);
        self.index += 1;
        self.counts.taken += 1;
        self.renumber(now, &mut outgoing);
        let Some(kind) = self.fate(now, draw) else {
            return self.delay(now, draw, outgoing);
        };
        let is_met = match kind {
            FaultKind::Truncate => damage::truncate(&mut outgoing.bytes, draw),
            FaultKind::Flip => damage::flip(&mut outgoing.bytes, draw),
            FaultKind::Nan => damage::put_nan(&mut outgoing.bytes, draw),
            FaultKind::Reorder => return self.hold(now, draw, outgoing),
            _ => true,
        };
        if is_met {
            self.counts.add(outgoing.stream, kind);
            outgoing.damaged = matches!(kind, FaultKind::Truncate | FaultKind::Flip);
        }
        match kind {
            FaultKind::Silence | FaultKind::Burst | FaultKind::Loss => {}
            FaultKind::Duplicate => {
                outgoing.copies = 2;
                self.delay(now, draw, outgoing);
            }
            _ => self.delay(now, draw, outgoing),
        }
    }

    /// Lets go what was delayed until `now`.
    pub fn handle_timeout(&mut self, now: Duration) {
        while let Some(outgoing) = self.delayed.pop_due(now) {
            self.leave(outgoing);
        }
    }

    /// When [`handle_timeout`](Self::handle_timeout) is next due; `None` while nothing is delayed by time.
    pub fn timeout(&self) -> Option<Duration> {
        self.delayed.first_due()
    }

    /// The next datagram that leaves.
    pub fn poll(&mut self) -> Option<Vec<u8>> {
        self.ready.pop_front()
    }

    /// The stream ends: lets go everything. What nothing has overtaken has then not been reordered.
    pub fn finish(&mut self) {
        self.handle_timeout(Duration::MAX);
        for (outgoing, overtaken) in self.held.drain() {
            if overtaken {
                self.counts.add(outgoing.stream, FaultKind::Reorder);
            }
            self.send(outgoing);
        }
    }

    /// How often what was done.
    pub fn counts(&self) -> &FaultCounts {
        &self.counts
    }

    /// Gives a datagram the numbers of a sender that was reset, wound back or has a clock that drifts.
    fn renumber(&mut self, now: Duration, outgoing: &mut Outgoing) {
        let Some(sample) = outgoing.sample() else { return };
        let character = outgoing.stream.character;
        let numbering = self.numberings.entry(character).or_default();
        numbering.follow(&self.plan, now, sample, outgoing.time_ms());
        for kind in numbering.unseen(outgoing.stream) {
            self.counts.add(outgoing.stream, kind);
        }
        if numbering.renumber(&self.plan, outgoing) {
            self.counts.add(outgoing.stream, FaultKind::Drift);
        }
    }

    /// Which fault the datagram meets, if any.
    fn fate(&mut self, now: Duration, draw: Draw) -> Option<FaultKind> {
        let plan = &self.plan;
        if plan.silences.iter().any(|silence| silence.contains(now)) {
            return Some(FaultKind::Silence);
        }
        if self.burst == 0 {
            let begins = plan.burst.filter(|burst| draw.meets(FaultKind::Burst, burst.percent));
            self.burst = begins.map_or(0, |burst| burst.length);
        }
        if self.burst > 0 {
            self.burst -= 1;
            return Some(FaultKind::Burst);
        }
        let chances = [
            (FaultKind::Loss, plan.loss),
            (FaultKind::Truncate, plan.truncate),
            (FaultKind::Flip, plan.flip),
            (FaultKind::Nan, plan.nan),
            (FaultKind::Reorder, plan.reorder),
            (FaultKind::Duplicate, plan.duplicate),
        ];
        let met = chances.into_iter().find(|(kind, percent)| draw.meets(*kind, *percent));
        met.map(|(kind, _)| kind)
    }

    /// Keeps a datagram back until others of its stream have overtaken it.
    fn hold(&mut self, now: Duration, draw: Draw, outgoing: Outgoing) {
        let overtakers = 1 + draw.below(FaultKind::Reorder, MAX_OVERTAKERS) as u32;
        if let Some(outgoing) = self.held.push(outgoing, overtakers) {
            self.delay(now, draw, outgoing);
        }
    }

    fn delay(&mut self, now: Duration, draw: Draw, outgoing: Outgoing) {
        let limit = self.plan.jitter.as_nanos() as u64;
        if limit == 0 {
            return self.leave(outgoing);
        }
        let delay = Duration::from_nanos(draw.below(FaultKind::Jitter, limit));
        self.counts.add(outgoing.stream, FaultKind::Jitter);
        if let Some(outgoing) = self.delayed.push(now + delay, outgoing) {
            self.leave(outgoing);
        }
    }

    /// Lets a datagram go, and those that it is the last to overtake.
    fn leave(&mut self, outgoing: Outgoing) {
        let overtaken = self.held.overtaken_by(&outgoing);
        self.send(outgoing);
        for outgoing in overtaken {
            self.counts.add(outgoing.stream, FaultKind::Reorder);
            self.send(outgoing);
        }
    }

    fn send(&mut self, outgoing: Outgoing) {
        self.counts.sent += u64::from(outgoing.copies);
        for _ in 1..outgoing.copies {
            self.ready.push_back(outgoing.bytes.clone());
        }
        self.ready.push_back(outgoing.bytes);
    }
}

/// Fewer than the samples that a receiver keeps open, so that what comes late can still be used.
const MAX_OVERTAKERS: u64 = 3;
