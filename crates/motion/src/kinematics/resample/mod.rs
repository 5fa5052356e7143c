//! A take at another rate.

mod between;

use super::ContinuousSigns;
use crate::{Error, Frame, Subject};
use between::between;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// Gives samples of one rate at another.
///
/// The new samples are those of a grid that begins with sample 0 of the source: sample `k` of it is at `k / rate` seconds,
/// which is also its [`time`](Frame::time), so that a clock that jitters is made uniform. Between two samples of the source
///
/// - vectors are interpolated linearly, velocities and accelerations too;
/// - angles are worked out from the new orientations ([`joint_angles`](super::joint_angles)); those that these do not
///   tell are interpolated, the shorter way round;
/// - orientations turn at a constant angular velocity ([`slerp`](crate::rotation::slerp)), and their signs go on from one
///   sample to the next;
/// - contacts, and which markers there are, are those of the nearer sample;
/// - an event goes to the new sample nearest to it, and none is lost while there is any;
/// - the timecode is interpolated too.
///
/// What is not tracked in one of the two is not tracked between them. Where samples are missing nothing is made up: the
/// new samples that fall there are missing as well. A new sample at the very instant of an old one has its values.
///
/// Nothing is filtered: of motion that is faster than half the new rate, the new samples give a slower one.
///
/// ```
/// use posewire_motion::kinematics::Resampler;
/// use posewire_motion::{DVec3, Frame, Skeleton, Subject};
/// use std::sync::Arc;
///
/// let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
/// let mut resampler = Resampler::new(60.0, 90.0)?;
/// let mut done = Vec::new();
/// for sample in 0..3 {
///     let mut frame = Frame::new(subject.clone());
///     frame.sample = sample;
///     frame.position = vec![Some(DVec3::X * f64::from(sample)); 23];
///     done.extend(resampler.push(frame));
/// }
/// done.extend(resampler.finish());
/// assert_eq!(done.iter().map(|frame| frame.sample).collect::<Vec<_>>(), [0, 1, 2, 3]);
/// assert!((done[1].position[0].unwrap().x - 2.0 / 3.0).abs() < 1e-12);
/// assert_eq!(done[1].subject.rate, Some(90.0));
/// # Ok::<(), posewire_motion::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Resampler {
    from: f64,
    to: f64,
    longest_gap: u32,
    /// The newest sample of the source.
    before: Option<Frame>,
    /// The grid's next sample.
    next: u64,
    /// The newest sample of the grid, which may still get events.
    held: Option<Frame>,
    /// Whether it belongs to the run of samples that goes on.
    held_in_run: bool,
    ready: VecDeque<Frame>,
    /// Events for a later sample of the grid, with its number.
    events: Vec<(u64, String)>,
    signs: ContinuousSigns,
    /// A subject of the source, and the same at the new rate.
    subject: Option<(Arc<Subject>, Arc<Subject>)>,
}

impl Resampler {
    /// From samples whose numbers count `from` a second to `to` a second.
    ///
    /// # Errors
    /// [`Error::Rate`] when a rate is not above zero, or `to` is more than 1,000 times `from`.
    pub fn new(from: f64, to: f64) -> Result<Self, Error> {
        let usable = |rate: f64| rate.is_finite() && rate > 0.0;
        if let Some(found) = [from, to].into_iter().find(|&rate| !usable(rate)) {
            return Err(Error::Rate { found });
        }
        if !usable(to / from) || to / from > MOST_PER_SAMPLE {
            return Err(Error::Rate { found: to });
        }
        Ok(Self {
            from,
            to,
            longest_gap: 0,
            before: None,
            next: 0,
            held: None,
            held_in_run: false,
            ready: VecDeque::new(),
            events: Vec::new(),
            signs: ContinuousSigns::new(),
            subject: None,
        })
    }

    /// Interpolates also where up to so many sample numbers are left out: 0 when not said otherwise.
    ///
    /// A source that sends each fourth sample needs 3.
    #[must_use]
    pub fn longest_gap(self, samples: u32) -> Self {
        Self {
            longest_gap: samples,
            ..self
        }
    }

