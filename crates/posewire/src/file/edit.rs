//! What can be done with a take between reading and writing.

use super::{Recording, WriteOptions};
use crate::endpoint::FileFormat;
use crate::{Error, Result};
use posewire_motion::Section;
use posewire_motion::kinematics::{completed, resampled};
use std::borrow::Cow;
use std::ops::{Range, RangeInclusive};

/// What is done to a take before it is saved.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// The sample numbers that are kept, both ends included.
    pub samples: RangeInclusive<u32>,
    /// How many samples a second it is given; as many as it has if absent.
    pub rate: Option<f64>,
    /// Whether it was received, with what the sender chose to send: MVNX then gets all that the poses tell.
    pub received: bool,
}

impl Default for Edit {
    /// All samples as they are, of a file.
    fn default() -> Self {
        Self {
            samples: 0..=u32::MAX,
            rate: None,
            received: false,
        }
    }
}

impl Edit {
    /// A take as it is to be saved in a format: what is to be written and is lacking is computed, then it is cut and resampled.
    /// With the sections that were computed.
    ///
    /// # Errors
    /// [`Error::NoSection`] for a section that the options name, the take lacks and its poses do not tell; those of
    /// [`Recording::cut`] and [`Recording::resample`].
    pub fn of<'a>(
        &self,
        mut recording: Cow<'a, Recording>,
        format: FileFormat,
        options: &WriteOptions,
    ) -> Result<(Cow<'a, Recording>, Vec<Section>)> {
        let wanted = self.wanted(format, options);
        let computed = if wanted.iter().any(|section| recording.take.column(*section).is_none()) {
            recording.to_mut().complete(wanted)
        } else {
            Vec::new()
        };
        let lacks = |section: &&Section| recording.take.column(**section).is_none();
        if let Some(section) = options.sections.iter().flatten().find(lacks) {
            return Err(Error::NoSection {
                wanted: section.name(),
                found: recording.take.sections().map(Section::name).collect(),
            });
        }
        if self.samples != (0..=u32::MAX) {
            recording.to_mut().cut(&self.samples)?;
        }
        if let Some(rate) = self.rate {
            recording.to_mut().resample(rate)?;
        }
        Ok((recording, computed))
    }

    /// The sections that are computed where they are lacking.
    fn wanted<'a>(&self, format: FileFormat, options: &'a WriteOptions) -> &'a [Section] {
        match format {
            FileFormat::Mvnx | FileFormat::MvnxGz if self.received && options.sections.is_none() => Section::ALL,
            _ => options.needed(format),
        }
    }
}

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
    fn what_was_asked_for_and_cannot_be_computed_is_an_error() {
        let mut recording = Recording::from(walk(4));
        for section in [Section::Velocity, Section::SensorMagneticField] {
            recording.take.remove_column(section);
        }
        let edited = |sections: &[Section], format| {
            let options = WriteOptions {
                sections: Some(sections.to_vec()),
                ..WriteOptions::default()
            };
            let edit = Edit {
                samples: 1..=2,
                ..Edit::default()
            };
            edit.of(Cow::Borrowed(&recording), format, &options)
        };
        let (whole, computed) = edited(&[Section::Position, Section::Velocity], FileFormat::Csv).unwrap();
        assert_eq!((whole.take.samples(), computed), (&[1, 2][..], vec![Section::Velocity]));
        let error = edited(&[Section::SensorMagneticField], FileFormat::Mvnx).unwrap_err();
        assert!(
            matches!(
                &error,
                Error::NoSection {
                    wanted: "sensor_magnetic_field",
                    ..
                }
            ),
            "{error}"
        );
        assert!(error.is_usage() && error.help().is_some());
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
