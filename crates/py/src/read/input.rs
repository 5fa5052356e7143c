//! What is to be read, and the arguments that fit it.

use crate::error::{exception, raised, usage};
use crate::number::Whole;
use posewire::Error;
use posewire::endpoint::{Endpoint, FileFormat, Walk};
use posewire::file::ReadOptions;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::fs::FileType;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A path as `open()` takes it: text, bytes or an `os.PathLike`, by `os.fsdecode`. It need not be UTF-8.
pub(crate) struct FilePath(pub(crate) PathBuf);

impl FromPyObject<'_, '_> for FilePath {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let decoded = object.py().import("os")?.call_method1("fsdecode", (object,));
        let decoded = decoded.map_err(|error| PyTypeError::new_err(error.value(object.py()).to_string()))?;
        Ok(Self(decoded.extract::<OsString>()?.into()))
    }
}

/// The number of a source, or a part of its name.
pub(crate) struct SourceName(String);

impl FromPyObject<'_, '_> for SourceName {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        if let Ok(number) = object.extract::<Whole>() {
            return Ok(Self(number.to_string()));
        }
        let name = object.extract::<String>();
        name.map(Self)
            .map_err(|_| PyTypeError::new_err("expected the number of a source or a part of its name"))
    }
}

/// How it is read, as keyword arguments say.
pub(super) struct Options {
    pub(super) salvage: bool,
    pub(super) only: Option<String>,
    duration: Option<f64>,
    threads: Option<usize>,
}

impl Options {
    /// As Python gave them.
    pub(super) fn new(
        salvage: bool,
        only: Option<SourceName>,
        duration: Option<f64>,
        threads: Option<Whole>,
    ) -> PyResult<Self> {
        let threads = threads.map(|threads| threads.within("threads", 0..=MOST_THREADS));
        Ok(Self {
            salvage,
            only: only.map(|only| only.0),
            duration,
            threads: threads.transpose()?,
        })
    }

    /// How MVNX is read.
    pub(super) fn reading(&self) -> ReadOptions {
        ReadOptions {
            salvage: self.salvage,
            threads: self.threads,
        }
    }
}

/// What a path is.
pub(super) enum Input {
    Mvnx,
    Capture(Endpoint),
    Walk(Walk, Duration),
}

impl Input {
    /// As the command line has it: what a file holds counts more than its name, and one that is not there is said to be missing.
    pub(super) fn of(path: &Path, options: &Options) -> PyResult<Self> {
        // What is not UTF-8 names no scheme, and its ending is told all the same.
        let text = path.to_string_lossy();
        let input = match text.parse() {
            _ if text.is_empty() => Err(usage(
                "expected the path of a file, found \"\"",
                "as in read(\"walk.mvnx\")",
            )),
            Ok(Endpoint::Synthetic(walk)) => walk_duration(&text, options.duration).map(|time| Self::Walk(walk, time)),
            Ok(Endpoint::Capture { .. }) => {
                of_file(path).map(|()| Self::Capture(Endpoint::Capture { path: path.into() }))
            }
            Ok(Endpoint::File { format, .. }) => of_readable(path, format),
            Err(Error::UnknownFormat { .. }) => of_file(path).map(|()| Self::Mvnx),
            Ok(endpoint) => Err(usage(
                format!("expected a file, found {endpoint}"),
                format!("posewire.listen(\"{endpoint}\") gives what comes from there"),
            )),
            Err(error) => Err(raised(&error)),
        }?;
        input.check(&text, options)?;
        Ok(input)
    }

    /// Refuses arguments that nothing would come of.
    fn check(&self, text: &str, options: &Options) -> PyResult<()> {
        let (is_mvnx, is_walk) = (matches!(self, Self::Mvnx), matches!(self, Self::Walk(..)));
        let is_capture = matches!(self, Self::Capture(_));
        let cut = "leave it out; arrays are cut as take.position[first:last], files by write(first=, last=)";
        let ignored = [
            ("salvage", options.salvage && is_walk, "files", "leave it out"),
            ("threads", options.threads.is_some() && !is_mvnx, "MVNX", "leave it out"),
            (
                "only",
                options.only.is_some() && !is_capture,
                "recordings and captures",
                "leave it out",
            ),
            (
                "duration",
                options.duration.is_some() && !is_walk,
                "synthetic:walk",
                cut,
            ),
        ];
        match ignored.into_iter().find(|(_, is_ignored, ..)| *is_ignored) {
            None => Ok(()),
            Some((name, _, whose, help)) => {
                let found = match self {
                    Self::Mvnx => "a file of a take",
                    Self::Capture(_) => "a recording or capture",
                    Self::Walk(..) => "the walker",
                };
                Err(usage(format!("{name}= is for {whose}, and {text} is {found}"), help))
            }
        }
    }
}

fn of_readable(path: &Path, format: FileFormat) -> PyResult<Input> {
    if path.exists() {
        format.check_readable(path).map_err(|error| raised(&error))?;
    }
    of_file(path).map(|()| Input::Mvnx)
}

/// Refuses a pipe, at which reading would wait for its writer and nothing could end that, and devices.
fn of_file(path: &Path) -> PyResult<()> {
    let kind = path.metadata().map(|about| about.file_type());
    // What is wrong with the others is said when they are opened.
    if kind
        .as_ref()
        .map_or(true, |kind: &FileType| kind.is_file() || kind.is_dir())
    {
        return Ok(());
    }
    let message = format!(
        "cannot read {}: expected a file, found a pipe or a device",
        path.display()
    );
    Err(exception(
        "ReadError",
        message,
        Some("copy it into a file first".to_owned()),
    ))
}

fn walk_duration(text: &str, duration: Option<f64>) -> PyResult<Duration> {
    let Some(seconds) = duration else {
        return Err(usage(
            format!("{text} never ends"),
            "say for how long, as in duration=10",
        ));
    };
    let duration = Duration::try_from_secs_f64(seconds).ok();
    duration.filter(|duration| !duration.is_zero()).ok_or_else(|| {
        usage(
            format!("expected seconds above 0 as the duration, found {seconds}"),
            "as in duration=10",
        )
    })
}

/// More threads than any machine has processors for. 0 is as many as there are.
const MOST_THREADS: usize = 4096;