    /// Takes the next sample and gives those of the new rate that are complete.
    pub fn push(&mut self, mut frame: Frame) -> impl Iterator<Item = Frame> {
        let before = self.before.take();
        let before = before.filter(|before| self.continues(before, &frame));
        if before.is_none() {
            self.end_run();
            self.next = self.first_at(frame.sample);
        }
        self.take_events(&mut frame);
        let last = f64::from(frame.sample) + SAME_INSTANT;
        while self.instant(self.next) <= last && u32::try_from(self.next).is_ok() {
            let sample = self.sample_at(self.next, before.as_ref(), &frame);
            self.emit(sample);
        }
        self.before = Some(frame);
        self.ready.drain(..)
    }

    /// Gives the samples that are not given yet.
    pub fn finish(&mut self) -> impl Iterator<Item = Frame> {
        self.end_run();
        self.before = None;
        if let Some(mut held) = self.held.take() {
            held.events.extend(self.events.drain(..).map(|(_, name)| name));
            self.ready.push_back(held);
        }
        self.ready.drain(..)
    }

    fn continues(&self, before: &Frame, next: &Frame) -> bool {
        let step = next.sample.checked_sub(before.sample).filter(|&step| step > 0);
        let one_subject = Arc::ptr_eq(&before.subject, &next.subject) || before.subject == next.subject;
        one_subject && step.is_some_and(|step| step - 1 <= self.longest_gap)
    }

    /// The grid's first sample that is not before a sample of the source.
    fn first_at(&self, sample: u32) -> u64 {
        ((f64::from(sample) - SAME_INSTANT) * self.to / self.from).ceil() as u64
    }

    /// Where a sample of the grid is among the sample numbers of the source.
    fn instant(&self, sample: u64) -> f64 {
        sample as f64 * self.from / self.to
    }

    fn sample_at(&mut self, number: u64, before: Option<&Frame>, after: &Frame) -> Frame {
        let instant = self.instant(number);
        let subject = self.resampled_subject(&after.subject);
        let before = before.filter(|_| instant < f64::from(after.sample) - SAME_INSTANT);
        let mut frame = match before {
            Some(before) => {
                let step = f64::from(after.sample - before.sample);
                between(before, after, (instant - f64::from(before.sample)) / step, subject)
            }
            None => Frame {
                subject,
                ..after.clone()
            },
        };
        frame.sample = u32::try_from(number).unwrap_or(u32::MAX);
        frame.time = Duration::try_from_secs_f64(number as f64 / self.to).unwrap_or(Duration::MAX);
        self.signs.apply(&mut frame);
        frame
    }

    /// Lets the sample before go, and keeps this one until the events up to the next are known.
    fn emit(&mut self, mut frame: Frame) {
        let number = self.next;
        self.next += 1;
        let due = self.events.extract_if(.., |(sample, _)| *sample <= number);
        frame.events.extend(due.map(|(_, name)| name));
        self.ready.extend(self.held.replace(frame));
        self.held_in_run = true;
    }

    /// Puts events aside for the samples of the grid that are nearest to them.
    fn take_events(&mut self, frame: &mut Frame) {
        let nearest = (f64::from(frame.sample) * self.to / self.from).round() as u64;
        for name in frame.events.drain(..) {
            match &mut self.held {
                Some(held) if self.held_in_run && nearest < self.next => held.events.push(name),
                _ => self.events.push((nearest, name)),
            }
        }
    }

    /// Events that no later sample of the run can take go to its last one, or to the next run when it has none.
    fn end_run(&mut self) {
        if let Some(held) = self.held.as_mut().filter(|_| self.held_in_run) {
            held.events.extend(self.events.drain(..).map(|(_, name)| name));
        }
        for (sample, _) in &mut self.events {
            *sample = 0;
        }
        self.held_in_run = false;
    }

    pub(super) fn resampled_subject(&mut self, of: &Arc<Subject>) -> Arc<Subject> {
        match &self.subject {
            Some((source, resampled)) if Arc::ptr_eq(source, of) => Arc::clone(resampled),
            _ => {
                let mut subject = Subject::clone(of);
                subject.rate = Some(self.to);
                let subject = Arc::new(subject);
                self.subject = Some((Arc::clone(of), Arc::clone(&subject)));
                subject
            }
        }
    }
}

/// Instants that are nearer to each other than this are the same, in samples of the source.
const SAME_INSTANT: f64 = 1e-6;
const MOST_PER_SAMPLE: f64 = 1000.0;

#[cfg(test)]
mod tests;
