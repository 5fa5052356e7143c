//! Whether a take agrees with itself.

mod checks;
mod record;
mod text;

pub(super) use record::Verification;
pub(super) use text::write;

use posewire_motion::Frame;
use posewire_motion::kinematics::check::{AngleDifferences, ClockCheck, DerivativeDifferences, LengthErrors};

/// What the frames so far tell, besides what every inspection follows.
#[derive(Debug)]
pub(super) struct Verifier {
    /// Samples a second; 0 when the take does not say.
    rate: f64,
    angles: AngleDifferences,
    lengths: LengthErrors,
    clock: ClockCheck,
    velocities: DerivativeDifferences,
}

impl Verifier {
    pub(super) fn new(rate: f64) -> Self {
        Self {
            rate,
            angles: AngleDifferences::new(),
            lengths: LengthErrors::new(),
            clock: ClockCheck::new(rate),
            velocities: DerivativeDifferences::new(rate),
        }
    }

    pub(super) fn add(&mut self, frame: &Frame) {
        self.angles.add(frame);
        self.lengths.add(frame);
        self.clock.add(frame);
        self.velocities.add(frame);
    }

    /// There are no more frames.
    pub(super) fn finish(&mut self) {
        self.velocities.finish();
    }
}
