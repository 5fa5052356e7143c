//! What a streamer tells of how it is going.

use posewire::json::StreamRecord;
use posewire::sink::{MxtpSink, MxtpTargets, NatNetSink, Progress};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where one sink tells how far it has come.
pub(super) struct Told {
    progress: Arc<Mutex<Progress>>,
    /// The places of its targets among those of the streamer.
    places: Vec<usize>,
    /// Of MXTP until the end, whose numbers go on while nothing is sent.
    targets: Mutex<Option<MxtpTargets>>,
}

impl Told {
    pub(super) fn of_mxtp(sink: &MxtpSink, places: Vec<usize>) -> Self {
        Self {
            progress: sink.progress(),
            places,
            targets: Mutex::new(Some(sink.targets())),
        }
    }

    pub(super) fn of_natnet(sink: &NatNetSink, place: usize) -> Self {
        Self {
            progress: sink.progress(),
            places: vec![place],
            targets: Mutex::new(None),
        }
    }

    /// Lets go of the targets when the sink has ended, so that their sockets are closed.
    pub(super) fn end(&self) {
        lock(&self.targets).take();
    }

    fn read(&self) -> Progress {
        let progress = lock(&self.progress).clone();
        match &*lock(&self.targets) {
            Some(targets) => Progress {
                targets: targets.progress(),
                ..progress
            },
            None => progress,
        }
    }
}

/// How far all sinks have come together, with the targets in the order in which they were given.
pub(super) fn progress(told: &[Told]) -> Progress {
    let mut progress = Progress::of_all(told.iter().map(Told::read));
    let places = told.iter().flat_map(|told| &told.places);
    let targets: BTreeMap<_, _> = places.zip(progress.targets).collect();
    progress.targets = targets.into_values().collect();
    progress
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The record of `docs/json.md` as a dict.
pub(super) fn record<'py>(py: Python<'py>, progress: &Progress) -> PyResult<Bound<'py, PyAny>> {
    let record = serde_json::to_string(&StreamRecord::new(progress, 0, None));
    // Nothing in it cannot be told in JSON.
    let record = record.unwrap_or_default();
    py.import("json")?.getattr("loads")?.call1((record,))
}

/// What happened to the peers, target by target, and what is left out.
pub(super) fn notices(progress: &Progress) -> Vec<String> {
    let peers = progress.targets.iter().flat_map(|target| &target.notices);
    let left_out = progress
        .left_out
        .iter()
        .map(|entry| format!("left out: {}: {}", entry.what, entry.why));
    peers.map(ToString::to_string).chain(left_out).collect()
}
