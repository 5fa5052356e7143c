//! Takes from files.

mod input;

pub(crate) use input::FilePath;

use crate::error::{exception, raised};
use crate::number::Whole;
use crate::take::Take;
use crate::wait::working;
use input::{Input, Options, SourceName};
use posewire::endpoint::{Endpoint, Walk};
use posewire::file::{self, Progress, Recording};
use posewire::sink::TakeSink;
use posewire::source::{PlaybackOptions, synthetic};
use posewire::stop::Stop;
use posewire::{Error, Item, Notice, Session, Sink, Source, SourceId, Wants};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use std::ffi::CString;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Reads a take: an MVNX file (.mvnx, .mvnx.gz), a recording or a capture (.mcap, .pcap, .pcapng), or "synthetic:walk", the
/// built-in walker, with a duration.
///
/// Where there are several subjects, `subject` names one; `read_all` gives them all. `progress` is called with how much is done
/// and how much there is: bytes of MVNX, samples of others, whose total is 0, unknown. `salvage` uses a file that is damaged or
/// was cut off up to the damage, of which `Take.damage` tells. `only` is the source of a recording or capture, by its number or a
/// part of its name; `threads` is how many read MVNX.
///
/// Raises ReadError for a file that cannot be read or is damaged, UsageError for one that is none and for arguments that nothing
/// would come of, and MissingError when there is not exactly one take.
#[pyfunction]
#[pyo3(signature = (path, *, subject = None, progress = None, salvage = false, only = None, duration = None, threads = None))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn read(
    py: Python<'_>,
    path: FilePath,
    subject: Option<String>,
    progress: Option<Py<PyAny>>,
    salvage: bool,
    only: Option<SourceName>,
    duration: Option<f64>,
    threads: Option<Whole>,
) -> PyResult<Take> {
    let options = Options::new(salvage, only, duration, threads)?;
    let all = takes(py, &path.0, progress.as_ref(), &options)?;
    one(&path.0, all, subject.as_deref())
}

/// Reads the takes of all subjects of a file, as `read` does that of one.
#[pyfunction]
#[pyo3(signature = (path, *, progress = None, salvage = false, only = None, duration = None, threads = None))]
pub(crate) fn read_all(
    py: Python<'_>,
    path: FilePath,
    progress: Option<Py<PyAny>>,
    salvage: bool,
    only: Option<SourceName>,
    duration: Option<f64>,
    threads: Option<Whole>,
) -> PyResult<Vec<Take>> {
    let options = Options::new(salvage, only, duration, threads)?;
    takes(py, &path.0, progress.as_ref(), &options)
}

fn takes(py: Python<'_>, path: &Path, progress: Option<&Py<PyAny>>, options: &Options) -> PyResult<Vec<Take>> {
    let stop = Stop::new();
    let counted = Progress::new(stop.clone());
    let (kept, heard) = (TakeSink::default(), Heard::default());
    let input = Input::of(path, options)?;
    let work = || match &input {
        Input::Mvnx => file::read(path, options.reading(), &counted).map(|recording| vec![recording]),
        Input::Capture(endpoint) => play(endpoint, options.only.clone(), &kept, &heard, &stop),
        Input::Walk(walk, duration) => walk_for(walk, *duration, &stop),
    };
    let read = working(py, &stop, work, || {
        let Some(progress) = progress else { return Ok(()) };
        let (done, total) = match input {
            Input::Mvnx => (counted.done(), counted.total()),
            _ => (kept.frames() as u64, 0),
        };
        progress.call1(py, (done, total)).map(drop)
    });
    let recordings = read?.map_err(|error| raised(&error))?;
    if let Some(problem) = heard.damage()
        && (recordings.is_empty() || !options.salvage)
    {
        return Err(damaged(path, problem, recordings.is_empty()));
    }
    heard.warn(py)?;
    let received = matches!(input, Input::Capture(_));
    let take = |recording| Take::new(recording, received);
    Ok(recordings.into_iter().map(take).collect())
}

/// A recording or capture that ends before its end, as the command line says it of one that it uses up to there.
fn damaged(path: &Path, problem: String, lacks_all: bool) -> PyErr {
    let file = path.display().to_string();
    let message = Notice::Damaged { file, problem }.to_string();
    let help = if lacks_all {
        "there is no whole sample before the damage"
    } else {
        "salvage=True uses what comes before the damage; of a recording, posewire inspect --recover makes a whole file of that"
    };
    exception("ReadError", message, Some(help.to_owned()))
}

/// All that a capture holds, as fast as it can be read.
fn play(
    endpoint: &Endpoint,
    only: Option<String>,
    kept: &TakeSink,
    heard: &Heard,
    stop: &Stop,
) -> posewire::Result<Vec<Recording>> {
    let options = PlaybackOptions {
        speed: PlaybackOptions::AT_ONCE,
        only,
        computes: false,
        ..PlaybackOptions::default()
    };
    let sources = Source::open_all_until(endpoint, &options, stop)?;
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(kept.clone()), Box::new(heard.clone())];
    Session::start(sources, sinks, stop.clone()).wait()?;
    if let Some(error) = heard.failure() {
        return Err(error);
    }
    let recording = |take| {
        let mut recording = Recording::from(take);
        recording.damage = heard.damage();
        recording
    };
    Ok(kept.take().into_iter().map(recording).collect())
}

/// What a capture's sources say of it. Clones share it.
#[derive(Clone, Default)]
struct Heard(Arc<Mutex<Vec<Notice>>>);

impl Heard {
    /// What ended the file before its end.
    fn damage(&self) -> Option<String> {
        self.find(|notice| match notice {
            Notice::Damaged { problem, .. } => Some(problem.clone()),
            _ => None,
        })
    }

    /// What kept one of several sources from being read to its end.
    fn failure(&self) -> Option<Error> {
        self.find(|notice| match notice {
            Notice::Failed { error } => Some(error.clone()),
            _ => None,
        })
    }

    /// Says in Python what was passed over.
    fn warn(&self, py: Python<'_>) -> PyResult<()> {
        let text = self.find(|notice| match notice {
            Notice::PosesLeftOut { .. } => Some(format!("{notice} with only=")),
            _ => None,
        });
        let Some(text) = text else { return Ok(()) };
        let text = CString::new(text.replace('\0', ""))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)
    }

    fn find<T>(&self, wanted: impl Fn(&Notice) -> Option<T>) -> Option<T> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .iter()
            .find_map(wanted)
    }
}

impl Sink for Heard {
    fn wants(&self) -> Wants {
        Wants {
            frames: false,
            ..Wants::default()
        }
    }

    fn accept(&mut self, _: SourceId, item: &Item) -> posewire::Result<()> {
        use Notice::{Damaged, Failed, PosesLeftOut};
        if let Item::Notice(notice @ (Damaged { .. } | Failed { .. } | PosesLeftOut { .. })) = item {
            let mut notices = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            notices.push(notice.clone());
        }
        Ok(())
    }
}

fn walk_for(walk: &Walk, duration: Duration, stop: &Stop) -> posewire::Result<Vec<Recording>> {
    let takes = synthetic::Walk::new(&walk.into()).takes(duration, stop)?;
    Ok(takes.into_iter().map(Recording::from).collect())
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
