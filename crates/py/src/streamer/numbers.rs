//! What Python gives as numbers, checked entry by entry.

use crate::error::usage;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use posewire_motion::{DQuat, DVec3, Section, Skeleton};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

/// The vectors of a section, `None` where one is NaN.
pub(super) fn vectors(
    skeleton: &Skeleton,
    section: Section,
    numbers: &Bound<'_, PyAny>,
) -> PyResult<Vec<Option<DVec3>>> {
    let array = array(skeleton, section, numbers)?;
    let entries = rows::<3>(&array)?.into_iter().enumerate();
    let vector = |(place, row)| Ok(tracked(skeleton, section, place, row)?.map(DVec3::from_array));
    entries.map(vector).collect()
}

/// The rotations of a section, `None` where one is NaN.
pub(super) fn quaternions(
    skeleton: &Skeleton,
    section: Section,
    numbers: &Bound<'_, PyAny>,
) -> PyResult<Vec<Option<DQuat>>> {
    let array = array(skeleton, section, numbers)?;
    let entries = rows::<4>(&array)?.into_iter().enumerate();
    let rotation = |(place, row)| match tracked(skeleton, section, place, row)? {
        Some(row) => rotation(skeleton, section, place, row).map(Some),
        None => Ok(None),
    };
    entries.map(rotation).collect()
}

/// The row of an entry, `None` where it is NaN throughout.
fn tracked<const N: usize>(
    skeleton: &Skeleton,
    section: Section,
    place: usize,
    row: [f64; N],
) -> PyResult<Option<[f64; N]>> {
    if row.iter().all(|number| number.is_nan()) {
        return Ok(None);
    }
    // The wires have 32 bits.
    let fits = |number: &f64| number.abs() <= f64::from(f32::MAX);
    if row.iter().all(fits) {
        return Ok(Some(row));
    }
    let what = of_whom(skeleton, section, place);
    let found = listed(&row);
    Err(if row.iter().any(|number| number.is_nan()) {
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

fn rotation(skeleton: &Skeleton, section: Section, place: usize, row: [f64; 4]) -> PyResult<DQuat> {
    let [w, x, y, z] = row;
    let rotation = DQuat::from_xyzw(x, y, z, w);
    let length = rotation.length();
    match (length - 1.0).abs() {
        // As exact as 32 bits can have it: what was received goes out unchanged.
        off if off <= EXACT => Ok(rotation),
        off if off <= NEARLY => Ok(rotation / length),
        _ => {
            let (what, found) = (of_whom(skeleton, section, place), listed(&row));
            Err(usage(
                format!("expected a quaternion of length 1 as {what}, found {found} of length {length:.4}"),
                "divide it by its length, w first; what is not tracked is NaN",
            ))
        }
    }
}

/// `the orientation of Head`
fn of_whom(skeleton: &Skeleton, section: Section, place: usize) -> String {
    let label = section.labels(skeleton).nth(place).unwrap_or_default();
    match section.per() {
        posewire_motion::Per::Body => format!("the {section}"),
        _ => format!("the {section} of {label}"),
    }
}

fn listed(row: &[f64]) -> String {
    let numbers: Vec<_> = row.iter().map(ToString::to_string).collect();
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

fn rows<const N: usize>(array: &Bound<'_, PyArrayDyn<f64>>) -> PyResult<Vec<[f64; N]>> {
    let array = array.try_readonly()?;
    let numbers: Vec<_> = array.as_array().iter().copied().collect();
    Ok(numbers.as_chunks().0.to_vec())
}

/// Quaternions that differ from length 1 by no more are sent as they are.
const EXACT: f64 = 1e-6;
/// Those that differ by no more are made so long; others are mistakes.
const NEARLY: f64 = 1e-3;
