//! What belongs to the process that opened it. A child of `fork()` has copies of a program's objects, and none of its threads.

use crate::error::exception;
use pyo3::prelude::*;

/// Something with threads, and only for the process that opened it.
///
/// In a child of `fork()` the threads do not exist, a lock that one of them held stays locked for ever, and what it writes is
/// its parent's. So nothing of it is locked, joined or dropped there: it is out of reach, and its memory is left alone.
pub(crate) struct Opened<T> {
    /// As in "the stream".
    what: &'static str,
    process: u32,
    held: Option<T>,
}

impl<T> Opened<T> {
    /// Opened by the process that runs this; `what` is it, as in "the stream".
    pub(crate) fn new(what: &'static str, held: T) -> Self {
        Self {
            what,
            process: std::process::id(),
            held: Some(held),
        }
    }

    /// What was opened; `ClosedError` in a child of the process that did so.
    pub(crate) fn here(&self) -> PyResult<&T> {
        self.if_here().ok_or_else(|| {
            let message = format!("{} was opened in another process", self.what);
            let help = "a child of fork() cannot use it: open it in the child, or start that with \"spawn\"";
            exception("ClosedError", message, Some(help.to_owned()))
        })
    }

    /// What was opened; nothing in a child of the process that did so, where there is nothing to be closed.
    pub(crate) fn if_here(&self) -> Option<&T> {
        self.held.as_ref().filter(|_| self.is_here())
    }

    fn is_here(&self) -> bool {
        self.process == std::process::id()
    }
}

impl<T> Drop for Opened<T> {
    fn drop(&mut self) {
        if !self.is_here() {
            std::mem::forget(self.held.take());
        }
    }
}
