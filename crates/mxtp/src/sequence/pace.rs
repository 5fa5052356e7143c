//! How fast a counter goes up.

use posewire_motion::Stamp;

/// How fast the counter goes up in receive time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    pub(super) newest: Stamp,
    nanoseconds_per_count: f64,
    steps: u32,
}

impl Pace {
    /// Follows the mean slowly, so that bursts even out; a pause of the sender counts little.
    pub(super) fn advance(&mut self, step: u32, now: Stamp) {
        let measured = now.since(self.newest).as_nanos() as f64 / f64::from(step);
        let limit = match self.steps {
            0 => f64::INFINITY,
            _ => (8.0 * self.nanoseconds_per_count).max(1e6),
        };
        self.steps = (self.steps + 1).min(64);
        self.nanoseconds_per_count += (measured.min(limit) - self.nanoseconds_per_count) / f64::from(self.steps);
        self.newest = now;
    }

    /// How far the counter should have gone since the newest sample; 0 when the receive times say nothing.
    pub(super) fn counts_until(&self, now: Stamp) -> f64 {
        if self.nanoseconds_per_count > 0.0 {
            now.since(self.newest).as_nanos() as f64 / self.nanoseconds_per_count
        } else {
            0.0
        }
    }
}
