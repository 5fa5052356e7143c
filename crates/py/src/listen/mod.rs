//! Live streams.

mod inbox;
mod numbers;

use crate::error::{exception, raised, usage};
use crate::frame::Frame;
use crate::wait::{timeout, until};
use inbox::{Inbox, Keeping};
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Source};
use pyo3::prelude::*;
use pyo3::types::{PyAny, PyTuple};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Opens sources of motion and listens to them at once: "mxtp://0.0.0.0:9763", "mxtp+tcp://...", "natnet://HOST". Files,
/// recordings and "synthetic:walk" are played at their own pace.
///
/// `capacity` samples wait to be taken, at most. When there is no room for one it is gone: with on_overflow="raise" the next
/// sample is then an OverflowError, once; with "count" it is only counted in `dropped`. Samples from before the first one is
/// taken are not missed: the newest `capacity` of them are there.
///
/// A sample is LIVE until it is `stale_after` seconds old and LOST from `lost_after` on. `loop`, `speed` and `only` are for what
/// is played.
#[pyfunction]
#[pyo3(signature = (*urls, capacity = 8192, on_overflow = "raise", stale_after = 0.1, lost_after = 1.0, r#loop = false, speed = 1.0,
    only = None))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn listen(
    py: Python<'_>,
    urls: &Bound<'_, PyTuple>,
    capacity: usize,
    on_overflow: &str,
    stale_after: f64,
    lost_after: f64,
    r#loop: bool,
    speed: f64,
    only: Option<String>,
) -> PyResult<Stream> {
    let urls = urls.extract::<Vec<String>>()?;
    let keeping = Keeping {
        capacity: capacity.max(1),
        stale_after: seconds("stale_after", stale_after)?,
        lost_after: seconds("lost_after", lost_after)?,
    };
    let raises = match on_overflow {
        "raise" => true,
        "count" => false,
        found => {
            let message = format!("expected on_overflow \"raise\" or \"count\", found {found:?}");
            return Err(usage(
                message,
                "\"count\" leaves the number of lost samples in stream.dropped",
            ));
        }
    };
    let options = PlaybackOptions {
        looped: r#loop,
        speed,
        only,
        ..PlaybackOptions::default()
    };
    let sources = py.detach(|| open(&urls, &options)).map_err(|error| raised(&error))?;
    if sources.is_empty() {
        return Err(usage(
            "expected where to listen, found nothing",
            "as in posewire.listen(\"mxtp://0.0.0.0:9763\")",
        ));
    }
    let urls = sources.iter().map(|source| source.endpoint().to_string()).collect();
    let (inbox, stop) = (Inbox::new(keeping), Stop::new());
    let session = Session::start(sources, vec![Box::new(inbox.clone())], stop.clone());
    Ok(Stream {
        urls,
        inbox,
        raises,
        stop,
        session: Mutex::new(Some(session)),
    })
}

fn open(urls: &[String], options: &PlaybackOptions) -> posewire::Result<Vec<Source>> {
    let mut sources = Vec::new();
    for url in urls {
        sources.extend(Source::open_all(&url.parse()?, options)?);
    }
    Ok(sources)
}

fn seconds(name: &str, seconds: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(seconds).map_err(|_| {
        usage(
            format!("expected seconds as {name}, found {seconds}"),
            "use a number above 0",
        )
    })
}

/// What arrives. Iterating gives every sample; `latest` gives the newest.
///
/// Use it as a context manager, or close it. It may be used from several threads.
#[pyclass(frozen, module = "posewire")]
pub(crate) struct Stream {
    urls: Vec<String>,
    inbox: Inbox,
    raises: bool,
    stop: Stop,
    session: Mutex<Option<Session>>,
}

impl Stream {
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
            py.detach(|| self.join()).map_err(|error| raised(&error))?;
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
    fn subjects(&self) -> Vec<String> {
        self.inbox.subjects()
    }

    /// Samples that are gone because they were not taken in time.
    #[getter]
    fn dropped(&self) -> u64 {
        self.inbox.dropped()
    }

    /// What the sources had to say: who connected, what is lost. The newest 100, the newest last.
    #[getter]
    fn notices(&self) -> Vec<String> {
        self.inbox.notices()
    }

    /// Whether no sample will come any more.
    #[getter]
    fn closed(&self) -> bool {
        self.inbox.has_ended()
    }

    /// The newest sample, of all subjects or of the one with this name.
    ///
    /// It waits, for `timeout` seconds at most, only while there is none yet; None if there is none then. A sample that is there
    /// is given at once, however old: its `age` and its `state` say so.
    #[pyo3(signature = (timeout = None, subject = None))]
    fn latest(&self, py: Python<'_>, timeout: Option<f64>, subject: Option<&str>) -> PyResult<Option<Frame>> {
        if let Some(frame) = self.inbox.newest(subject) {
            return Ok(Some(frame));
        }
        let timeout = crate::wait::timeout(timeout)?;
        until(py, timeout, |longest| self.inbox.wait_for_newest(subject, longest))?;
        Ok(self.inbox.newest(subject))
    }

    /// The next sample, waiting for it for `timeout` seconds at most: None if none has come, or none will come.
    ///
    /// Raises OverflowError when samples before it are gone, and what ended the source, if something did.
    #[pyo3(signature = (timeout = None))]
    fn next(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Option<Frame>> {
        self.wait_for(py, self::timeout(timeout)?)
    }

    /// How the stream is doing, as `posewire monitor --json` tells it: a list of dicts, each with its "kind". It is counted once
    /// a second.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        numbers::of(py, &self.inbox.statistics())
    }

    /// Ends it. Samples that wait can still be taken.
    fn close(&self, py: Python<'_>) {
        self.stop.stop();
        // What went wrong before is not for the one who closes it.
        let _ = py.detach(|| self.join());
        self.inbox.end();
    }

    fn __iter__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        self.wait_for(py, None)
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
        self.next_if_there(py)
    }

    /// Waits for a while until there is a sample or the end, and heeds no signals: for asyncio, on a thread of its own.
    fn _wait(&self, py: Python<'_>) -> bool {
        py.detach(|| self.inbox.wait(ASYNCHRONOUS_WAIT))
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

impl Drop for Stream {
    fn drop(&mut self) {
        // Its threads see it and end by themselves; they need nothing of Python.
        self.stop.stop();
    }
}

/// How long a thread of asyncio's pool is held at most when the program is to end.
const ASYNCHRONOUS_WAIT: Duration = Duration::from_millis(50);
