//! Wakes those who wait on an event loop and not on a thread of their own.

use pyo3::prelude::*;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// Rung by the engine's threads, which never need the interpreter, and waited for by one thread of Python's for all streams and
/// all event loops.
#[pyclass(frozen, module = "posewire")]
pub(crate) struct Bell {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    rung: Mutex<Rung>,
    changed: Condvar,
}

#[derive(Default)]
struct Rung {
    /// The numbers of those to be woken.
    sleepers: Vec<u64>,
    ended: bool,
}

/// One who is to be woken.
#[derive(Clone)]
pub(super) struct Sleeper {
    shared: Arc<Shared>,
    pub(super) number: u64,
}

impl Sleeper {
    pub(super) fn wake(self) {
        self.shared.lock().sleepers.push(self.number);
        self.shared.changed.notify_one();
    }
}

impl Bell {
    pub(super) fn sleeper(&self, number: u64) -> Sleeper {
        let shared = Arc::clone(&self.shared);
        Sleeper { shared, number }
    }
}

#[pymethods]
impl Bell {
    #[new]
    fn new() -> Self {
        let shared = Arc::default();
        Self { shared }
    }

    /// Waits until it is rung, and gives the numbers of those to be woken; None after the end.
    fn wait(&self, py: Python<'_>) -> Option<Vec<u64>> {
        py.detach(|| {
            let is_quiet = |rung: &mut Rung| rung.sleepers.is_empty() && !rung.ended;
            let waited = self.shared.changed.wait_while(self.shared.lock(), is_quiet);
            let mut rung = waited.unwrap_or_else(PoisonError::into_inner);
            let sleepers = std::mem::take(&mut rung.sleepers);
            (!rung.ended).then_some(sleepers)
        })
    }

    /// Ends the waiting for it.
    fn end(&self) {
        self.shared.lock().ended = true;
        self.shared.changed.notify_all();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Rung> {
        self.rung.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
