//! A program as a suit or a camera system.

mod carrying;
mod frame;
mod names;
mod numbering;
mod numbers;
mod opening;
mod told;

use crate::error::{exception, raised, usage};
use crate::number::Whole;
use crate::process::Opened;
use crate::skeleton::Skeleton;
use carrying::Carrying;
use frame::{clock, fill, given, time_of_day};
use numbering::Numbering;
pub(crate) use opening::streamer;
use posewire::sink::Progress;
use posewire::{Feed, Item, Session};
use posewire_motion::{Frame, Subject};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use told::Told;

/// Sends samples as a suit does. Use it as a context manager, or close it.
#[pyclass(frozen, module = "posewire")]
pub(crate) struct Streamer {
    urls: Vec<String>,
    told: Vec<Told>,
    /// What ended it.
    failure: Mutex<Option<posewire::Error>>,
    rate: f64,
    /// At least one.
    subjects: Vec<Arc<Subject>>,
    carrying: Carrying,
    numbering: Mutex<Numbering>,
    running: Opened<Mutex<Option<Running>>>,
}

struct Running {
    session: Session,
    feed: Feed,
}

impl Streamer {
    /// What runs; nothing in a child of the process that opened it.
    fn lock(&self) -> Option<MutexGuard<'_, Option<Running>>> {
        let running = self.running.if_here()?;
        Some(running.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The place of the subject with this number or name; the first if left out.
    fn place(&self, subject: Option<&Bound<'_, PyAny>>) -> PyResult<usize> {
        let Some(subject) = subject else { return Ok(0) };
        let by_name = |name: &String| self.subjects.iter().position(|subject| subject.name == *name);
        let found = match subject.extract::<String>() {
            Ok(name) => by_name(&name),
            Err(_) => subject
                .extract::<usize>()
                .ok()
                .filter(|place| *place < self.subjects.len()),
        };
        found.ok_or_else(|| {
            let names: Vec<_> = self
                .subjects
                .iter()
                .map(|subject| format!("{:?}", subject.name))
                .collect();
            let found = subject
                .repr()
                .map_or_else(|_| "another".to_owned(), |repr| repr.to_string());
            usage(
                format!("expected one of the subjects {}, found {found}", names.join(", ")),
                "give its name, or its place in names=, counted from 0",
            )
        })
    }

    /// The number of the sample of a subject that is sent now.
    fn number(&self, place: usize, given: Option<u32>) -> u32 {
        let mut numbering = self.numbering.lock().unwrap_or_else(PoisonError::into_inner);
        numbering.number(place, given)
    }

    fn push(&self, frame: Frame) -> Result<(), Ended> {
        let mut running = self.lock();
        let Some(Running { feed, .. }) = running.as_deref_mut().and_then(Option::as_mut) else {
            return Err(Ended::Closed);
        };
        let item = Item::Frame {
            frame: Arc::new(frame),
            due: Some(Instant::now()),
        };
        if feed.push([item]) {
            return Ok(());
        }
        let running = running.as_deref_mut().and_then(Option::take);
        let failed = running.map_or(Ok(()), |running| self.finish(running));
        Err(failed.map_or_else(Ended::Failed, |()| Ended::Closed))
    }

    /// Ends the threads, and remembers what had ended them before, if something had.
    fn finish(&self, Running { session, feed }: Running) -> posewire::Result<()> {
        drop(feed);
        let ended = session.wait().map(drop);
        self.told.iter().for_each(Told::end);
        *self.lock_failure() = ended.clone().err();
        ended
    }

    fn lock_failure(&self) -> MutexGuard<'_, Option<posewire::Error>> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn closed_error(&self) -> PyErr {
        let failure = self.lock_failure();
        let reason = failure.as_ref().map(|error| format!(": {error}")).unwrap_or_default();
        exception("ClosedError", format!("the streamer is closed{reason}"), None)
    }

    fn progress_now(&self) -> Progress {
        told::progress(&self.told)
    }
}

enum Ended {
    Closed,
    Failed(posewire::Error),
}

#[pymethods]
impl Streamer {
    /// Where it sends to, in the order given, with the ports that the system chose.
    #[getter]
    fn urls(&self) -> Vec<String> {
        self.urls.clone()
    }

    /// The segments that positions and orientations are for.
    #[getter]
    fn skeleton(&self) -> Skeleton {
        Skeleton {
            subject: Arc::clone(&self.subjects[0]),
        }
    }

