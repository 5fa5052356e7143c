//! What can be done with a take between reading and writing.

use super::Recording;
use crate::{Error, Result};
use posewire_motion::Section;
use posewire_motion::kinematics::{completed, resampled};
use std::ops::{Range, RangeInclusive};

/// The rates that a take can be given, samples a second: those that a file can have.
pub const RATES: Range<f64> = 0.001..1e6;

impl Recording {
    /// Keeps the frames from one sample number to another, both included.
    ///
    /// # Errors
    /// [`Error::NoSamples`] when there are none.
    pub fn cut(&mut self, samples: &RangeInclusive<u32>) -> Result<()> {
        let numbers = self.take.samples();
        let begin = numbers.iter().position(|sample| sample >= samples.start());
        let end = numbers.iter().rposition(|sample| sample <= samples.end());
        match (begin, end) {
            (Some(begin), Some(end)) if begin <= end => {
                if (begin, end + 1) != (0, numbers.len()) {
                    self.take = self.take.slice(begin..end + 1);
                }
                Ok(())
            }
            _ => Err(Error::NoSamples {
                from: *samples.start(),
                to: *samples.end(),
                first: numbers.first().copied().unwrap_or_default(),
                last: numbers.last().copied().unwrap_or_default(),
            }),
        }
    }

    /// Gives the take another rate, samples a second, one of [`RATES`]: see [`Resampler`](posewire_motion::kinematics::Resampler).
    ///
    /// # Errors
    /// [`Error::NewRate`] when the rate is none, or the take has none itself.
    pub fn resample(&mut self, rate: f64) -> Result<()> {
        if rate.to_bits() == self.take.rate.to_bits() {
            return Ok(());
        }
        let captured = self.take.rate.to_string();
        let wrong = || Error::NewRate {
            captured: captured.clone(),
            found: rate.to_string(),
        };
        if !RATES.contains(&rate) {
            return Err(wrong());
        }
        let resampled = resampled(&self.take, rate).map_err(|_| wrong())?;
        if let Some(document) = &mut self.document {
            document.set_rate(rate).map_err(|_| wrong())?;
        }
        self.take = resampled;
        Ok(())
    }

    /// Computes those of these sections that the take lacks and its poses tell, and says which.
    pub fn complete(&mut self, sections: &[Section]) -> Vec<Section> {
        let lacks = |section: &Section| self.take.column(*section).is_none();
        let lacking: Vec<_> = sections.iter().copied().filter(lacks).collect();
        if lacking.is_empty() {
            return lacking;
        }
        // A take that does not fit its own skeleton tells nothing.
        let Ok(mut whole) = completed(&self.take) else {
            return Vec::new();
        };
        let computed = lacking.into_iter().filter(|&section| {
            let column = whole.remove_column(section);
            column.is_some_and(|column| self.take.set_column(section, column.values().to_vec()).is_ok())
        });
        computed.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::walk;
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_cut_keeps_both_its_ends() {
        let mut recording = Recording::from(walk(10));
        recording.cut(&(3..=5)).unwrap();
        assert_eq!(recording.take.samples(), [3, 4, 5]);
        let error = recording.cut(&(6..=u32::MAX)).unwrap_err();
        assert_eq!(
            error,
            Error::NoSamples {
                from: 6,
                to: u32::MAX,
                first: 3,
                last: 5
            }
        );
    }

    #[test]
    fn another_rate_has_other_frames() {
        let mut recording = Recording::from(walk(9));
        recording.resample(60.0).unwrap();
        assert_eq!((recording.take.len(), recording.take.rate), (3, 60.0));
        for rate in [-PI, 0.0, 0.0005, 1e6, f64::NAN] {
            assert!(matches!(recording.resample(rate), Err(Error::NewRate { .. })), "{rate}");
        }
    }

    #[test]
    fn what_is_lacking_is_computed_and_named() {
        let mut recording = Recording::from(walk(4));
        recording.take.remove_column(Section::JointAngles);
        recording.take.remove_column(Section::Velocity);
        assert_eq!(
            recording.complete(&[Section::JointAngles, Section::Position]),
            [Section::JointAngles]
        );
        assert!(recording.take.column(Section::JointAngles).is_some());
        assert!(recording.take.column(Section::Velocity).is_none());
    }
}
