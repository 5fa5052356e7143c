//! The numbers that a page plots live: every sample of a few channels, until they are fetched.

use crate::channel::Channel;
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
    samples: VecDeque<(f64, f32)>,
}

impl Plot {
    /// A plot of these channels, of which nothing is known yet.
    pub(crate) fn new(wishes: Vec<Wish>) -> Self {
        let series = wishes.into_iter().map(|wish| Series {
            wish,
            channel: None,
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

    /// Keeps what a frame has of them.
    pub(crate) fn take(&mut self, subject: u32, frame: &Frame) {
        for series in self.series.iter_mut().filter(|series| series.wish.subject == subject) {
            let Some(channel) = series.channel else { continue };
            if series.samples.len() == MOST_SAMPLES {
                series.samples.pop_front();
            }
            let value = channel.value(frame);
            series.samples.push_back((frame.time.as_secs_f64(), value));
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

/// Seconds of the fastest suit.
const MOST_SAMPLES: usize = 4096;
