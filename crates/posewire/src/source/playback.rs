//! Frames that are not live, sent at the pace of a clock: files and the built-in walker.

use super::file::TakeFile;
use super::walk::Walkers;
use crate::capture::{Protocol, Selection};
use crate::endpoint;
use crate::pacer::Pacer;
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Error, Item, Notice, Result};
use posewire_motion::{Frame, Subject, Timecode};
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How a file or the walker is played.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaybackOptions {
    /// Samples a second to let through; all of them if absent. The samples keep their numbers.
    pub rate_hz: Option<f64>,
    /// How many times as fast as recorded.
    pub speed: f64,
    /// Whether to begin again at the end. Sample numbers, the clock and the timecode go on.
    pub looped: bool,
    /// Ends after this long by the clock on the wall.
    pub duration: Option<Duration>,
    /// Whether a damaged file is used up to the damage; a capture always is.
    pub salvage: bool,
    /// Whether what a take lacks is computed from its poses: velocities, angles, the centre of mass.
    pub computes: bool,
    /// Of a capture: which source, by its number or a part of its name. It may be left out where there is one.
    pub only: Option<String>,
    /// Of a capture: begin so long after its first datagram.
    pub from: Duration,
    /// Of a capture: end so long after its first datagram.
    pub until: Option<Duration>,
    /// Of a capture of packets: what the UDP datagrams are; told by their content if absent.
    pub protocol: Option<Protocol>,
}

impl Default for PlaybackOptions {
    /// Every sample, once, at the recorded pace, with what can be computed.
    fn default() -> Self {
        Self {
            rate_hz: None,
            speed: 1.0,
            looped: false,
            duration: None,
            salvage: false,
            computes: true,
            only: None,
            from: Duration::ZERO,
            until: None,
            protocol: None,
        }
    }
}

impl PlaybackOptions {
    /// What of a capture is played, of all its sources.
    pub(crate) fn selection(&self) -> Selection {
        Selection {
            source: None,
            from: self.from,
            until: self.until,
            looped: self.looped,
        }
    }
}

/// What is known of a playback before it starts.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Samples a second at which it was captured.
    pub rate_hz: f64,
    /// Whether it says so, and the rate is not assumed.
    pub states_rate: bool,
    /// Who is in it.
    pub subjects: Vec<Arc<Subject>>,
    /// The first sample of each subject.
    pub first: Vec<Frame>,
    /// What it lacks and is worked out from its poses.
    pub computed: Vec<&'static str>,
}

/// Frames in the order of their samples, not yet paced.
pub(super) trait Frames: Send + fmt::Debug {
    /// What to call it.
    fn name(&self) -> String;

    /// Samples a second.
    fn rate_hz(&self) -> f64;

    /// Appends the frames of the next sample, one per subject; `false` at the end.
    fn next_sample(&mut self, frames: &mut Vec<Frame>) -> Result<bool>;

    /// Goes back to the first sample.
    fn rewind(&mut self) -> Result<()>;

    /// Whether the rate is known and not assumed.
    fn states_rate(&self) -> bool {
        true
    }

    /// What was worked out from poses because it is not there, once the first sample has been read.
    fn computed(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// What ended the frames before their end, if something did.
    fn damage(&self) -> Option<String> {
        None
    }
}

/// A file or walker that is opened and not yet playing.
#[derive(Debug)]
pub(super) struct Playback {
    frames: Box<dyn Frames>,
    options: PlaybackOptions,
    preview: Preview,
}

impl Playback {
    pub(super) fn of_file(path: &Path, options: &PlaybackOptions) -> Result<Self> {
        let take = TakeFile::open(path, options.salvage, options.computes)?;
        Self::new(Box::new(take), options)
    }

    pub(super) fn of_walk(walk: &endpoint::Walk, options: &PlaybackOptions) -> Result<Self> {
        Self::new(Box::new(Walkers::new(walk)), options)
    }

