//! The numbers that a page plots live: every sample of a few channels, until they are fetched.

use crate::channel::{self, Channel};
use crate::derived::{Difference, differences_of};
use posewire_motion::kinematics::complete;
use posewire_motion::{Frame, Skeleton};
use serde::Deserialize;
use std::collections::VecDeque;

/// A channel that a page asks for.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(crate) struct Wish {
    /// The page's number of it.
    id: u16,
    /// The subject's number on the page.
    subject: u32,
    /// Its name, `section/entry/axis`.
    channel: String,
}

/// The most channels of a page.
pub(crate) const MOST_CHANNELS: usize = 16;

/// What a page plots. What it does not fetch in time is bounded: the oldest samples go first.
#[derive(Debug, Default)]
pub(crate) struct Plot {
    series: Vec<Series>,
}

#[derive(Debug)]
struct Series {
    wish: Wish,
    /// `None` while the subject has no such channel.
    channel: Option<Channel>,
    difference: Difference,
    samples: VecDeque<(f64, f32)>,
}

impl Plot {
    /// A plot of these channels, of which nothing is known yet.
    pub(crate) fn new(wishes: Vec<Wish>) -> Self {
        let series = wishes.into_iter().map(|wish| Series {
            wish,
            channel: None,
            difference: Difference::default(),
            samples: VecDeque::new(),
        });
        Self {
            series: series.collect(),
        }
    }

    /// Finds the channels of a subject that is new or has changed.
    pub(crate) fn resolve(&mut self, subject: u32, skeleton: &Skeleton) {
        for series in self.series.iter_mut().filter(|series| series.wish.subject == subject) {
            series.channel = Channel::named(&series.wish.channel, skeleton);
        }
    }

    /// Keeps what a frame has of them; `rate` is the samples a second of the source's counter.
    pub(crate) fn take(&mut self, subject: u32, frame: &Frame, rate: Option<f64>) {
        for series in self.series.iter_mut().filter(|series| series.wish.subject == subject) {
            if let Some(sample) = series.sample(frame, rate) {
                series.keep(sample);
            }
        }
    }

    /// Gives away what was kept, of each channel of which there is something: the page's number, times and values.
    pub(crate) fn fetch(&mut self) -> Vec<(u16, Vec<f64>, Vec<f32>)> {
        let filled = self.series.iter_mut().filter(|series| !series.samples.is_empty());
        let fetched = filled.map(|series| {
            let (times, values) = series.samples.drain(..).unzip();
            (series.wish.id, times, values)
        });
        fetched.collect()
    }
}

impl Series {
    /// The time and value that a frame adds: what was sent, else what its poses tell.
    fn sample(&mut self, frame: &Frame, rate: Option<f64>) -> Option<(f64, f32)> {
        let channel = self.channel?;
        let time = frame.time.as_secs_f64();
        let present = channel::present(frame);
        let is_sent = |section| present & channel::bit(section) != 0;
        if is_sent(channel.section()) {
            return Some((time, channel.value(frame)));
        }
        if let Some((of, order)) = differences_of(channel.section()) {
            let value = channel.of(of).value(frame);
            let told = is_sent(of).then(|| self.difference.take(frame, value.into(), rate, order));
            return told.flatten().map(|(time, value)| (time, value as f32));
        }
        let mut whole = frame.clone();
        complete(&mut whole);
        let value = channel.value(&whole);
        (!value.is_nan()).then_some((time, value))
    }

    fn keep(&mut self, sample: (f64, f32)) {
        if self.samples.len() == MOST_SAMPLES {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
    }
}

/// Seconds of the fastest suit.
const MOST_SAMPLES: usize = 4096;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DQuat, DVec3, Subject};
    use std::sync::Arc;
    use std::time::Duration;

    fn plot(channel: &str) -> (Plot, Frame) {
        let wish = Wish {
            id: 1,
            subject: 0,
            channel: channel.to_owned(),
        };
        let frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        let mut plot = Plot::new(vec![wish]);
        plot.resolve(0, &frame.subject.skeleton);
        (plot, frame)
    }

    #[test]
    fn a_page_that_fetches_nothing_costs_bounded_memory_and_keeps_the_newest() {
        let (mut plot, mut frame) = plot("position/Pelvis/z");
        frame.position = vec![Some(DVec3::Z); 23];
        for second in 0..10_000 {
            frame.time = Duration::from_secs(second);
            plot.take(0, &frame, None);
            plot.take(1, &frame, None);
        }
        let (_, times, values) = plot.fetch().remove(0);
        assert_eq!((times.len(), values.len()), (MOST_SAMPLES, MOST_SAMPLES));
        assert!((times[MOST_SAMPLES - 1] - 9999.0).abs() < 1e-9);
        assert!(plot.fetch().is_empty());
    }

    #[test]
    fn velocities_and_angles_that_are_not_sent_are_worked_out() {
        let (mut plot, mut frame) = self::plot("velocity/Head/x");
        for sample in 0..5 {
            frame.sample = sample;
            frame.position = vec![Some(DVec3::X * f64::from(sample) / 100.0); 23];
            plot.take(0, &frame, Some(240.0));
        }
        let (_, _, speeds) = plot.fetch().remove(0);
        assert!(
            speeds.len() == 3 && speeds.iter().all(|speed| (speed - 2.4).abs() < 1e-5),
            "{speeds:?}"
        );

        let (mut plot, mut frame) = self::plot("joint_angles/jRightKnee/z");
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        plot.take(0, &frame, None);
        let (_, _, angles) = plot.fetch().remove(0);
        assert!(angles.len() == 1 && angles[0].abs() < 1e-3);
    }
}
