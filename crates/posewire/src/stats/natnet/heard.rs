//! How well a subject of a NatNet server is tracked.

use crate::stats::{SubjectStatistics, Tracking};
use posewire_motion::{Frame, Subject, Timecode};
use std::sync::Arc;

/// What frames said of a subject. Frames are numbered from 1.
#[derive(Debug)]
pub(super) struct Heard {
    pub(super) subject: Arc<Subject>,
    timecode: Option<Timecode>,
    tracked: usize,
    /// The frame that held it last.
    latest: u64,
    /// Frames since the one before it was heard of, and how many of them tracked all of it.
    before: u64,
    whole: u64,
}

impl Heard {
    /// One that was described after so many frames.
    pub(super) fn new(subject: &Arc<Subject>, frames: u64) -> Self {
        Self {
            subject: Arc::clone(subject),
            timecode: None,
            tracked: 0,
            latest: 0,
            before: frames.saturating_sub(1),
            whole: 0,
        }
    }

    /// What the newest frame says of it, which is the frame of this number.
    pub(super) fn sample(&mut self, frame: &Frame, number: u64) {
        self.timecode = frame.timecode.or(self.timecode);
        self.latest = number;
        self.tracked = frame.position.iter().flatten().count();
        self.whole += u64::from(self.tracked == frame.subject.skeleton.segments.len());
    }

    /// `frames` is the number of the newest frame.
    pub(super) fn report(&self, frames: u64) -> SubjectStatistics {
        let segments = self.subject.skeleton.segments.len();
        let tracking = Tracking {
            segments,
            tracked: if self.latest == frames { self.tracked } else { 0 },
            frames_untracked: (frames - self.before).saturating_sub(self.whole),
            awaited: self.latest == 0,
        };
        SubjectStatistics {
            subject: Arc::clone(&self.subject),
            timecode: self.timecode,
            streams: Vec::new(),
            samples: None,
            transit: None,
            tracking: (segments > 0).then_some(tracking),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DVec3, Segment, SegmentKind, Skeleton};

    fn body() -> Arc<Subject> {
        let skeleton = Skeleton {
            segments: vec![Segment::new("Wand", SegmentKind::Body)],
            ..Skeleton::default()
        };
        Arc::new(Subject::new("Wand", skeleton))
    }

    #[test]
    fn a_body_is_lost_when_its_position_or_the_body_itself_is_missing() {
        let body = body();
        let mut heard = Heard::new(&body, 2);
        let tracking = |heard: &Heard, frames| heard.report(frames).tracking.unwrap();
        assert!(tracking(&heard, 2).awaited);
        let mut sample = Frame::new(Arc::clone(&body));
        sample.position = vec![Some(DVec3::ZERO)];
        heard.sample(&sample, 2);
        let whole = Tracking {
            segments: 1,
            tracked: 1,
            frames_untracked: 0,
            awaited: false,
        };
        assert_eq!(tracking(&heard, 2), whole);
        let missing = tracking(&heard, 3);
        assert_eq!((missing.tracked, missing.frames_untracked), (0, 1));
        sample.position = vec![None];
        heard.sample(&sample, 4);
        let untracked = tracking(&heard, 4);
        assert_eq!((untracked.tracked, untracked.frames_untracked), (0, 2));
    }
}
