//! What Python has of a live stream.

use super::bell::Bell;
use super::inbox::Inbox;
use super::numbers;
use crate::error::{exception, raised};
use crate::frame::Frame;
use crate::process::Opened;
use crate::wait::{timeout, until};
use posewire::Session;
use posewire::stop::Stop;
use pyo3::prelude::*;
use pyo3::types::{PyAny, PyTuple};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What arrives. Iterating gives every sample; `latest` gives the newest.
///
/// Use it as a context manager, or close it. It may be used from several threads, and not in a child of fork().
#[pyclass(frozen, weakref, module = "posewire")]
pub(crate) struct Stream {
    urls: Vec<String>,
    listening: Opened<Listening>,
}

/// What runs.
pub(super) struct Listening {
    inbox: Inbox,
    raises: bool,
    stop: Stop,
    session: Mutex<Option<Session>>,
}

impl Listening {
    pub(super) fn new(inbox: Inbox, raises: bool, stop: Stop, session: Session) -> Self {
        Self {
            inbox,
            raises,
            stop,
            session: Mutex::new(Some(session)),
        }
    }

    /// Ends it. What went wrong before is not for the one who does.
    fn end(&self) {
        self.stop.stop();
        let _ = self.join();
        self.inbox.end();
    }

    /// Waits for the session's threads, which end soon: all sources have ended, or are stopped.
    fn join(&self) -> posewire::Result<()> {
        let session = self.lock().take();
        session.map_or(Ok(()), |session| session.wait().map(drop))
    }

    fn lock(&self) -> MutexGuard<'_, Option<Session>> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next sample, waiting for it no longer than `timeout`.
    fn wait_for(&self, py: Python<'_>, timeout: Option<Duration>) -> PyResult<Option<Frame>> {
        loop {
            if let Some(frame) = self.next_if_there(py)? {
                return Ok(Some(frame));
            }
            if self.inbox.has_ended() || !until(py, timeout, |longest| self.inbox.wait(longest))? {
                return self.next_if_there(py);
            }
        }
    }

    /// The next sample if it is there. Where all has ended, what ended it is raised.
    fn next_if_there(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        if self.raises {
            self.raise_dropped()?;
        }
        let ended = self.inbox.has_ended();
        let frame = self.inbox.take();
        if ended && frame.is_none() {
            self.raise_failure(py)?;
        }
        Ok(frame)
    }

    /// Raises what has ended it, once.
    fn raise_failure(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.join()).map_err(|error| raised(&error))
    }

    /// The newest sample, waiting for a first one no longer than `timeout`.
    fn latest(&self, py: Python<'_>, timeout: Option<Duration>, subject: Option<&str>) -> PyResult<Option<Frame>> {
        if let Some(frame) = self.inbox.newest(subject) {
            return Ok(Some(frame));
        }
        until(py, timeout, |longest| self.inbox.wait_for_newest(subject, longest))?;
        let ended = self.inbox.has_ended();
        let frame = self.inbox.newest(subject);
        if ended && frame.is_none() {
            self.raise_failure(py)?;
        }
        Ok(frame)
    }

    fn raise_dropped(&self) -> PyResult<()> {
        match self.inbox.tell_dropped() {
            0 => Ok(()),
            count => Err(exception(
                "OverflowError",
                format!("{count} samples are gone: they came faster than they were taken"),
                Some("take them faster, with more capacity=, or latest() if the newest is enough".to_owned()),
            )),
        }
    }
}

impl Drop for Listening {
    fn drop(&mut self) {
        // Other threads run meanwhile, unless Python is at its end; those of the session need nothing of Python.
        if Python::try_attach(|py| py.detach(|| self.end())).is_none() {
            self.end();
        }
    }
}

impl Stream {
    pub(super) fn new(urls: Vec<String>, listening: Opened<Listening>) -> Self {
        Self { urls, listening }
    }
}

