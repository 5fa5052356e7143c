//! Recordings of live streams.

use crate::error::{exception, raised, usage};
use crate::listen::arguments::texts;
use crate::number::Whole;
use crate::process::Opened;
use crate::read::FilePath;
use posewire::endpoint::Endpoint;
use posewire::recording::check_ending;
use posewire::sink::{RecordOptions, RecordProgress, RecordSink};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Item, Session, Sink, Source, SourceId, Wants};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::VecDeque;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Records live streams into an MCAP file from the moment it is made: every datagram as it came, and the poses in them.
///
/// `split_megabytes` begins another file when one is as large. Use it as a context manager, or close it: what has come is in the
/// file a tenth of a second later in any case.
///
/// Raises WriteError when the file is there and `overwrite` is not set, or cannot be written; NetworkError and UsageError for urls.
#[pyclass(frozen, weakref, module = "posewire")]
pub(crate) struct Recorder {
    urls: Vec<String>,
    recording: Opened<Recording>,
}

/// What runs.
struct Recording {
    progress: Arc<Mutex<RecordProgress>>,
    told: Told,
    stop: Stop,
    session: Mutex<Option<Session>>,
}

/// What the sources had to say. Clones share it.
#[derive(Clone, Default)]
struct Told(Arc<Mutex<VecDeque<String>>>);

impl Told {
    fn all(&self) -> Vec<String> {
        let notices = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        notices.iter().cloned().collect()
    }
}

impl Sink for Told {
    fn wants(&self) -> Wants {
        Wants {
            frames: false,
            datagrams: false,
            ahead: false,
        }
    }

    fn accept(&mut self, _: SourceId, item: &Item) -> posewire::Result<()> {
        if let Item::Notice(notice) = item {
            let mut notices = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            if notices.len() == MOST_NOTICES {
                notices.pop_front();
            }
            notices.push_back(notice.to_string());
        }
        Ok(())
    }
}

impl Recording {
    /// Whether its file is complete, or about to be.
    fn has_ended(&self) -> bool {
        self.session.lock().unwrap_or_else(PoisonError::into_inner).is_none()
    }

    /// Completes the file. The second time there is nothing to do.
    fn end(&self) -> posewire::Result<()> {
        self.stop.stop();
        let session = self.session.lock().unwrap_or_else(PoisonError::into_inner).take();
        session.map_or(Ok(()), |session| session.wait().map(drop))
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        // So that the file is complete when Python ends; the threads need nothing of Python, and there is nobody to be told.
        let _ = Python::try_attach(|py| py.detach(|| self.end())).unwrap_or_else(|| self.end());
    }
}

#[pymethods]
impl Recorder {
    #[new]
    #[pyo3(signature = (*urls, path, overwrite = false, split_megabytes = None))]
    fn new(
        py: Python<'_>,
        urls: &Bound<'_, PyTuple>,
        path: FilePath,
        overwrite: bool,
        split_megabytes: Option<Whole>,
    ) -> PyResult<Self> {
        let urls = texts(urls)?;
        if urls.is_empty() {
            return Err(usage(
                "expected what to record, found nothing",
                "as in Recorder(\"mxtp://0.0.0.0:9763\", path=\"take.mcap\")",
            ));
        }
        let endpoints = urls.iter().map(|url| live(url)).collect::<PyResult<Vec<_>>>()?;
        check_ending(&path.0).map_err(|error| raised(&error))?;
        let options = RecordOptions {
            split: split_megabytes.map(split).transpose()?,
            overwrite,
        };
        py.detach(|| start(&endpoints, &path.0, options))
            .map_err(|error| raised(&error))
    }

    /// Where it listens, with the ports that the system chose.
    #[getter]
    fn urls(&self) -> Vec<String> {
        self.urls.clone()
    }

    /// Whether its file is complete and nothing is recorded any more.
    #[getter]
    fn closed(&self) -> bool {
        self.recording.if_here().is_none_or(Recording::has_ended)
    }

    /// What the sources had to say: who connected, what is lost. The newest 100, the newest last.
    #[getter]
    fn notices(&self) -> PyResult<Vec<String>> {
        Ok(self.recording.here()?.told.all())
    }

    /// How far it has come: a dict of file, files, bytes, datagrams, frames, lost (on this machine) and failure.
    fn progress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let recording = self.recording.here()?;
        let progress = recording
            .progress
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        let told = PyDict::new(py);
        told.set_item("file", &progress.file)?;
        told.set_item("files", progress.files)?;
        told.set_item("bytes", progress.bytes)?;
        told.set_item("datagrams", progress.datagrams())?;
        told.set_item("frames", progress.frames())?;
        told.set_item("lost", progress.lost())?;
        told.set_item("failure", progress.failure.as_ref().map(ToString::to_string))?;
        Ok(told)
    }

    /// Completes the file and ends it. Raises what kept it from being written.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        let Some(recording) = self.recording.if_here() else {
            return Ok(());
        };
        py.detach(|| recording.end()).map_err(|error| raised(&error))
    }

    fn __enter__(this: PyRef<'_, Self>) -> PyResult<PyRef<'_, Self>> {
        if this.recording.here()?.has_ended() {
            let help = "it records once: make another, into another file";
            return Err(exception(
                "ClosedError",
                "the recorder is closed".to_owned(),
                Some(help.to_owned()),
            ));
        }
        Ok(this)
    }

    #[pyo3(signature = (*_raised))]
    fn __exit__(&self, py: Python<'_>, _raised: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.close(py)
    }

    fn __repr__(&self) -> String {
        format!("<posewire.Recorder of {}>", self.urls.join(", "))
    }
}

/// A stream that can be recorded, as `posewire record` has it.
fn live(url: &str) -> PyResult<Endpoint> {
    match url.parse() {
        Ok(Endpoint::File { path, .. }) => Err(usage(
            format!(
                "expected a live stream to record, as mxtp://0.0.0.0:9763, found {}",
                path.display()
            ),
            "the file to write is path=; posewire.read gives what a take holds",
        )),
        endpoint => endpoint.map_err(|error| raised(&error)),
    }
}

/// Bytes of a file at most.
fn split(megabytes: Whole) -> PyResult<u64> {
    Ok(megabytes.within("split_megabytes", 1..=1_000_000)? * 1_000_000)
}

fn start(endpoints: &[Endpoint], path: &Path, options: RecordOptions) -> posewire::Result<Recorder> {
    let mut sources = Vec::new();
    for endpoint in endpoints {
        sources.extend(Source::open_all(endpoint, &PlaybackOptions::default())?);
    }
    let endpoints: Vec<_> = sources.iter().map(|source| source.endpoint().clone()).collect();
    let stop = Stop::new();
    let sink = RecordSink::create(path, &endpoints, options, stop.clone())?;
    let (progress, told) = (sink.progress(), Told::default());
    let sinks: Vec<Box<dyn Sink>> = vec![Box::new(sink), Box::new(told.clone())];
    let recording = Recording {
        progress,
        told,
        session: Mutex::new(Some(Session::start(sources, sinks, stop.clone()))),
        stop,
    };
    Ok(Recorder {
        urls: endpoints.iter().map(ToString::to_string).collect(),
        recording: Opened::new("the recorder", recording),
    })
}

const MOST_NOTICES: usize = 100;
