//! Takes that a page plays itself: their frames and series, as it asks for them.

use crate::channel::{self, Channel};
use crate::scene::{MarkerRecord, Scene, SubjectRecord, TakeRecord};
use crate::{Error, Result, hold, wire};
use posewire_motion::kinematics::{Differences, complete, completed};
use posewire_motion::{Frame, Take};
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

/// Takes that a page plays itself, whole in memory. Clones share them.
///
/// Each take's subject is one of the page's; all of them are on one timeline, by when they were received or by their
/// timecodes where all say. Files that have no moment in common begin together.
#[derive(Clone, Debug, Default)]
pub struct Takes {
    all: Arc<[Take]>,
    files: Arc<[String]>,
    subjects: Arc<[SubjectRecord]>,
    records: Arc<[TakeRecord]>,
    /// Per take and frame the place of the frame whose pose is shown.
    poses: Arc<[Vec<usize>]>,
}

impl Takes {
    /// The most frames of one answer.
    pub const MOST_FRAMES: usize = 600;

    /// Takes, each with the name of its file. Those without a frame are left out.
    pub fn new(takes: impl IntoIterator<Item = (String, Take)>) -> Self {
        let takes = takes.into_iter().filter(|(_, take)| !take.is_empty());
        let (files, takes): (Vec<_>, Vec<_>) = takes.unzip();
        let starts = starts(&files, &takes);
        let poses: Arc<[_]> = takes.iter().map(hold::poses).collect();
        let numbered = (0..).zip(&takes);
        let subjects = numbered.map(|(id, take)| SubjectRecord::new(id, 0, &take.subject, present(take)));
        let each = takes.iter().zip(&files).zip(starts).zip(0..);
        let records = each.map(|(((take, file), start), id)| TakeRecord {
            lost_poses: hold::lost(&poses[id as usize]),
            ..record(id, file, take, start)
        });
        Self {
            subjects: subjects.collect(),
            records: records.collect(),
            files: named_once(&files),
            poses,
            all: takes.into(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The scene as JSON.
    pub(crate) fn scene(&self) -> String {
        let scene = Scene::takes(&self.files, &self.subjects, &self.records);
        serde_json::to_string(&scene).unwrap_or_default()
    }

    /// The records of `count` frames of a take, the first of which has the place `from`; fewer where it ends.
    ///
    /// # Errors
    /// [`Error::NoTake`], [`Error::NoFrame`] and [`Error::TooManyFrames`] for what there is not.
    pub(crate) fn frames(&self, take: u32, from: usize, count: usize) -> Result<Vec<u8>> {
        let found = self.take(take)?;
        if count > Self::MOST_FRAMES {
            return Err(Error::TooManyFrames { found: count });
        }
        if from >= found.len() {
            return Err(Error::NoFrame {
                found: from,
                frames: found.len(),
            });
        }
        let places: Range<usize> = from..from.saturating_add(count).min(found.len());
        let (mut out, mut frame) = (Vec::new(), Frame::new(Arc::clone(&found.subject)));
        for place in places {
            hold::read_whole(found, place, self.poses[take as usize][place], &mut frame);
            wire::write_record(take, &frame, &mut out);
        }
        Ok(out)
    }

    /// A channel of every frame of a take, as a series message of number 0. What the take lacks and its poses tell is
    /// worked out, which takes seconds for a long one.
    ///
    /// # Errors
    /// [`Error::NoTake`] and [`Error::NoChannel`] for what there is not.
    pub(crate) fn series(&self, take: u32, name: &str) -> Result<Vec<u8>> {
        let take = self.take(take)?;
        let missing = || Error::NoChannel { found: name.to_owned() };
        let channel = Channel::named(name, &take.subject.skeleton).ok_or_else(missing)?;
        let values = match take.column(channel.section()) {
            Some(column) => {
                let scaled = |row: &[f64]| {
                    row.get(channel.place())
                        .map_or(f32::NAN, |value| (value * channel.scale()) as f32)
                };
                column.rows().map(scaled).collect()
            }
            None => computed(take, channel).ok_or_else(missing)?,
        };
        let times: Vec<_> = take.times().iter().map(Duration::as_secs_f64).collect();
        Ok(wire::series(0, &times, &values))
    }

    fn take(&self, take: u32) -> Result<&Take> {
        let found = self.all.get(take as usize);
        found.ok_or(Error::NoTake {
            found: take,
            takes: self.all.len(),
        })
    }
}

fn record(id: u32, file: &str, take: &Take, start_s: f64) -> TakeRecord {
    let samples = take.samples();
    let markers = take.events().iter().map(|(frame, name)| MarkerRecord {
        frame: *frame,
        name: name.clone(),
    });
    TakeRecord {
        id,
        subject: id,
        file: file.to_owned(),
        rate_hz: rate(take),
        frames: take.len(),
        first_sample: samples[0],
        start_s,
        duration_s: duration(take),
        gaps: gaps(samples),
        lost_poses: Vec::new(),
        markers: markers.collect(),
        start_timecode: take.timecodes()[0].map(|code| code.to_string()),
    }
}

fn rate(take: &Take) -> f64 {
    if take.rate > 0.0 { take.rate } else { 1.0 }
}

/// How long a take is, s, with its gaps.
fn duration(take: &Take) -> f64 {
    let samples = take.samples();
    let last = samples[samples.len() - 1].saturating_sub(samples[0]);
    (f64::from(last) + 1.0) / rate(take)
}

/// Per gap in the samples: the place of the frame before it, and how many samples it lacks.
fn gaps(samples: &[u32]) -> Vec<(usize, u32)> {
    let steps = samples.windows(2).map(|pair| pair[1].saturating_sub(pair[0]));
    let gaps = steps.enumerate().filter(|(_, step)| *step > 1);
    gaps.map(|(before, step)| (before, step - 1)).collect()
}

/// When each take begins, s after the first of those that it has a moment in common with.
fn starts(files: &[String], takes: &[Take]) -> Vec<f64> {
    let received = |take: &Take| Some(take.frame(0).received?.nanoseconds() as f64 / 1e9);
    let timecode = |take: &Take| Some(f64::from(take.timecodes()[0]?.milliseconds()) / 1e3);
    let known: Option<Vec<_>> = takes.iter().map(received).collect();
    let known = known.or_else(|| takes.iter().map(timecode).collect());
    let Some(known) = known else {
        return vec![0.0; takes.len()];
    };
    let mut all: Vec<Stretch> = Vec::new();
    for ((file, take), start) in files.iter().zip(takes).zip(&known) {
        let stretch = Stretch {
            file,
            from: *start,
            to: start + duration(take),
        };
        match all.iter_mut().find(|other| other.file == file) {
            Some(other) => other.include(&stretch),
            None => all.push(stretch),
        }
    }
    let places = files.iter().zip(known);
    places.map(|(file, start)| start - together(file, &all)).collect()
}

/// From when to when a file was recorded, s.
#[derive(Clone, Copy)]
struct Stretch<'a> {
    file: &'a str,
    from: f64,
    to: f64,
}

impl Stretch<'_> {
    fn include(&mut self, other: &Self) {
        (self.from, self.to) = (self.from.min(other.from), self.to.max(other.to));
    }

    fn meets(&self, other: &Self) -> bool {
        self.from < other.to && other.from < self.to
    }
}

/// When the first of the files began that this one has a moment in common with, through others too.
fn together(file: &str, all: &[Stretch]) -> f64 {
    let Some(mut whole) = all.iter().find(|stretch| stretch.file == file).copied() else {
        return 0.0;
    };
    // Each round reaches at least one more, or is the last.
    for _ in all {
        let met = all.iter().filter(|other| whole.meets(other)).copied();
        whole = met.fold(whole, |mut whole, other| {
            whole.include(&other);
            whole
        });
    }
    whole.from
}

/// The sections of a take, and those that its poses tell.
fn present(take: &Take) -> u32 {
    let sections = take.sections().fold(0, |bits, section| bits | channel::bit(section));
    let beginning = completed(&take.slice(0..take.len().min(BEGINNING)));
    beginning.map_or(sections, |beginning| {
        beginning
            .sections()
            .fold(sections, |bits, section| bits | channel::bit(section))
    })
}

/// A channel of a section that the take lacks, from its poses; `None` when they tell nothing of it.
///
/// It is worked out frame by frame: all sections of a long take at once would not fit into the memory of a small machine.
fn computed(take: &Take, channel: Channel) -> Option<Vec<f32>> {
    let mut differences = Differences::new(take.rate);
    let mut values = Vec::with_capacity(take.len());
    for mut frame in take.frames() {
        complete(&mut frame);
        values.extend(differences.push(frame).map(|frame| channel.value(&frame)));
    }
    values.extend(differences.finish().map(|frame| channel.value(&frame)));
    values.iter().any(|value| !value.is_nan()).then_some(values)
}

/// The files, each once.
fn named_once(files: &[String]) -> Arc<[String]> {
    let mut names: Vec<String> = Vec::new();
    for file in files {
        if !names.contains(file) {
            names.push(file.clone());
        }
    }
    names.into()
}

/// How many frames show what can be computed.
const BEGINNING: usize = 16;
