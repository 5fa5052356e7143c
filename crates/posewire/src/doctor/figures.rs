//! The samples of every subject.

use super::axes::{Axes, Sender};
use super::clocks::SampleClock;
use super::finding::Finding;
use super::landmarks::Landmarks;
use super::lengths::Lengths;
use super::orientation::Orientations;
use super::values::{Finiteness, Relations};
use crate::stats::{Statistics, SubjectStatistics};
use posewire_motion::{Frame, Subject};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// What the samples of every subject are like.
#[derive(Debug)]
pub(super) struct Figures {
    sender: Sender,
    by_number: BTreeMap<u32, Figure>,
}

/// What the samples of one subject are like.
#[derive(Debug)]
struct Figure {
    subject: Arc<Subject>,
    landmarks: Option<Landmarks>,
    axes: Axes,
    lengths: Lengths,
    orientations: Orientations,
    finiteness: Finiteness,
    relations: Relations,
    clock: SampleClock,
    pace: Pace,
}

/// How many samples a second there are by the stream's own clock.
#[derive(Clone, Copy, Debug, Default)]
struct Pace {
    last: Option<(u32, Duration)>,
    samples: u64,
    time: Duration,
}

impl Figures {
    pub(super) fn new(sender: Sender) -> Self {
        Self {
            sender,
            by_number: BTreeMap::new(),
        }
    }

    pub(super) fn sample(&mut self, frame: &Frame) {
        let number = frame.subject.id;
        if self.by_number.len() >= MOST && !self.by_number.contains_key(&number) {
            return;
        }
        let figure = self
            .by_number
            .entry(number)
            .or_insert_with(|| Figure::new(&frame.subject));
        figure.sample(frame, self.sender == Sender::Mxtp);
    }

    pub(super) fn findings(&self) -> impl Iterator<Item = Finding> {
        self.by_number.values().flat_map(|figure| figure.findings(self.sender))
    }

    /// Whose time of day is another than ours, as the statistics have it.
    pub(super) fn of_clocks(&self, all: &Statistics) -> Vec<Finding> {
        let of_subject = |of: &SubjectStatistics| {
            let figure = self.by_number.get(&of.subject.id)?;
            let finding = figure.clock.of_difference(of.transit?.clocks)?;
            Some(finding.at(called(&figure.subject)))
        };
        all.subjects.iter().filter_map(of_subject).collect()
    }

    /// Samples a second of a subject by the stream's own clock, once that has run for long enough.
    pub(super) fn rate_hz(&self, number: u32) -> Option<f64> {
        self.by_number.get(&number)?.pace.rate_hz()
    }
}

impl Figure {
    fn new(subject: &Arc<Subject>) -> Self {
        Self {
            subject: Arc::clone(subject),
            landmarks: Landmarks::of(subject),
            axes: Axes::default(),
            lengths: Lengths::default(),
            orientations: Orientations::default(),
            finiteness: Finiteness::default(),
            relations: Relations::default(),
            clock: SampleClock::default(),
            pace: Pace::default(),
        }
    }

    fn sample(&mut self, frame: &Frame, has_utc: bool) {
        if !Arc::ptr_eq(&self.subject, &frame.subject) {
            self.subject = Arc::clone(&frame.subject);
            self.landmarks = Landmarks::of(&frame.subject);
        }
        let placed = self.landmarks.and_then(|landmarks| landmarks.placed(frame));
        if let Some(placed) = &placed {
            self.axes.sample(placed);
        }
        self.lengths.sample(frame, placed.as_ref());
        self.orientations.sample(frame);
        self.finiteness.sample(frame);
        self.relations.sample(frame);
        self.clock.sample(frame, has_utc);
        self.pace.sample(frame);
    }

    fn findings(&self, sender: Sender) -> Vec<Finding> {
        let relative = self.relations.finding(sender);
        // In a heap nothing else is right either, and along another axis no orientation fits.
        let is_heap = relative.is_some();
        let axes = self.axes.finding(sender).filter(|_| !is_heap);
        let lengths = self.lengths.finding().filter(|_| !is_heap);
        // What a NatNet server takes for its T-pose is its own affair.
        let fit = self
            .orientations
            .of_fit()
            .filter(|_| axes.is_none() && sender == Sender::Mxtp);
        let of_values = [self.finiteness.finding(), self.orientations.of_length()];
        let all = [relative, axes, lengths, fit]
            .into_iter()
            .chain(of_values)
            .chain([self.clock.of_jumps()]);
        all.flatten().map(|finding| finding.at(called(&self.subject))).collect()
    }
}

impl Pace {
    fn sample(&mut self, frame: &Frame) {
        let now = (frame.sample, frame.time);
        let Some((number, time)) = self.last.replace(now) else {
            return;
        };
        let samples = frame.sample.checked_sub(number);
        let step = frame.time.checked_sub(time);
        if let (Some(samples @ 1..=256), Some(step)) = (samples, step.filter(|step| *step < LONGEST_STEP)) {
            self.samples += u64::from(samples);
            self.time += step;
        }
    }

    fn rate_hz(&self) -> Option<f64> {
        (self.time >= LONG_ENOUGH).then(|| self.samples as f64 / self.time.as_secs_f64())
    }
}

/// A subject by its name, or else by its number.
pub(super) fn called(subject: &Subject) -> String {
    match subject.name.as_str() {
        "" => format!("character {}", subject.id),
        name => name.replace(char::is_control, "\u{fffd}"),
    }
}

/// As many as are followed of a NatNet server.
const MOST: usize = 2048;
const LONGEST_STEP: Duration = Duration::from_secs(1);
/// Header times are whole milliseconds.
const LONG_ENOUGH: Duration = Duration::from_secs(1);

#[cfg(test)]
mod tests {
    use super::super::Check;
    use super::super::test::upright;
    use super::*;

    #[test]
    fn findings_bear_the_name_of_the_subject() {
        let mut figures = Figures::new(Sender::Mxtp);
        let mut frame = upright();
        for position in frame.position.iter_mut().flatten() {
            *position *= 100.0;
        }
        figures.sample(&frame);
        let found: Vec<_> = figures.findings().collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(
            (found[0].check, found[0].place.as_deref()),
            (Check::WrongUnit, Some("Ada"))
        );
    }

    #[test]
    fn the_rate_is_told_by_the_clock_of_the_samples() {
        let mut figures = Figures::new(Sender::Mxtp);
        let mut frame = upright();
        for sample in 0..500_u32 {
            (frame.sample, frame.time) = (sample, Duration::from_millis(u64::from(sample) * 25 / 6));
            figures.sample(&frame);
        }
        assert!((figures.rate_hz(0).unwrap() - 240.0).abs() < 1.0);
        assert_eq!(figures.rate_hz(1), None);
    }
}