    /// Sends a sample of the subject at a place of `names`, or of that name.
    ///
    /// `position` is (segments, 3) in metres, `orientation` (segments, 4), w first; NaN is not tracked. Other sections come by
    /// their names: velocity=, joint_angles=, sensor_orientation= ... Whatever is given is sent to a target that has a place for
    /// it. Quaternions whose length is within 0.001 of 1 are made so long.
    ///
    /// `sample` is the number of the sample. Left out, it is the same for all subjects of a moment, which ends when one of them is
    /// sent again: over NatNet they share a frame, which leaves when it has all of them or the next moment begins. `time` is the
    /// program's own clock in seconds from 0, the number by the rate if left out; `timecode` is the time of day, UTC, in seconds
    /// since midnight.
    ///
    /// Raises UsageError for arrays that do not fit the skeleton and for what no target has a place for, ClosedError after the end,
    /// and what ended the sending.
    #[pyo3(signature = (position = None, orientation = None, *, subject = None, sample = None, time = None, timecode = None,
        **sections))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn send(
        &self,
        py: Python<'_>,
        position: Option<&Bound<'_, PyAny>>,
        orientation: Option<&Bound<'_, PyAny>>,
        subject: Option<&Bound<'_, PyAny>>,
        sample: Option<Whole>,
        time: Option<f64>,
        timecode: Option<f64>,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        self.running.here()?;
        if self.closed() {
            return Err(self.closed_error());
        }
        let place = self.place(subject)?;
        let mut frame = Frame::new(Arc::clone(&self.subjects[place]));
        fill(&mut frame, self.carrying, given(position, orientation, sections)?)?;
        frame.timecode = timecode.map(|time| time_of_day(time, self.carrying)).transpose()?;
        let last = self.carrying.last_sample();
        let sample = sample.map(|sample| sample.within("sample", 0..=last)).transpose()?;
        let time = time.map(|time| clock(time, self.carrying)).transpose()?;
        frame.sample = self.number(place, sample);
        let by_rate = || Duration::from_secs_f64(f64::from(frame.sample) / self.rate);
        frame.time = time.unwrap_or_else(by_rate);
        py.detach(|| self.push(frame)).map_err(|ended| match ended {
            Ended::Closed => self.closed_error(),
            Ended::Failed(error) => raised(&error),
        })
    }

    /// Datagrams, and of TCP samples, that did not reach their target for a reason on this side: a TCP peer was too slow for them
    /// or away, the network had no room, the system refused them. What gets lost behind that only the receiver can know.
    #[getter]
    fn dropped(&self, py: Python<'_>) -> PyResult<u64> {
        self.running.here()?;
        Ok(py.detach(|| self.progress_now().lost()))
    }

    /// How far it has come, as `posewire stream --json` tells it: a dict of frames, lost, lateness_ms, targets with their numbers
    /// and their clients, and what is left_out. It goes on until it is closed, and stays after that.
    fn progress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.running.here()?;
        let progress = py.detach(|| self.progress_now());
        told::record(py, &progress)
    }

    /// What has happened, target by target: who connected and left, what failed, and what a target has no place for. The newest
    /// 100 of each target, the newest last.
    #[getter]
    fn notices(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.running.here()?;
        let mut notices = told::notices(&py.detach(|| self.progress_now()));
        notices.extend(self.lock_failure().as_ref().map(ToString::to_string));
        Ok(notices)
    }

    /// Whether nothing can be sent any more.
    #[getter]
    fn closed(&self) -> bool {
        let is_over = |running: &Mutex<Option<_>>| running.try_lock().is_ok_and(|running| running.is_none());
        self.running.if_here().is_none_or(is_over)
    }

    /// Sends what is on its way and ends it. Raises what had ended it before, unless that was raised already.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        let finished = py.detach(|| {
            let running = self.lock().and_then(|mut running| running.take());
            running.map_or(Ok(()), |running| self.finish(running))
        });
        finished.map_err(|error| raised(&error))
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    #[pyo3(signature = (*raised))]
    fn __exit__(&self, py: Python<'_>, raised: &Bound<'_, PyTuple>) -> PyResult<()> {
        let closed = self.close(py);
        // What is raised inside is what went wrong first.
        let is_raised = raised.get_item(0).is_ok_and(|kind| !kind.is_none());
        if is_raised { Ok(()) } else { closed }
    }

    fn __repr__(&self) -> String {
        format!("<posewire.Streamer to {}>", self.urls.join(", "))
    }
}
