//! Numbers and names as arguments.

use crate::error::exception;
use pyo3::Borrowed;
use pyo3::exceptions::{PyOverflowError, PyTypeError};
use pyo3::prelude::*;
use std::fmt::{self, Display};
use std::ops::RangeInclusive;

/// An integer that Python gave, before it is known whether it is one that will do.
///
/// An argument of an integer type of Rust raises Python's OverflowError where the number does not fit. One of this type
/// takes any integer, and only what is none is a TypeError; `within` says which numbers there are.
///
/// Python sees a default of this type as `...`: the signature is then told with `text_signature`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Whole(Option<i64>);

impl Whole {
    /// The default of an argument.
    pub(crate) const fn of(number: i64) -> Self {
        Self(Some(number))
    }

    /// The number, where it is in the range; a UsageError that names the argument where it is not.
    pub(crate) fn within<T>(self, argument: &str, range: RangeInclusive<T>) -> PyResult<T>
    where
        T: TryFrom<i64> + PartialOrd + Display,
    {
        let number = self.0.and_then(|number| T::try_from(number).ok());
        number.filter(|number| range.contains(number)).ok_or_else(|| {
            let (first, last) = range.into_inner();
            let message = format!("expected a whole number from {first} to {last} as {argument}, found {self}");
            exception("UsageError", message, None)
        })
    }
}

impl<'py> FromPyObject<'_, 'py> for Whole {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<i64>() {
            Ok(number) => Ok(Self(Some(number))),
            Err(error) if error.is_instance_of::<PyOverflowError>(given.py()) => Ok(Self(None)),
            Err(error) => Err(error),
        }
    }
}

/// A number as people read it: with an exponent where it is very large or very small.
pub(crate) fn shown(number: f64) -> String {
    match number.abs() {
        size if size.is_finite() && size != 0.0 && !(1e-5..1e16).contains(&size) => format!("{number:e}"),
        _ => number.to_string(),
    }
}

/// A list of names that Python gave. A lone text is none, though it is a sequence of texts to Python.
pub(crate) struct Names(pub(crate) Vec<String>);

impl<'py> FromPyObject<'_, 'py> for Names {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        given.extract().map(Self).map_err(|_| {
            let found = given.repr().map(|repr| repr.to_string()).unwrap_or_default();
            PyTypeError::new_err(format!("expected a list of names, found {found}"))
        })
    }
}

impl Display for Whole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(number) => number.fmt(f),
            None => f.write_str("one of more than 64 bits"),
        }
    }
}