    fn new(mut frames: Box<dyn Frames>, options: &PlaybackOptions) -> Result<Self> {
        Pacer::new(Instant::now(), options.speed, Stop::new())?;
        let rate_hz = frames.rate_hz();
        if let Some(found) = options.rate_hz.filter(|rate| !(*rate > 0.0 && *rate <= rate_hz)) {
            return Err(Error::Rate {
                captured: rate_hz.to_string(),
                found: found.to_string(),
            });
        }
        let mut first = Vec::new();
        if !frames.next_sample(&mut first)? {
            return Err(Error::NoFrames { path: frames.name() });
        }
        let (computed, states_rate) = (frames.computed(), frames.states_rate());
        frames.rewind()?;
        let subjects = first.iter().map(|frame| Arc::clone(&frame.subject)).collect();
        Ok(Self {
            frames,
            options: options.clone(),
            preview: Preview {
                rate_hz,
                states_rate,
                subjects,
                first,
                computed,
            },
        })
    }

    pub(super) fn preview(&self) -> &Preview {
        &self.preview
    }

    pub(super) fn run(mut self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        let mut pacer = Pacer::new(Instant::now(), self.options.speed, stop.clone())?;
        for subject in &self.preview.subjects {
            outlet.push(Item::Subject(Arc::clone(subject)));
        }
        let mut timeline = Timeline::new(self.preview.rate_hz);
        let mut frames = Vec::new();
        while !stop.is_stopped() {
            frames.clear();
            if !self.frames.next_sample(&mut frames)? {
                if !self.begin_again(&mut timeline, outlet)? {
                    break;
                }
                continue;
            }
            if !self.play(&mut frames, &mut timeline, &mut pacer, outlet) {
                break;
            }
        }
        outlet.flush();
        Ok(())
    }

    /// Goes back to the start if it is to be looped; `false` when the playback is over.
    fn begin_again(&mut self, timeline: &mut Timeline, outlet: &mut Outlet) -> Result<bool> {
        if let Some(problem) = self.frames.damage() {
            outlet.push(Item::Notice(Notice::Damaged { problem }));
        }
        let again = self.options.looped && timeline.next_round();
        if again {
            self.frames.rewind()?;
        }
        Ok(again)
    }

    /// Sends the frames of one sample when they are due; `false` when the playback is over.
    fn play(&self, frames: &mut Vec<Frame>, timeline: &mut Timeline, pacer: &mut Pacer, outlet: &mut Outlet) -> bool {
        let Some(first) = frames.first() else { return true };
        let place = timeline.place(first);
        if !timeline.keeps(place, self.options.rate_hz) {
            return true;
        }
        let offset = timeline.offset(place);
        if self.is_over(offset, pacer) || !pacer.wait(offset) {
            return false;
        }
        let due = pacer.deadline(offset);
        for mut frame in frames.drain(..) {
            timeline.carry_on(&mut frame);
            outlet.push(Item::Frame {
                frame: Arc::new(frame),
                due,
            });
        }
        outlet.flush()
    }

    /// Whether the sample at `offset` is due after the end. Those due before it are sent even when that is a little late,
    /// but a machine that cannot keep up does not go on for ever.
    fn is_over(&self, offset: Duration, pacer: &Pacer) -> bool {
        let Some(duration) = self.options.duration else {
            return false;
        };
        let late = |start: Instant| start.elapsed() >= duration.saturating_add(GRACE);
        offset.as_secs_f64() / self.options.speed >= duration.as_secs_f64()
            || pacer.deadline(Duration::ZERO).is_some_and(late)
    }
}

/// Where a sample stands on the clock, over all rounds of a loop.
#[derive(Debug)]
struct Timeline {
    rate_hz: f64,
    first_sample: Option<u32>,
    /// Samples of the rounds before this one.
    past_samples: u64,
    /// The furthest place of this round.
    last_place: u64,
}

impl Timeline {
    fn new(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            first_sample: None,
            past_samples: 0,
            last_place: 0,
        }
    }

