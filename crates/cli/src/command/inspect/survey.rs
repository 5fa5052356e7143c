//! What the frames of a take tell when one goes through all of them.

use posewire_motion::kinematics::LargestGaps;
use posewire_motion::{Frame, Timecode};
use serde::Serialize;
use std::time::Duration;

/// What was seen of the frames so far. It does not grow with their number.
#[derive(Debug, Default)]
pub(super) struct Survey {
    pub(super) frames: u64,
    pub(super) first: Option<Instants>,
    pub(super) last: Option<Instants>,
    pub(super) missing: Missing,
    /// Frames whose number is not above that of the frame before.
    pub(super) out_of_order: u64,
    pub(super) events: Events,
    pub(super) gaps: LargestGaps,
    /// The sample with the largest gap of all.
    pub(super) worst_sample: Option<u32>,
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

/// Sample numbers that have no frame.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Missing {
    pub(super) count: u64,
    /// The first and the last number of each run; the first runs only.
    pub(super) runs: Vec<[u32; 2]>,
    pub(super) runs_left_out: u64,
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
    }

    fn follow_samples(&mut self, frame: &Frame) {
        let now = Instants {
            sample: frame.sample,
            time: frame.time,
            timecode: frame.timecode,
        };
        self.first.get_or_insert(now);
        if let Some(before) = self.last.replace(now) {
            if now.sample <= before.sample {
                self.out_of_order += 1;
            } else if now.sample - before.sample > 1 {
                self.missing.add(before.sample + 1, now.sample - 1);
            }
        }
    }

    /// From the first sample to the end of the last, by their numbers at this rate.
    pub(super) fn duration(&self, rate_hz: f64) -> Option<f64> {
        let (first, last) = (self.first?, self.last?);
        let samples = u64::from(last.sample.checked_sub(first.sample)?) + 1;
        Some(samples as f64 / rate_hz)
    }
}

impl Missing {
    fn add(&mut self, first: u32, last: u32) {
        self.count += u64::from(last - first) + 1;
        if self.runs.len() < MAX_RUNS {
            self.runs.push([first, last]);
        } else {
            self.runs_left_out += 1;
        }
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

const MAX_RUNS: usize = 100;
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
    fn missing_samples_are_told_in_runs() {
        let survey = survey([3, 4, 7, 9]);
        assert_eq!(survey.missing.count, 3);
        assert_eq!(survey.missing.runs, [[5, 6], [8, 8]]);
        assert_eq!(survey.duration(10.0), Some(0.7));
    }

    #[test]
    fn samples_that_go_back_are_not_missing() {
        let survey = survey([5, 5, 4, u32::MAX]);
        assert_eq!(survey.out_of_order, 2);
        assert_eq!(survey.missing.runs, [[5, u32::MAX - 1]]);
    }

    #[test]
    fn what_is_kept_is_bounded() {
        let survey = survey((0..4000).map(|n| n * 2));
        assert_eq!((survey.missing.runs.len(), survey.missing.runs_left_out), (100, 3899));
        assert_eq!((survey.events.list.len(), survey.events.left_out), (1000, 3000));
        assert_eq!(survey.missing.count, 3999);
    }
}
