//! A stream kept in memory, to be written when it has ended.

use super::Sink;
use crate::{Item, Result, SourceId};
use posewire_motion::{Frame, Take};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Keeps all frames, a take for each subject of each source. Clones share them.
///
/// A subject that changes so that its frames fit no more, by a prop for one, begins another take.
#[derive(Clone, Debug, Default)]
pub struct TakeSink {
    takes: Arc<Mutex<Vec<(SourceId, Take)>>>,
}

impl TakeSink {
    /// How many frames there are, of all subjects together.
    pub fn frames(&self) -> usize {
        self.lock().iter().map(|(_, take)| take.len()).sum()
    }

    /// Gives the takes away, source by source, in the order of their first frames.
    ///
    /// The rate of each is the one that its subject states, else that of the source's clock. Where a source sends each
    /// fourth of its samples, as MVN does at 60 of 240 Hz, the samples that are there are numbered on and the rate is theirs.
    /// Sensors of which nothing was ever tracked, and foot contacts that never came, are not in the skeleton.
    pub fn take(&self) -> Vec<Take> {
        let mut takes = std::mem::take(&mut *self.lock());
        takes.sort_by_key(|(source, _)| *source);
        let finished = takes.into_iter().map(|(_, take)| {
            let mut take = paced(take);
            take.remove_unused();
            take
        });
        finished.collect()
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(SourceId, Take)>> {
        self.takes.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for TakeSink {
    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        if let Item::Frame { frame, .. } = item {
            keep(&mut self.lock(), source, frame);
        }
        Ok(())
    }
}

fn keep(takes: &mut Vec<(SourceId, Take)>, source: SourceId, frame: &Frame) {
    let subject = &frame.subject;
    let is_of_subject = |(of, take): &&mut (SourceId, Take)| *of == source && take.subject.id == subject.id;
    let newest = takes.iter_mut().rev().find(is_of_subject);
    if let Some((_, take)) = newest
        && take.subject.skeleton.segments.len() == subject.skeleton.segments.len()
        && take.push(frame).is_ok()
    {
        // What is told of a subject later holds for what came before.
        take.subject = Arc::clone(subject);
        return;
    }
    let mut take = Take::new(Arc::clone(subject), subject.rate.unwrap_or(0.0));
    // A frame that does not fit its own subject has no place anywhere.
    if take.push(frame).is_ok() {
        takes.push((source, take));
    }
}

/// The take with the rate of the samples that are in it.
fn paced(mut take: Take) -> Take {
    let stride = stride(take.samples());
    let rate = if take.rate > 0.0 {
        take.rate / f64::from(stride)
    } else {
        measured_rate(&take, stride)
    };
    if stride == 1 {
        take.rate = rate;
        return take;
    }
    let mut paced = Take::with_capacity(Arc::clone(&take.subject), rate, take.len());
    for mut frame in take.frames() {
        frame.sample /= stride;
        // It came out of a take with the same columns.
        let _ = paced.push(&frame);
    }
    paced
}

/// The number of which all steps from sample to sample are multiples.
fn stride(samples: &[u32]) -> u32 {
    let steps = samples.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
    match steps.fold(0, greatest_common_divisor) {
        0 => 1,
        stride => stride,
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Samples a second by the source's clock, whose milliseconds leave it a little open: a whole number if one is near enough.
fn measured_rate(take: &Take, stride: u32) -> f64 {
    let ends = |last: usize| {
        let elapsed = take.times()[last].checked_sub(take.times()[0])?.as_secs_f64();
        let samples = take.samples()[last].checked_sub(take.samples()[0])?;
        let rate = f64::from(samples) / f64::from(stride) / elapsed;
        let open = rate * CLOCK_STEP / elapsed;
        let whole = rate.round();
        Some(if (whole - rate).abs() <= open { whole } else { rate })
    };
    let rate = take.len().checked_sub(1).and_then(ends);
    rate.filter(|rate| rate.is_finite() && *rate > 0.0)
        .unwrap_or(USUAL_RATE)
}

/// How far off the time between two samples can be, s: both are told in whole milliseconds.
const CLOCK_STEP: f64 = 0.002;
/// Of a stream of one sample: what MVN records with Awinda.
const USUAL_RATE: f64 = 60.0;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DVec3, Skeleton, Subject};
    use std::time::Duration;

    fn frame(subject: &Arc<Subject>, sample: u32) -> Frame {
        let mut frame = Frame::new(Arc::clone(subject));
        frame.sample = sample;
        frame.time = Duration::from_millis(u64::from(sample) * 1000 / 240);
        frame.position = vec![Some(DVec3::X); subject.skeleton.segments.len()];
        frame
    }

    fn kept(frames: Vec<Frame>) -> Vec<Take> {
        let mut sink = TakeSink::default();
        for frame in frames {
            let frame = Arc::new(frame);
            sink.accept(SourceId(0), &Item::Frame { frame, due: None }).unwrap();
        }
        sink.take()
    }

    #[test]
    fn every_fourth_sample_makes_a_take_of_a_quarter_of_the_rate() {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let takes = kept([8, 12, 20].map(|sample| frame(&subject, sample)).to_vec());
        assert_eq!((takes.len(), takes[0].rate), (1, 60.0));
        assert_eq!(takes[0].samples(), [2, 3, 5]);
    }

    #[test]
    fn sensors_and_contacts_that_never_came_are_not_in_the_skeleton() {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let frames = (0..3).map(|sample| {
            let mut frame = frame(&subject, sample);
            frame.sensor_free_acceleration = vec![None; 17];
            frame.sensor_free_acceleration[..11].fill(Some(DVec3::Z));
            frame
        });
        let take = kept(frames.collect()).remove(0);
        let skeleton = &take.subject.skeleton;
        assert_eq!(skeleton.sensors, subject.skeleton.sensors[..11]);
        assert_eq!(skeleton.contacts.len(), 0);
        assert_eq!(take.frame(2).sensor_free_acceleration, [Some(DVec3::Z); 11]);
    }

    #[test]
    fn subjects_of_two_sources_may_have_the_same_number() {
        let mut sink = TakeSink::default();
        for (source, name, sample) in [(1, "Bob", 1), (0, "Ada", 1), (1, "Bob", 2)] {
            let subject = Arc::new(Subject::new(name, Skeleton::standard(0, false)));
            let frame = Arc::new(frame(&subject, sample));
            sink.accept(SourceId(source), &Item::Frame { frame, due: None })
                .unwrap();
        }
        let takes = sink.take();
        let lengths = takes.iter().map(|take| (take.subject.name.as_str(), take.len()));
        assert_eq!(lengths.collect::<Vec<_>>(), [("Ada", 1), ("Bob", 2)]);
    }

    #[test]
    fn every_subject_has_a_take_and_another_when_it_changes() {
        let ada = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let bob = Arc::new(Subject {
            id: 1,
            ..Subject::new("Bob", Skeleton::standard(0, false))
        });
        let changed = Arc::new(Subject::new("Ada", Skeleton::standard(1, false)));
        let frames = [(&ada, 1), (&bob, 1), (&ada, 2), (&changed, 3), (&bob, 2)];
        let takes = kept(frames.map(|(subject, sample)| frame(subject, sample)).to_vec());
        let lengths: Vec<_> = takes
            .iter()
            .map(|take| (take.subject.name.as_str(), take.len()))
            .collect();
        assert_eq!(lengths, [("Ada", 2), ("Bob", 2), ("Ada", 1)]);
    }
}
