//! C3D, the file of biomechanics laboratories: points in `f32`, Intel's byte order.
//!
//! | block of 512 bytes | |
//! |---|---|
//! | 1 | the header |
//! | 2 to n | the parameters: [`parameters`] |
//! | n + 1 to the end | per frame, per point: x, y, z and a residual, 0 where tracked and -1 where not |
//!
//! What the tools need and what the format has no room for in its header is as they write it themselves: `POINT:LABELS2` for
//! more than 255 points, `TRIAL:ACTUAL_END_FIELD` and `POINT:LONG_FRAMES` for more than 65,535 frames, `POINT:ANGLES` to tell
//! angles (degrees) from places, ANALOG with a rate although nothing is in it.

mod parameters;

use super::format::symbol;
use super::grid::grid;
use super::output::Output;
use super::problem::Problem;
use super::tracks::{Track, Values, tracks};
use super::{Job, LeftOut};
use crate::endpoint::FileFormat;
use parameters::{BLOCK, FIRST_BLOCK, KEY, MOST, Parameters};
use posewire_motion::{Section, Space, Take, Up};
use std::io::Write;

/// Writes the landmarks, joint centres, centre of mass and joint angles of a take.
///
/// # Errors
/// When none of them is there, when the take's rate is not above 0, when there are more points than C3D can name, and when
/// `out` fails.
pub(super) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let take = job.take;
    let wanted: Vec<Section> = job.sections().collect();
    let tracks = tracks(take, &wanted);
    if tracks.is_empty() {
        return Err(Problem::lacks(
            FileFormat::C3d,
            "positions, joint angles and the centre of mass",
        ));
    }
    job.rate(FileFormat::C3d)?;
    let file = File {
        take,
        tracks: &tracks,
        space: job.space,
        frames: grid(take),
        // They belong to no section that can be asked for.
        events: if job.options.sections.is_none() {
            take.events()
        } else {
            &[]
        },
    };
    let (parameters, data_block) = file.parameters().finish()?;
    out.write_all(&file.header(data_block))?;
    out.write_all(&parameters)?;
    let values = Values::of(take);
    let mut frame = Vec::with_capacity(tracks.len() * POINT);
    for place in &file.frames {
        frame.clear();
        for track in &tracks {
            file.add_point(&values, track, *place, &mut frame);
        }
        out.write_all(&frame)?;
        job.progress.advance(u64::from(place.is_some()))?;
    }
    out.write_all(&[0; BLOCK][..file.filling()])?;
    Ok(file.left_out(&wanted))
}

struct File<'a> {
    take: &'a Take,
    tracks: &'a [Track],
    space: Space,
    /// For each frame of the file the place of the take's; `None` for a sample that is missing.
    frames: Vec<Option<usize>>,
    events: &'a [(usize, String)],
}

