//! NPZ: an array of `NumPy` for each section, and what they need to be understood.
//!
//! | array | type and shape | |
//! |---|---|---|
//! | `position`, `joint_angles` and every other [`Section`] | `f64`, frames x entries x components | NaN where not tracked; angles in rad, quaternions w, x, y, z |
//! | `sample`, `time` | `u32` and `f64`, frames | the source's number and clock, s |
//! | `timecode` | `timedelta64[ms]`, frames | since midnight, UTC; not there when no frame has it |
//! | `contacts` | `i8`, frames x contacts | 1 touches, 0 does not, -1 not told; not there when no frame has them |
//! | `event_frame`, `event_name` | `i64` and text, events | the place of the frame, from 0; not there without events |
//! | `subject`, `rate`, `axes`, `unit` | one value | samples a second; `z-up` and `m` unless asked otherwise |
//! | `segment_names`, `joint_names`, `ergonomic_angle_names`, `sensor_names`, `contact_names` | text | what the entries are, in order |
//! | `segment_parent`, `segment_origin` | `i32` and `f64`, segments (x 3) | -1 for none; in the null pose, NaN where not known |
//!
//! Nothing in it needs `allow_pickle`. Arrays are stored as they are, which is what `numpy.savez` does.

mod archive;
mod container;

use super::format::symbol;
use super::output::Output;
use super::problem::Problem;
use super::{Axes, Job, LeftOut};
use archive::Archive;
use posewire_motion::{Column, Section};
use std::io;

/// Writes the sections asked for, and times, names and the skeleton in any case.
///
/// # Errors
/// When `out` fails.
pub(super) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let mut archive = Archive::new(out);
    write_arrays(job, &mut archive)?;
    archive.finish()?;
    Ok(LeftOut::new())
}

fn write_arrays(job: &Job<'_>, archive: &mut Archive<'_, '_>) -> io::Result<()> {
    let columns: Vec<_> = job.sections().filter_map(|section| job.take.column(section)).collect();
    let frames = job.take.len() as u64;
    for (number, column) in (0..).zip(&columns) {
        write_column(job, archive, column)?;
        let count = columns.len() as u64;
        job.progress
            .advance(frames * (number + 1) / count - frames * number / count)?;
    }
    write_times(job, archive)?;
    if job.options.sections.is_none() {
        write_contacts(job, archive)?;
        write_events(job, archive)?;
    }
    write_names(job, archive)?;
    write_skeleton(job, archive)
}

fn write_column(job: &Job<'_>, archive: &mut Archive<'_, '_>, column: &Column) -> io::Result<()> {
    archive.begin(column.section().name(), "<f8", &column.shape(), 8)?;
    let mut row = Vec::new();
    for frame in 0..job.take.len() {
        job.read_row(column, frame, &mut row);
        archive.values(row.iter().map(|number| number.to_le_bytes()))?;
        job.progress.advance(0)?;
    }
    Ok(())
}

fn write_times(job: &Job<'_>, archive: &mut Archive<'_, '_>) -> io::Result<()> {
    let take = job.take;
    let frames = [take.len()];
    archive.array(
        "sample",
        "<u4",
        &frames,
        take.samples().iter().map(|sample| sample.to_le_bytes()),
    )?;
    let times = take.seconds().map(f64::to_le_bytes);
    archive.array("time", "<f8", &frames, times)?;
    if take.timecodes().iter().all(Option::is_none) {
        return Ok(());
    }
    let timecodes = take.timecodes().iter().map(|timecode| {
        let milliseconds = timecode.map_or(NOT_A_TIME, |timecode| i64::from(timecode.milliseconds()));
        milliseconds.to_le_bytes()
    });
    archive.array("timecode", "<m8[ms]", &frames, timecodes)
}

fn write_contacts(job: &Job<'_>, archive: &mut Archive<'_, '_>) -> io::Result<()> {
    let take = job.take;
    let Some(width) = (0..take.len())
        .map(|frame| take.contacts(frame).len())
        .find(|width| *width > 0)
    else {
        return Ok(());
    };
    let names = &take.subject.skeleton.contacts;
    archive.texts("contact_names", names.iter().map(String::as_str))?;
    archive.begin("contacts", "|i1", &[take.len(), width], 1)?;
    for frame in 0..take.len() {
        let touches = take.contacts(frame);
        archive
            .values((0..width).map(|contact| touches.get(contact).map_or(-1, |yes| i8::from(*yes)).to_le_bytes()))?;
    }
    Ok(())
}

fn write_events(job: &Job<'_>, archive: &mut Archive<'_, '_>) -> io::Result<()> {
    let events = job.take.events();
    if events.is_empty() {
        return Ok(());
    }
    let frames = events.iter().map(|(frame, _)| (*frame as i64).to_le_bytes());
    archive.array("event_frame", "<i8", &[events.len()], frames)?;
    archive.texts("event_name", events.iter().map(|(_, name)| name.as_str()))
}

fn write_names(job: &Job<'_>, archive: &mut Archive<'_, '_>) -> io::Result<()> {
    let subject = &job.take.subject;
    archive.text("subject", &subject.name)?;
    archive.array("rate", "<f8", &[], [job.take.rate.to_le_bytes()].into_iter())?;
    archive.text("axes", Axes::of(job.space).map_or("", Axes::name))?;
    archive.text("unit", symbol(job.space.unit))?;
    for (name, section) in NAMED {
        archive.texts(name, section.labels(&subject.skeleton))?;
    }
    Ok(())
}

fn write_skeleton(job: &Job<'_>, archive: &mut Archive<'_, '_>) -> io::Result<()> {
    let segments = &job.take.subject.skeleton.segments;
    let parents = segments.iter().map(|segment| {
        let parent = segment.parent.and_then(|parent| i32::try_from(parent).ok());
        parent.unwrap_or(-1).to_le_bytes()
    });
    archive.array("segment_parent", "<i4", &[segments.len()], parents)?;
    let origins = segments.iter().flat_map(|segment| {
        let origin = segment
            .origin
            .map(|origin| job.space.position_from_canonical(origin).to_array());
        origin.unwrap_or([f64::NAN; 3]).map(f64::to_le_bytes)
    });
    archive.array("segment_origin", "<f8", &[segments.len(), 3], origins)
}

/// Arrays of names, each with a section that has entries of that kind.
const NAMED: [(&str, Section); 4] = [
    ("segment_names", Section::Position),
    ("joint_names", Section::JointAngles),
    ("ergonomic_angle_names", Section::ErgonomicAngles),
    ("sensor_names", Section::SensorOrientation),
];
/// What `NumPy` takes for no time.
const NOT_A_TIME: i64 = i64::MIN;
