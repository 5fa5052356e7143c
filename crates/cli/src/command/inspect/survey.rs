//! What the frames of a take tell when one goes through all of them.

use super::verify::Verifier;
use posewire_motion::kinematics::LargestGaps;
use posewire_motion::kinematics::check::Dropouts;
use posewire_motion::{Frame, Timecode};
use serde::Serialize;
use std::time::Duration;

/// What was seen of the frames so far. It does not grow with their number, but for the clock that `--verify` follows.
#[derive(Debug, Default)]
pub(super) struct Survey {
    pub(super) frames: u64,
    pub(super) first: Option<Instants>,
    pub(super) last: Option<Instants>,
    pub(super) dropouts: Dropouts,
    pub(super) events: Events,
    pub(super) gaps: LargestGaps,
    /// The sample with the largest gap of all.
    pub(super) worst_sample: Option<u32>,
    /// With `--verify` only.
    pub(super) verifier: Option<Verifier>,
    /// Whether the end of the file was reached.
    pub(super) complete: bool,
}

/// When a sample was.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instants {
    pub(super) sample: u32,
    pub(super) time: Duration,
    pub(super) timecode: Option<Timecode>,
}

/// What the operator marked.
#[derive(Clone, Debug, Default)]
pub(super) struct Events {
    /// The first events only.
    pub(super) list: Vec<Event>,
    pub(super) left_out: u64,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Event {
    pub(super) sample: u32,
    pub(super) name: String,
}

impl Survey {
    pub(super) fn add(&mut self, frame: &Frame) {
        self.frames += 1;
        self.follow_samples(frame);
        for name in &frame.events {
            self.events.add(frame.sample, name);
        }
        let worst = self.gaps.worst();
        self.gaps.add(frame);
        if self.gaps.worst() != worst {
            self.worst_sample = Some(frame.sample);
        }
        if let Some(verifier) = &mut self.verifier {
            verifier.add(frame);
        }
    }

    fn follow_samples(&mut self, frame: &Frame) {
        let now = Instants {
            sample: frame.sample,
            time: frame.time,
            timecode: frame.timecode,
        };
        self.first.get_or_insert(now);
        self.last = Some(now);
        self.dropouts.add(frame);
    }

    /// From the first sample to the end of the last, by their numbers at this rate.
    pub(super) fn duration(&self, rate_hz: f64) -> Option<f64> {
        let (first, last) = (self.first?, self.last?);
        let samples = u64::from(last.sample.checked_sub(first.sample)?) + 1;
        Some(samples as f64 / rate_hz)
    }
}

impl Events {
    fn add(&mut self, sample: u32, name: &str) {
        if self.list.len() < MAX_EVENTS {
            self.list.push(Event {
                sample,
                name: name.to_owned(),
            });
        } else {
            self.left_out += 1;
        }
    }
}

const MAX_EVENTS: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use std::sync::Arc;

    fn survey(samples: impl IntoIterator<Item = u32>) -> Survey {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        frame.events = vec!["clap".to_owned()];
        let mut survey = Survey::default();
        for sample in samples {
            frame.sample = sample;
            survey.add(&frame);
        }
        survey
    }

    #[test]
    fn a_duration_counts_what_is_missing() {
        let survey = survey([3, 4, 7, 9]);
        assert_eq!(survey.dropouts.missing().count, 3);
        assert_eq!(survey.duration(10.0), Some(0.7));
    }

    #[test]
    fn what_is_kept_is_bounded() {
        let survey = survey((0..4000).map(|n| n * 2));
        assert_eq!((survey.events.list.len(), survey.events.left_out), (1000, 3000));
    }
}
