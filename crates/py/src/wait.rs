//! Work that Python waits for, and that Ctrl-C ends.

use crate::error::usage;
use posewire::stop::Stop;
use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Does work on a thread of its own, while the interpreter is free. At least ten times a second signals are heeded and `tick` is
/// called, with the interpreter; what one of them raises sets `stop`, and is raised when the work has ended.
pub(crate) fn working<T: Send>(
    py: Python<'_>,
    stop: &Stop,
    work: impl FnOnce() -> T + Send,
    mut tick: impl FnMut() -> PyResult<()>,
) -> PyResult<T> {
    thread::scope(|scope| {
        let (done, finished) = sync_channel(1);
        let thread = scope.spawn(move || {
            let result = work();
            // Whoever waits for it looks at the thread itself.
            let _ = done.send(());
            result
        });
        let mut interrupted = Ok(());
        let finished = Mutex::new(finished);
        loop {
            let waited = py.detach(|| {
                let finished = finished.lock().unwrap_or_else(PoisonError::into_inner);
                finished.recv_timeout(LOOK_EVERY)
            });
            if waited != Err(RecvTimeoutError::Timeout) {
                break;
            }
            interrupted = interrupted.and_then(|()| py.check_signals()).and_then(|()| tick());
            if interrupted.is_err() {
                stop.stop();
            }
        }
        let result = py.detach(|| thread.join());
        interrupted?;
        tick()?;
        Ok(result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

/// Waits until `ready` says so, in steps after each of which signals are heeded; `false` when the time is over first.
///
/// `ready` is called without the interpreter and waits itself, no longer than it is told.
pub(crate) fn until(
    py: Python<'_>,
    timeout: Option<Duration>,
    mut ready: impl FnMut(Duration) -> bool + Send,
) -> PyResult<bool> {
    let end = timeout.map(|timeout| Instant::now().checked_add(timeout).unwrap_or_else(far));
    loop {
        let left = end.map_or(LOOK_EVERY, |end| end.saturating_duration_since(Instant::now()));
        if py.detach(|| ready(left.min(LOOK_EVERY))) {
            return Ok(true);
        }
        py.check_signals()?;
        if end.is_some_and(|end| Instant::now() >= end) {
            return Ok(false);
        }
    }
}

/// A number of seconds as Python has it; `None` waits for ever.
pub(crate) fn timeout(seconds: Option<f64>) -> PyResult<Option<Duration>> {
    let Some(seconds) = seconds else { return Ok(None) };
    if seconds.is_nan() {
        return Err(usage(
            "expected seconds as the timeout, found NaN",
            "None waits for ever",
        ));
    }
    let most = Duration::from_hours(24 * 365);
    Ok(Some(
        Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or(most).min(most),
    ))
}

fn far() -> Instant {
    Instant::now() + Duration::from_hours(24)
}

const LOOK_EVERY: Duration = Duration::from_millis(50);