#[pymethods]
impl Stream {
    /// Where it listens, with the ports that the system chose.
    #[getter]
    fn urls(&self) -> Vec<String> {
        self.urls.clone()
    }

    /// The first of the urls.
    #[getter]
    fn url(&self) -> String {
        self.urls.first().cloned().unwrap_or_default()
    }

    /// Names of the subjects of which a sample has arrived.
    #[getter]
    fn subjects(&self) -> PyResult<Vec<String>> {
        Ok(self.listening.here()?.inbox.subjects())
    }

    /// Samples that are gone because they were not taken in time.
    #[getter]
    fn dropped(&self) -> PyResult<u64> {
        Ok(self.listening.here()?.inbox.dropped())
    }

    /// What the sources had to say: who connected, what is lost. The newest 100, the newest last.
    #[getter]
    fn notices(&self) -> PyResult<Vec<String>> {
        Ok(self.listening.here()?.inbox.notices())
    }

    /// Whether no sample will come any more.
    #[getter]
    fn closed(&self) -> bool {
        self.listening
            .if_here()
            .is_none_or(|listening| listening.inbox.has_ended())
    }

    /// The newest complete sample, of all subjects or of the one with this name, also while one before it still lacks something:
    /// never one that a newer of its subject had overtaken. Of all subjects it is the one that arrived last.
    ///
    /// It waits, for `timeout` seconds at most, only while there is none yet; None if there is none then. A sample that is there
    /// is given at once, however old: its `age` and its `state` say so.
    #[pyo3(signature = (timeout = None, subject = None))]
    fn latest(&self, py: Python<'_>, timeout: Option<f64>, subject: Option<&str>) -> PyResult<Option<Frame>> {
        let timeout = self::timeout(timeout)?;
        self.listening.here()?.latest(py, timeout, subject)
    }

    /// The next sample, waiting for it for `timeout` seconds at most: None if none has come, or none will come.
    ///
    /// Raises OverflowError when samples before it are gone, and what ended the source, if something did.
    #[pyo3(signature = (timeout = None))]
    fn next(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Option<Frame>> {
        self.listening.here()?.wait_for(py, self::timeout(timeout)?)
    }

    /// How the stream is doing, as `posewire monitor --json` tells it: a list of dicts, each with its "kind". It is counted once
    /// a second; in the first one the list is empty.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        numbers::of(py, &self.listening.here()?.inbox.statistics())
    }

    /// Ends it. Samples that wait can still be taken.
    fn close(&self, py: Python<'_>) {
        if let Some(listening) = self.listening.if_here() {
            py.detach(|| listening.end());
        }
    }

    fn __iter__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        self.listening.here()?.wait_for(py, None)
    }

    /// `async for frame in stream` gives every sample, as `for` does.
    fn __aiter__(this: Bound<'_, Self>) -> PyResult<Bound<'_, PyAny>> {
        this.py()
            .import("posewire._asynchronous")?
            .getattr("Samples")?
            .call1((this,))
    }

    /// The next sample if it is there: for asyncio.
    fn _take(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        self.listening.here()?.next_if_there(py)
    }

    /// Rings for a sleeper when there is a sample or the end; false if that is so already: for asyncio.
    fn _wake(&self, bell: PyRef<'_, Bell>, number: u64) -> PyResult<bool> {
        Ok(self.listening.here()?.inbox.wake(bell.sleeper(number)))
    }

    /// Lets a sleeper sleep: for asyncio.
    fn _let_sleep(&self, number: u64) {
        if let Some(listening) = self.listening.if_here() {
            listening.inbox.let_sleep(number);
        }
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    #[pyo3(signature = (*_raised))]
    fn __exit__(&self, py: Python<'_>, _raised: &Bound<'_, PyTuple>) {
        self.close(py);
    }

    fn __repr__(&self) -> String {
        format!("<posewire.Stream {}>", self.urls.join(", "))
    }
}
