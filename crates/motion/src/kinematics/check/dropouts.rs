//! What is missing: samples, and segments in them.

use crate::Frame;

/// Which samples are missing, and in which samples segments are not tracked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dropouts {
    last: Option<u32>,
    missing: Runs,
    out_of_order: u64,
    segments: Vec<Untracked>,
}

/// The samples in which a segment is not tracked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Untracked {
    runs: Runs,
    /// Whether the sample before belongs to a run.
    open: bool,
}

impl Dropouts {
    /// Of no sample yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a sample into account. All samples must be of one skeleton.
    ///
    /// A segment is not tracked when its position or its orientation is not, of the two sections those that are there.
    pub fn add(&mut self, frame: &Frame) {
        if let Some(last) = self.last.replace(frame.sample) {
            if frame.sample <= last {
                self.out_of_order += 1;
            } else if frame.sample - last > 1 {
                self.missing.begin(last + 1, frame.sample - 1);
            }
        }
        let entries = frame.position.len().max(frame.orientation.len());
        let entries = entries.max(self.segments.len());
        self.segments.resize(entries, Untracked::default());
        for (place, segment) in self.segments.iter_mut().enumerate() {
            segment.add(frame.sample, is_tracked(frame, place));
        }
    }

    /// Sample numbers without a sample, between the first and the last.
    pub fn missing(&self) -> &Runs {
        &self.missing
    }

    /// Samples whose number is not above that of the sample before.
    pub fn out_of_order(&self) -> u64 {
        self.out_of_order
    }

    /// Per segment: the samples in which it is not tracked. Samples that are missing do not break a run.
    pub fn untracked(&self) -> impl ExactSizeIterator<Item = &Runs> {
        self.segments.iter().map(|segment| &segment.runs)
    }
}

impl Untracked {
    fn add(&mut self, sample: u32, tracked: bool) {
        match (tracked, self.open) {
            (true, _) => {}
            (false, false) => self.runs.begin(sample, sample),
            (false, true) => self.runs.extend(sample),
        }
        self.open = !tracked;
    }
}

fn is_tracked(frame: &Frame, segment: usize) -> bool {
    let position = frame.position.get(segment);
    let orientation = frame.orientation.get(segment);
    position.is_none_or(Option::is_some) && orientation.is_none_or(Option::is_some)
}

/// Runs of samples. Memory does not grow with their number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs {
    /// Samples of all runs together.
    pub count: u64,
    /// The first and the last sample number of each run; the first [`MOST`](Self::MOST) runs.
    pub runs: Vec<[u32; 2]>,
    /// Runs that are counted but not listed.
    pub left_out: u64,
}

impl Runs {
    /// How many runs are listed.
    pub const MOST: usize = 100;

    fn begin(&mut self, first: u32, last: u32) {
        self.count += u64::from(last - first) + 1;
        if self.runs.len() < Self::MOST {
            self.runs.push([first, last]);
        } else {
            self.left_out += 1;
        }
    }

    /// The last run goes on to this sample.
    fn extend(&mut self, sample: u32) {
        self.count += 1;
        if let Some([_, last]) = self.runs.last_mut().filter(|_| self.left_out == 0) {
            *last = sample;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, DVec3, Skeleton, Subject};
    use std::sync::Arc;

    fn dropouts(samples: impl IntoIterator<Item = (u32, bool)>) -> Dropouts {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        let mut dropouts = Dropouts::new();
        for (sample, tracked) in samples {
            frame.sample = sample;
            frame.position = vec![Some(DVec3::ZERO), tracked.then_some(DVec3::ZERO)];
            frame.orientation = vec![Some(DQuat::IDENTITY); 2];
            dropouts.add(&frame);
        }
        dropouts
    }

    #[test]
    fn missing_samples_are_told_in_runs() {
        let dropouts = dropouts([3, 4, 7, 9].map(|sample| (sample, true)));
        assert_eq!(dropouts.missing().count, 3);
        assert_eq!(dropouts.missing().runs, [[5, 6], [8, 8]]);
    }

    #[test]
    fn samples_that_go_back_are_not_missing() {
        let dropouts = dropouts([5, 5, 4, u32::MAX].map(|sample| (sample, true)));
        assert_eq!(dropouts.out_of_order(), 2);
        assert_eq!(dropouts.missing().runs, [[5, u32::MAX - 1]]);
    }

    #[test]
    fn untracked_samples_are_told_in_runs_per_segment() {
        let dropouts = dropouts([(1, true), (2, false), (3, false), (6, false), (7, true), (8, false)]);
        let found: Vec<_> = dropouts.untracked().cloned().collect();
        assert_eq!(found[0], Runs::default());
        assert_eq!(
            (found[1].count, found[1].runs.as_slice()),
            (4, [[2, 6], [8, 8]].as_slice())
        );
    }

    #[test]
    fn what_is_kept_is_bounded() {
        let dropouts = dropouts((0..4000).map(|n| (n * 2, n % 2 == 0)));
        let untracked = dropouts.untracked().last().unwrap();
        for (runs, count) in [(dropouts.missing(), 3999), (untracked, 2000)] {
            assert_eq!((runs.runs.len() as u64 + runs.left_out, runs.count), (count, count));
            assert_eq!(runs.runs.len(), Runs::MOST);
        }
    }
}
