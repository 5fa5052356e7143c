//! From arrays of numpy to a frame.

use super::carrying::Carrying;
use super::numbers::checked;
use crate::error::usage;
use crate::section::named;
use posewire_motion::{Frame, Section, Timecode};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::time::Duration;

/// A section, and what Python gives as its numbers.
type Given<'py> = (Section, Bound<'py, PyAny>);

/// What a sample is given: poses by their places, other sections by their names. They stand in the order of [`Section::ALL`], in
/// which one follows what it needs.
pub(super) fn given<'py>(
    position: Option<&Bound<'py, PyAny>>,
    orientation: Option<&Bound<'py, PyAny>>,
    sections: Option<&Bound<'py, PyDict>>,
) -> PyResult<Vec<Given<'py>>> {
    let poses = [(Section::Position, position), (Section::Orientation, orientation)];
    let poses = poses.map(|(section, numbers)| Some((section, numbers?.clone())));
    let named = sections.into_iter().flatten().map(named_section);
    let mut given = poses
        .into_iter()
        .flatten()
        .map(Ok)
        .chain(named)
        .collect::<PyResult<Vec<_>>>()?;
    given.sort_by_key(|(section, _)| *section);
    if given.is_empty() {
        return Err(usage(
            "expected something to send, found nothing",
            "give position and orientation, or sections by their names: joint_angles=",
        ));
    }
    Ok(given)
}

fn named_section<'py>((name, numbers): (Bound<'py, PyAny>, Bound<'py, PyAny>)) -> PyResult<Given<'py>> {
    let name = name.extract::<String>()?;
    if UNSENDABLE.contains(&name.as_str()) {
        return Err(usage(
            format!("{name} cannot be sent: neither MXTP nor NatNet has a place for them"),
            "leave them out; files hold them",
        ));
    }
    Ok((named(&[name])?[0], numbers))
}

/// Gives a frame these numbers, each of which goes out to some target.
pub(super) fn fill(frame: &mut Frame, carrying: Carrying, given: Vec<Given<'_>>) -> PyResult<()> {
    for (section, numbers) in &given {
        set(frame, *section, numbers)?;
    }
    let sections: Vec<_> = given.into_iter().map(|(section, _)| section).collect();
    carrying.check(frame, &sections)
}

fn set(frame: &mut Frame, section: Section, numbers: &Bound<'_, PyAny>) -> PyResult<()> {
    let numbers = checked(&frame.subject.skeleton, section, numbers)?;
    let follows = matches!(
        section,
        Section::CenterOfMassVelocity | Section::CenterOfMassAcceleration
    );
    if follows && frame.center_of_mass.is_none() && !numbers[0].is_nan() {
        return Err(usage(
            format!("expected the position of the centre of mass beside {section}, found none"),
            "give center_of_mass= as well",
        ));
    }
    frame.set_entries(section, &numbers);
    Ok(())
}

/// The program's clock.
pub(super) fn clock(seconds: f64, carrying: Carrying) -> PyResult<Duration> {
    let wrong = |expected: &str, help: &str| usage(format!("expected {expected} as the time, found {seconds}"), help);
    let time = Duration::try_from_secs_f64(seconds)
        .map_err(|_| wrong("seconds from 0 on", "leave it out to go by the rate"))?;
    if carrying.mxtp.is_some() && time.as_millis() > u32::MAX.into() {
        return Err(wrong(
            "at most 4294967.295 seconds, which MXTP's clock can tell,",
            "count from the beginning of the stream; timecode= is for the time of day",
        ));
    }
    Ok(time)
}

/// A time of day that goes out.
pub(super) fn time_of_day(seconds: f64, carrying: Carrying) -> PyResult<Timecode> {
    if !(0.0..86_400.0).contains(&seconds) {
        return Err(usage(
            format!("expected seconds from 0 to 86400 as the timecode, found {seconds}"),
            "they are counted from midnight, UTC: time.time() % 86400",
        ));
    }
    carrying.check_timecode()?;
    Ok(Timecode::from_milliseconds((seconds * 1000.0).round() as u64))
}

/// What a frame of a file can have besides sections, and no protocol carries.
const UNSENDABLE: [&str; 2] = ["contacts", "events"];
