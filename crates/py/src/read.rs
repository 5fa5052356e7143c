//! Takes from files.

use crate::error::{exception, raised, usage};
use crate::take::Take;
use crate::wait::working;
use posewire::endpoint::{Endpoint, FileFormat, Walk};
use posewire::file::{self, Progress, ReadOptions, Recording};
use posewire::sink::TakeSink;
use posewire::source::{PlaybackOptions, synthetic};
use posewire::stop::Stop;
use posewire::{Error, Session, Source};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Reads a take: an MVNX file (.mvnx, .mvnx.gz), a recording or a capture (.mcap, .pcap, .pcapng), or "synthetic:walk", the
/// built-in walker, with a duration.
///
/// Where there are several subjects, `subject` names one; `read_all` gives them all. `progress` is called with how much is done
/// and how much there is: bytes of MVNX, samples of others, whose total is 0, unknown. `salvage` uses a damaged file up to the
/// damage. `only` is the source of a capture, by its number or a part of its name.
///
/// Raises ReadError for a file that cannot be read, UsageError for one that is none, and MissingError when there is not
/// exactly one take.
#[pyfunction]
#[pyo3(signature = (path, *, subject = None, progress = None, salvage = false, only = None, duration = None, threads = None))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    subject: Option<String>,
    progress: Option<Py<PyAny>>,
    salvage: bool,
    only: Option<String>,
    duration: Option<f64>,
    threads: Option<usize>,
) -> PyResult<Take> {
    let all = read_all(py, path.clone(), progress, salvage, only, duration, threads)?;
    one(&path, all, subject.as_deref())
}

/// Reads the takes of all subjects of a file, as `read` does that of one.
#[pyfunction]
#[pyo3(signature = (path, *, progress = None, salvage = false, only = None, duration = None, threads = None))]
pub(crate) fn read_all(
    py: Python<'_>,
    path: PathBuf,
    progress: Option<Py<PyAny>>,
    salvage: bool,
    only: Option<String>,
    duration: Option<f64>,
    threads: Option<usize>,
) -> PyResult<Vec<Take>> {
    let stop = Stop::new();
    let counted = Progress::new(stop.clone());
    let takes = TakeSink::default();
    let input = Input::of(&path, duration)?;
    let work = || match &input {
        Input::Mvnx => {
            let options = ReadOptions { salvage, threads };
            file::read(&path, options, &counted).map(|recording| vec![recording])
        }
        Input::Capture(endpoint) => play(endpoint, only, &takes, &stop),
        Input::Walk(walk, duration) => Ok(walk_for(walk, *duration, &stop)),
    };
    let read = working(py, &stop, work, || {
        let Some(progress) = &progress else { return Ok(()) };
        let (done, total) = match input {
            Input::Mvnx => (counted.done(), counted.total()),
            _ => (takes.frames() as u64, 0),
        };
        progress.call1(py, (done, total)).map(drop)
    });
    let recordings = read?.map_err(|error| raised(&error))?;
    let received = matches!(input, Input::Capture(_));
    Ok(recordings
        .into_iter()
        .map(|recording| Take::new(recording, received))
        .collect())
}

/// What a path is.
enum Input {
    Mvnx,
    Capture(Endpoint),
    Walk(Walk, Duration),
}

impl Input {
    /// As the command line has it: what a file holds counts more than its name, and one that is not there is said to be missing.
    fn of(path: &Path, duration: Option<f64>) -> PyResult<Self> {
        let text = path.to_string_lossy();
        match text.parse() {
            Ok(Endpoint::Synthetic(walk)) => walk_duration(&text, duration).map(|duration| Self::Walk(walk, duration)),
            Ok(Endpoint::File { path, format }) => Self::of_file(&path, format),
            Ok(endpoint @ Endpoint::Capture { .. }) => Ok(Self::Capture(endpoint)),
            Err(Error::UnknownFormat { .. }) => Ok(Self::Mvnx),
            Ok(endpoint) => Err(usage(
                format!("expected a file, found {endpoint}"),
                format!("posewire.listen(\"{endpoint}\") gives what comes from there"),
            )),
            Err(error) => Err(raised(&error)),
        }
    }

    fn of_file(path: &Path, format: FileFormat) -> PyResult<Self> {
        if path.exists() {
            format.check_readable(path).map_err(|error| raised(&error))?;
        }
        Ok(Self::Mvnx)
    }
}

fn walk_duration(text: &str, duration: Option<f64>) -> PyResult<Duration> {
    let duration = duration.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    duration.ok_or_else(|| usage(format!("{text} never ends"), "say for how long, as in duration=10"))
}

/// All that a capture holds, as fast as it can be read.
fn play(endpoint: &Endpoint, only: Option<String>, takes: &TakeSink, stop: &Stop) -> posewire::Result<Vec<Recording>> {
    let options = PlaybackOptions {
        speed: AT_ONCE,
        only,
        ..PlaybackOptions::default()
    };
    let sources = Source::open_all(endpoint, &options)?;
    Session::start(sources, vec![Box::new(takes.clone())], stop.clone()).wait()?;
    Ok(takes.take().into_iter().map(Recording::from).collect())
}

fn walk_for(walk: &Walk, duration: Duration, stop: &Stop) -> Vec<Recording> {
    let walk = synthetic::Walk::new(&walk.into());
    let frames = (duration.as_secs_f64() * walk.rate()).ceil().max(1.0) as u32;
    let person = |(person, subject): (usize, &Arc<posewire_motion::Subject>)| {
        let mut take = posewire_motion::Take::new(Arc::clone(subject), walk.rate());
        for sample in 0..frames {
            if sample % 1024 == 0 && stop.is_stopped() {
                break;
            }
            // The walker's frames fit the walker.
            let _ = take.push(&walk.frame(person, sample));
        }
        Recording::from(take)
    };
    walk.subjects().iter().enumerate().map(person).collect()
}

fn one(path: &Path, mut all: Vec<Take>, subject: Option<&str>) -> PyResult<Take> {
    let name = |take: &Take| take.recording.take.subject.name.clone();
    let names: Vec<_> = all.iter().map(name).collect();
    all.retain(|take| subject.is_none_or(|subject| name(take) == subject));
    if all.len() == 1 {
        return Ok(all.swap_remove(0));
    }
    let help = if all.is_empty() && subject.is_none() {
        "posewire inspect says what it holds"
    } else {
        "choose one with subject=, or take them all with read_all()"
    };
    let wanted = subject.map_or_else(|| "one take".to_owned(), |subject| format!("one take of {subject:?}"));
    let found = if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    };
    let message = format!("{}: expected {wanted}, found {found}", path.display());
    Err(exception("MissingError", message, Some(help.to_owned())))
}

/// A capture is played as fast as it can be read.
const AT_ONCE: f64 = 1e6;
