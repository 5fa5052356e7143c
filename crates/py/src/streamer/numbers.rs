//! What Python gives as numbers, checked entry by entry.

use crate::error::usage;
use crate::number::shown;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use posewire_motion::{Section, Skeleton};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

/// The numbers of a section, those of an entry side by side, all NaN where it is not tracked.
pub(super) fn checked(skeleton: &Skeleton, section: Section, numbers: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = array(skeleton, section, numbers)?;
    let mut numbers: Vec<_> = array.try_readonly()?.as_array().iter().copied().collect();
    for (place, entry) in numbers.chunks_exact_mut(section.components()).enumerate() {
        if is_tracked(skeleton, section, place, entry)? && entry.len() == 4 {
            normalize(skeleton, section, place, entry)?;
        }
    }
    Ok(numbers)
}

/// Whether an entry is tracked: then all its numbers fit the wire, else all are NaN.
fn is_tracked(skeleton: &Skeleton, section: Section, place: usize, entry: &[f64]) -> PyResult<bool> {
    if entry.iter().all(|number| number.is_nan()) {
        return Ok(false);
    }
    // The wires have 32 bits.
    let fits = |number: &f64| number.abs() <= f64::from(f32::MAX);
    if entry.iter().all(fits) {
        return Ok(true);
    }
    let what = of_whom(skeleton, section, place);
    let found = listed(entry);
    Err(if entry.iter().any(|number| number.is_nan()) {
        usage(
            format!("expected numbers or nothing but NaN as {what}, found {found}"),
            "NaN throughout says that it is not tracked",
        )
    } else {
        usage(
            format!("expected numbers below 3.4e38, which 32 bits can hold, as {what}, found {found}"),
            "what is not known is NaN",
        )
    })
}

/// Makes a quaternion one of length 1, where it nearly is.
fn normalize(skeleton: &Skeleton, section: Section, place: usize, quaternion: &mut [f64]) -> PyResult<()> {
    let length = quaternion.iter().map(|number| number * number).sum::<f64>().sqrt();
    match (length - 1.0).abs() {
        // As exact as 32 bits can have it: what was received goes out unchanged.
        off if off <= EXACT => {}
        off if off <= NEARLY => quaternion.iter_mut().for_each(|number| *number /= length),
        _ => {
            let (what, found) = (of_whom(skeleton, section, place), listed(quaternion));
            return Err(usage(
                format!(
                    "expected a quaternion of length 1 as {what}, found {found} of length {}",
                    in_short(length)
                ),
                "divide it by its length, w first; what is not tracked is NaN",
            ));
        }
    }
    Ok(())
}

/// `the orientation of Head`
fn of_whom(skeleton: &Skeleton, section: Section, place: usize) -> String {
    let label = section.labels(skeleton).nth(place).unwrap_or_default();
    match section.per() {
        posewire_motion::Per::Body => format!("the {section}"),
        _ => format!("the {section} of {label}"),
    }
}

fn in_short(length: f64) -> String {
    if length < 1e6 {
        format!("{length:.4}")
    } else {
        shown(length)
    }
}

fn listed(row: &[f64]) -> String {
    let numbers: Vec<_> = row.iter().copied().map(shown).collect();
    format!("[{}]", numbers.join(", ")).replace("NaN", "nan")
}

/// Anything that numpy makes an array of numbers of, in the shape of the section; where it has one entry, that alone will do.
fn array<'py>(
    skeleton: &Skeleton,
    section: Section,
    numbers: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let array = floats(section, numbers)?;
    let (entries, components) = (section.entries(skeleton), section.components());
    let shape = array.shape();
    if shape == [entries, components] || entries == 1 && shape == [components] {
        return Ok(array);
    }
    let found = array.getattr("shape")?;
    Err(usage(
        format!("expected an array of ({entries}, {components}) as {section}, found one of {found}"),
        "streamer.skeleton says which entries there are",
    ))
}

fn floats<'py>(section: Section, numbers: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = numbers.py();
    let numpy = py.import("numpy")?;
    if numbers.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
        return Err(usage(
            format!("expected an array without a mask as {section}, found a masked one"),
            "fill in what is not tracked: array.filled(numpy.nan)",
        ));
    }
    if let Ok(array) = numbers.cast::<PyArrayDyn<f64>>() {
        return Ok(array.clone());
    }
    let array = numpy.call_method1("asarray", (numbers,));
    let array = array.map_err(|error| no_array(py, section, error))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        let dtype = array.getattr("dtype")?;
        return Err(usage(
            format!("expected numbers as {section}, found an array of {dtype}"),
            "floats and integers of any size will do; what is not tracked is NaN",
        ));
    }
    let array = array.call_method1("astype", ("float64",))?;
    Ok(array.cast::<PyArrayDyn<f64>>()?.clone())
}

/// For what numpy makes no array of, as rows of different lengths.
fn no_array(py: Python<'_>, section: Section, error: PyErr) -> PyErr {
    if !error.is_instance_of::<PyException>(py) {
        return error;
    }
    usage(
        format!("expected an array of numbers as {section}: {}", error.value(py)),
        "numpy.asarray must be able to make one of it",
    )
}

/// Quaternions that differ from length 1 by no more are sent as they are.
const EXACT: f64 = 1e-6;
/// Those that differ by no more are made so long; others are mistakes.
const NEARLY: f64 = 1e-3;
