//! Errors as Python exceptions. Their classes are written in Python, in `posewire/_errors.py`.

use posewire::Error;
use pyo3::prelude::*;

/// The exception for a failure of the engine: what the command line says after `error:`, and its help.
pub(crate) fn raised(error: &Error) -> PyErr {
    exception(class_of(error), error.to_string(), error.help().map(in_python))
}

/// A help whose options are spelled as Python's arguments.
fn in_python(help: String) -> String {
    let options = [
        ("--salvage", "salvage=True"),
        ("--overwrite", "overwrite=True"),
        ("--only 0", "only=\"0\""),
        // It takes where to send to by place.
        ("--to ", ""),
    ];
    options
        .into_iter()
        .fold(help, |help, (option, argument)| help.replace(option, argument))
}

/// For what the command line calls a wrong argument.
pub(crate) fn usage(message: impl Into<String>, help: impl Into<String>) -> PyErr {
    exception("UsageError", message.into(), Some(help.into()))
}

/// An exception of a class of the package, with its text and what to do about it.
pub(crate) fn exception(class: &str, message: String, help: Option<String>) -> PyErr {
    Python::attach(|py| match make(py, class, message, help) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    })
}

fn make<'py>(py: Python<'py>, class: &str, message: String, help: Option<String>) -> PyResult<Bound<'py, PyAny>> {
    py.import("posewire._errors")?.getattr(class)?.call1((message, help))
}

fn class_of(error: &Error) -> &'static str {
    match error {
        Error::Read { .. }
        | Error::Take { .. }
        | Error::NoFrames { .. }
        | Error::NotACapture { .. }
        | Error::NoDatagrams { .. }
        | Error::MissingPart { .. }
        | Error::NotMcap { .. }
        | Error::Compressed { .. } => "ReadError",
        Error::NoSection { .. } => "MissingError",
        Error::Write { .. } | Error::Exists { .. } | Error::Lacks { .. } | Error::Fixed { .. } => "WriteError",
        Error::Resolve { .. }
        | Error::SeveralServers { .. }
        | Error::Interface { .. }
        | Error::Socket { .. }
        | Error::Stalled { .. } => "NetworkError",
        error if error.is_usage() => "UsageError",
        _ => "Error",
    }
}