impl File<'_> {
    /// The header's words that have a meaning, counted from 1 as the C3D User Guide does.
    fn header(&self, data_block: u16) -> [u8; BLOCK] {
        let mut header = [0; BLOCK];
        let mut word = |number: usize, bytes: &[u8]| {
            let at = 2 * (number - 1);
            header[at..at + bytes.len()].copy_from_slice(bytes);
        };
        word(1, &[FIRST_BLOCK as u8, KEY]);
        word(2, &(self.tracks.len() as u16).to_le_bytes());
        word(4, &1_u16.to_le_bytes());
        word(5, &self.short_length().to_le_bytes());
        word(7, &FLOATS.to_le_bytes());
        word(9, &data_block.to_le_bytes());
        word(11, &(self.take.rate as f32).to_le_bytes());
        header
    }

    fn parameters(&self) -> Parameters {
        let mut to = Parameters::new();
        self.point(&mut to);
        self.trial(&mut to);
        analog(&mut to, self.take.rate as f32);
        no_force_plates(&mut to);
        self.events(&mut to);
        to.group("SUBJECTS");
        to.word("USED", 1);
        to.word("IS_STATIC", 0);
        to.texts("NAMES", &[&self.take.subject.name]);
        to.texts("LABEL_PREFIXES", &[""]);
        to.group("MANUFACTURER");
        to.text("COMPANY", "posewire");
        to.text("SOFTWARE", "posewire");
        to.text("VERSION_LABEL", env!("CARGO_PKG_VERSION"));
        to
    }

    fn point(&self, to: &mut Parameters) {
        let labels: Vec<_> = self.tracks.iter().map(|track| &track.label).collect();
        let descriptions: Vec<_> = self.tracks.iter().map(|track| &track.description).collect();
        let angles: Vec<_> = self.tracks.iter().filter(|track| track.is_angle()).collect();
        to.group("POINT");
        to.word("USED", self.tracks.len() as u16);
        to.float("SCALE", FLOATS);
        to.float("RATE", self.take.rate as f32);
        to.data_start();
        to.word("FRAMES", self.short_length());
        to.float("LONG_FRAMES", self.frames.len() as f32);
        to.text("UNITS", symbol(self.space.unit));
        to.text("X_SCREEN", "+X");
        to.text("Y_SCREEN", if self.space.up == Up::Y { "+Y" } else { "+Z" });
        to.texts("LABELS", &labels);
        to.texts("DESCRIPTIONS", &descriptions);
        if !angles.is_empty() {
            let labels: Vec<_> = angles.iter().map(|track| &track.label).collect();
            to.texts("ANGLES", &labels);
            to.text("ANGLE_UNITS", "deg");
        }
    }

    /// The first frame and the last in two words each, the low one first.
    fn trial(&self, to: &mut Parameters) {
        let last = self.frames.len() as u32;
        to.group("TRIAL");
        to.words("ACTUAL_START_FIELD", &[1, 0]);
        to.words("ACTUAL_END_FIELD", &[last as u16, (last >> 16) as u16]);
        to.float("CAMERA_RATE", self.take.rate as f32);
    }

    /// Events with their times from the first frame, in minutes and seconds.
    fn events(&self, to: &mut Parameters) {
        let events = &self.events[..self.events.len().min(MOST)];
        let names: Vec<_> = events.iter().map(|(_, name)| name).collect();
        let times: Vec<f32> = events
            .iter()
            .flat_map(|(place, _)| {
                let frame = self.frames.iter().position(|found| *found == Some(*place));
                let seconds = frame.unwrap_or_default() as f64 / self.take.rate;
                [(seconds / 60.0).floor() as f32, (seconds % 60.0) as f32]
            })
            .collect();
        to.group("EVENT");
        to.word("USED", events.len() as u16);
        if !events.is_empty() {
            to.texts("CONTEXTS", &vec!["General"; events.len()]);
            to.texts("LABELS", &names);
            to.texts("SUBJECTS", &vec![&self.take.subject.name; events.len()]);
            to.floats("TIMES", &[2, events.len()], &times);
        }
    }

    fn add_point(&self, values: &Values<'_>, track: &Track, place: Option<usize>, to: &mut Vec<u8>) {
        let (value, residual) = match place.and_then(|place| values.read(track, place)) {
            Some(angles) if track.is_angle() => (angles.to_array(), 0.0),
            Some(position) => (self.space.position_from_canonical(position).to_array(), 0.0),
            None => ([0.0; 3], NOT_TRACKED),
        };
        let [x, y, z] = value.map(|number| number as f32);
        for number in [x, y, z, residual] {
            to.extend_from_slice(&number.to_le_bytes());
        }
    }

    /// Bytes behind the last frame up to a whole block. There are none where the header cannot say how many frames there are:
    /// some readers then go on to the end of the file.
    fn filling(&self) -> usize {
        if self.frames.len() >= usize::from(u16::MAX) {
            return 0;
        }
        let length = self.frames.len() * self.tracks.len() * POINT;
        length.next_multiple_of(BLOCK) - length
    }

    fn left_out(&self, wanted: &[Section]) -> LeftOut {
        let mut left_out = LeftOut::new();
        if wanted.contains(&Section::Position) && self.take.column(Section::Orientation).is_none() {
            left_out.push("landmarks, which need orientations");
        }
        if let Some(more @ 1..) = self.events.len().checked_sub(MOST) {
            left_out.push(format!("the last {more} of {} events", self.events.len()));
        }
        left_out
    }

    /// As many frames as fit into a word without a sign.
    fn short_length(&self) -> u16 {
        u16::try_from(self.frames.len()).unwrap_or(u16::MAX)
    }
}

/// Readers break where the group or its rate is not there.
fn analog(to: &mut Parameters, rate: f32) {
    const NONE: &[&str] = &[];
    to.group("ANALOG");
    to.word("USED", 0);
    to.float("RATE", rate);
    to.float("GEN_SCALE", 1.0);
    to.floats("SCALE", &[0], &[]);
    to.words("OFFSET", &[]);
    to.texts("LABELS", NONE);
    to.texts("DESCRIPTIONS", NONE);
    to.texts("UNITS", NONE);
}

fn no_force_plates(to: &mut Parameters) {
    to.group("FORCE_PLATFORM");
    to.word("USED", 0);
}

/// Bytes of a point of a frame.
const POINT: usize = 16;
/// A scale below 0 says that coordinates are `f32`.
const FLOATS: f32 = -1.0;
/// The residual of a point that was not seen.
const NOT_TRACKED: f32 = -1.0;
