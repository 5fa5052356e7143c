//! Frames that are not live, sent at the pace of a clock: files and the built-in walker.

use super::control::{Jump, PlaybackControl};
use super::file::TakeFile;
use super::posed;
use super::report::TICK;
use super::schedule::Schedule;
use super::walk::Walkers;
use crate::capture::{Protocol, Selection};
use crate::endpoint;
use crate::pacer::Pacer;
use crate::session::Outlet;
use crate::stop::Stop;
use crate::{Error, Item, Notice, Result};
use posewire_motion::{Frame, Subject};
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
    /// A [`speed`](Self::speed) at which only reading takes time: all that stamps can tell passes in a nanosecond.
    pub const AT_ONCE: f64 = 1e19;

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

    /// Goes on to just before the sample of this number, where that takes no reading; anywhere before it will do.
    fn skip_to(&mut self, sample: u32) {
        let _ = sample;
    }

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
    control: PlaybackControl,
    /// The number of the sample that was read last.
    read: Option<u32>,
}

impl Playback {
    pub(super) fn of_file(path: &Path, options: &PlaybackOptions) -> Result<Self> {
        let take = TakeFile::open(path, options.salvage, options.computes)?;
        Self::new(Box::new(take), options)
    }

    pub(super) fn of_walk(walk: &endpoint::Walk, options: &PlaybackOptions) -> Result<Self> {
        Self::new(Box::new(Walkers::new(walk)), options)
    }

    /// The poses of the one source of a recording that is meant.
    pub(super) fn of_poses(path: &Path, options: &PlaybackOptions) -> Result<Self> {
        let poses = posed::open_one(path, options)?;
        Self::new(Box::new(poses), options)
    }

    /// The poses of each source of a recording that is meant; of all of them if none is named.
    pub(super) fn of_all_poses(path: &Path, options: &PlaybackOptions) -> Result<Vec<Self>> {
        let poses = posed::open_all(path, options)?.into_iter();
        poses.map(|poses| Self::new(Box::new(poses), options)).collect()
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
            control: PlaybackControl::default(),
            read: None,
        })
    }

    pub(super) fn preview(&self) -> &Preview {
        &self.preview
    }

    pub(super) fn control(&self) -> &PlaybackControl {
        &self.control
    }

    pub(super) fn run(mut self, outlet: &mut Outlet, stop: &Stop) -> Result<()> {
        let mut schedule = Schedule::new(self.preview.rate_hz, &self.options, stop)?;
        for subject in &self.preview.subjects {
            outlet.push(Item::Subject(Arc::clone(subject)));
        }
        let mut frames = Vec::new();
        while !stop.is_stopped() {
            frames.clear();
            if let Some(jump) = self.control.take_jump() {
                self.jump(jump, &mut frames, stop)?;
                schedule.begin_anew();
            } else if self.control.holds() {
                if self.hold(&mut schedule, outlet) {
                    continue;
                }
                break;
            } else if !self.next_sample(&mut frames)? {
                if self.begin_again(&mut schedule, outlet)? {
                    continue;
                }
                break;
            }
            if !play(&mut frames, &mut schedule, outlet) {
                break;
            }
        }
        outlet.flush();
        Ok(())
    }

    fn next_sample(&mut self, frames: &mut Vec<Frame>) -> Result<bool> {
        let any = self.frames.next_sample(frames)?;
        self.read = frames.first().map(|frame| frame.sample).or(self.read);
        Ok(any)
    }

    /// Reads on, or anew, to the sample that is jumped to, or to the last one.
    fn jump(&mut self, jump: Jump, frames: &mut Vec<Frame>, stop: &Stop) -> Result<()> {
        let sample = match jump {
            Jump::Start => 0,
            Jump::Sample(sample) => sample,
        };
        if self.read.is_none_or(|read| read >= sample) {
            self.frames.rewind()?;
        }
        self.frames.skip_to(sample);
        let mut next = Vec::new();
        while !stop.is_stopped() && !self.control.wants_jump() && self.next_sample(&mut next)? {
            frames.clear();
            frames.append(&mut next);
            if self.read.is_some_and(|read| read >= sample) {
                break;
            }
        }
        Ok(())
    }

    /// Waits while it is paused; `false` when the playback is over.
    fn hold(&self, schedule: &mut Schedule, outlet: &mut Outlet) -> bool {
        let since = Instant::now();
        while self.control.holds() {
            if schedule.is_past() || !outlet.flush() || schedule.pause(TICK) {
                return false;
            }
        }
        schedule.put_off(since.elapsed());
        true
    }

    /// Goes back to the start if it is to be looped; `false` when the playback is over.
    fn begin_again(&mut self, schedule: &mut Schedule, outlet: &mut Outlet) -> Result<bool> {
        if let Some(problem) = self.frames.damage() {
            let file = self.frames.name();
            outlet.push(Item::Notice(Notice::Damaged { file, problem }));
        }
        if !self.options.looped {
            return Ok(self.control.end());
        }
        let again = schedule.next_round();
        if again {
            self.frames.rewind()?;
        }
        Ok(again)
    }
}

/// Sends the frames of one sample when they are due; `false` when the playback is over.
fn play(frames: &mut Vec<Frame>, schedule: &mut Schedule, outlet: &mut Outlet) -> bool {
    let Some(first) = frames.first() else { return true };
    let Some(offset) = schedule.offset(first) else {
        return true;
    };
    if schedule.ends_before(offset) || !schedule.wait(offset) {
        return false;
    }
    let due = schedule.due(offset);
    for mut frame in frames.drain(..) {
        schedule.carry_on(&mut frame);
        outlet.push(Item::Frame {
            frame: Arc::new(frame),
            due,
        });
    }
    outlet.flush()
}
