//! The animation: how each segment is turned and shifted against its parent, frame by frame.

use super::super::Job;
use super::buffer::{Buffer, Purpose};
use super::rest::Rest;
use posewire_motion::{Column, DQuat, DVec3, Pose, Section, Take, rotation};
use serde_json::{Value, json};
use std::io;

/// The animation of a take; `None` when it has no motion.
///
/// # Errors
/// When the work is to be stopped.
pub(super) fn animation(job: &Job<'_>, rest: &Rest, buffer: &mut Buffer) -> io::Result<Option<Value>> {
    let columns = Columns::of(job);
    let mut tracks = Tracks::new(job.take);
    let (frames, segments) = (job.take.len() as u64, job.take.subject.skeleton.segments.len());
    for place in 0..segments {
        tracks.add(buffer, place, "rotation", &rotations(job, rest, &columns, place));
        tracks.add(buffer, place, "translation", &translations(job, rest, &columns, place));
        let (before, count) = (place as u64, segments as u64);
        job.progress
            .advance(frames * (before + 1) / count - frames * before / count)?;
    }
    if tracks.channels.is_empty() {
        return Ok(None);
    }
    let mut animation = json!({"channels": tracks.channels, "samplers": tracks.samplers});
    if !job.take.subject.name.is_empty() {
        animation["name"] = json!(job.take.subject.name);
    }
    Ok(Some(animation))
}

/// A value at the place of a frame.
type Key<const N: usize> = (usize, [f32; N]);

/// The columns that the figure follows. One that is not there counts as known and at rest.
struct Columns<'a> {
    position: Option<&'a Column>,
    orientation: Option<&'a Column>,
}

impl<'a> Columns<'a> {
    fn of(job: &Job<'a>) -> Self {
        Self {
            position: job.column(Section::Position),
            orientation: job.column(Section::Orientation),
        }
    }

    fn orientation(&self, frame: usize, segment: usize) -> Option<DQuat> {
        let Some(column) = self.orientation else {
            return Some(DQuat::IDENTITY);
        };
        let turn = column.quaternion(frame, segment)?;
        (turn.is_finite() && turn.length_squared() > 0.0).then(|| turn.normalize())
    }

    fn pose(&self, frame: usize, segment: usize) -> Option<Pose> {
        let position = self
            .position?
            .vector(frame, segment)
            .filter(|position| position.is_finite())?;
        Some(Pose::new(position, self.orientation(frame, segment)?))
    }

    fn position(&self, frame: usize, segment: usize) -> Option<DVec3> {
        self.position?
            .vector(frame, segment)
            .filter(|position| position.is_finite())
    }
}

/// How a segment is turned against its parent, with signs that go on.
fn rotations(job: &Job<'_>, rest: &Rest, columns: &Columns<'_>, place: usize) -> Vec<Key<4>> {
    if columns.orientation.is_none() {
        return Vec::new();
    }
    let mut last = DQuat::IDENTITY;
    let key = |frame| {
        let own = columns.orientation(frame, place)?;
        let local = match rest.parent(place) {
            Some(parent) => columns.orientation(frame, parent)?.conjugate() * own,
            None => own,
        };
        last = rotation::continuous(job.space.orientation_from_canonical(local), last);
        Some((frame, last.as_quat().normalize().to_array()))
    };
    (0..job.take.len()).filter_map(key).collect()
}

/// Where a segment is as seen from its parent.
fn translations(job: &Job<'_>, rest: &Rest, columns: &Columns<'_>, place: usize) -> Vec<Key<3>> {
    let key = |frame| {
        let own = columns.position(frame, place)?;
        let local = match rest.parent(place) {
            Some(parent) => {
                let parent = columns.pose(frame, parent)?;
                parent.orientation.conjugate() * (own - parent.position)
            }
            None => own,
        };
        Some((frame, job.space.position_from_canonical(local).as_vec3().to_array()))
    };
    (0..job.take.len()).filter_map(key).collect()
}

/// Channels and samplers, and the times that they share.
struct Tracks {
    channels: Vec<Value>,
    samplers: Vec<Value>,
    seconds: Vec<f32>,
    /// Which frames each array of times is of, and its accessor.
    times: Vec<(Vec<usize>, usize)>,
}

impl Tracks {
    fn new(take: &Take) -> Self {
        Self {
            channels: Vec::new(),
            samplers: Vec::new(),
            seconds: seconds(take),
            times: Vec::new(),
        }
    }

    fn add<const N: usize>(&mut self, buffer: &mut Buffer, node: usize, path: &str, keys: &[Key<N>]) {
        if keys.is_empty() {
            return;
        }
        let input = self.input(buffer, keys.iter().map(|(frame, _)| *frame).collect());
        let values: Vec<_> = keys.iter().map(|(_, value)| *value).collect();
        let output = buffer.floats(&values, Purpose::Data);
        self.channels
            .push(json!({"sampler": self.samplers.len(), "target": {"node": node, "path": path}}));
        self.samplers
            .push(json!({"input": input, "output": output, "interpolation": "LINEAR"}));
    }

    fn input(&mut self, buffer: &mut Buffer, frames: Vec<usize>) -> usize {
        if let Some((_, accessor)) = self.times.iter().find(|(known, _)| *known == frames) {
            return *accessor;
        }
        let seconds: Vec<_> = frames.iter().map(|frame| [self.seconds[*frame]]).collect();
        let accessor = buffer.bounded(&seconds, Purpose::Data);
        self.times.push((frames, accessor));
        accessor
    }
}

/// The time of each frame from the first: by the samples' numbers, so that one that is missing leaves a gap, where they rise
/// as they should.
fn seconds(take: &Take) -> Vec<f32> {
    let samples = take.samples();
    let rise = samples.is_sorted_by(|before, after| before < after);
    let first = samples.first().copied().unwrap_or_default();
    let ticks = samples
        .iter()
        .zip(0_u32..)
        .map(|(sample, place)| if rise { sample - first } else { place });
    ticks.map(|tick| (f64::from(tick) / take.rate) as f32).collect()
}