    /// How many samples after the playback's start this one is; one from before the first of its take is due with it.
    fn place(&mut self, frame: &Frame) -> u64 {
        let first = *self.first_sample.get_or_insert(frame.sample);
        let ahead = frame.sample.wrapping_sub(first) as i32;
        let place = self.past_samples + u64::from(ahead.max(0).unsigned_abs());
        self.last_place = self.last_place.max(place);
        place
    }

    /// Whether a stream of `rate_hz` has this sample: the first one at or after each of its own instants.
    fn keeps(&self, place: u64, rate_hz: Option<f64>) -> bool {
        let Some(rate_hz) = rate_hz else { return true };
        let instant = |place: u64| (place as f64 * rate_hz / self.rate_hz + ROUNDING).floor();
        place == 0 || instant(place) > instant(place - 1)
    }

    fn offset(&self, place: u64) -> Duration {
        Duration::from_secs_f64(place as f64 / self.rate_hz)
    }

    /// Numbers a frame of a later round on from the last round.
    fn carry_on(&self, frame: &mut Frame) {
        frame.sample = frame.sample.wrapping_add(self.past_samples as u32);
        let past = self.offset(self.past_samples);
        frame.time += past;
        let later = |code: Timecode| u64::from(code.milliseconds()).saturating_add(past.as_millis() as u64);
        frame.timecode = frame.timecode.map(|code| Timecode::from_milliseconds(later(code)));
    }

    /// Begins a new round; `false` when the last one had no sample.
    fn next_round(&mut self) -> bool {
        let any = self.first_sample.is_some() && self.last_place >= self.past_samples;
        self.past_samples = self.last_place + 1;
        any
    }
}

/// How much later than asked a playback may end to send what was due before.
const GRACE: Duration = Duration::from_secs(1);
/// Keeps 30 of 60 from missing a sample because of the last bit of a division.
const ROUNDING: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::Skeleton;

    fn kept(captured_hz: f64, rate_hz: f64, samples: u64) -> Vec<u64> {
        let timeline = Timeline::new(captured_hz);
        (0..samples)
            .filter(|place| timeline.keeps(*place, Some(rate_hz)))
            .collect()
    }

    #[test]
    fn a_quarter_of_the_rate_keeps_every_fourth_sample() {
        assert_eq!(kept(240.0, 60.0, 13), [0, 4, 8, 12]);
        assert_eq!(kept(240.0, 240.0, 3), [0, 1, 2]);
    }

    #[test]
    fn an_uneven_rate_is_kept_on_average() {
        assert_eq!(kept(60.0, 25.0, 13), [0, 3, 5, 8, 10, 12]);
        assert_eq!(kept(60.0, 25.0, 6000).len(), 2500);
    }

    #[test]
    fn a_second_round_goes_on_counting() {
        let mut timeline = Timeline::new(60.0);
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        for (sample, place) in [(7, 0), (8, 1), (10, 3)] {
            frame.sample = sample;
            assert_eq!(timeline.place(&frame), place);
        }
        assert!(timeline.next_round());
        frame.sample = 7;
        assert_eq!(timeline.place(&frame), 4);
        timeline.carry_on(&mut frame);
        assert_eq!(frame.sample, 11);
        assert_eq!(timeline.offset(60), Duration::from_secs(1));
    }

    #[test]
    fn a_take_out_of_order_is_not_waited_for() {
        let mut timeline = Timeline::new(60.0);
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        for (sample, place) in [(5, 0), (6, 1), (2, 0), (3, 0), (7, 2), (6, 1)] {
            frame.sample = sample;
            assert_eq!(timeline.place(&frame), place);
        }
        assert!(timeline.next_round());
        frame.sample = 5;
        assert_eq!(
            timeline.place(&frame),
            3,
            "the next round begins after the furthest sample"
        );
    }
}
