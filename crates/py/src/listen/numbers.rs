//! Statistics as Python values.

use posewire::json::{ReceiverRecord, ServerRecord, statistics};
use posewire::stats::Statistics;
use pyo3::prelude::*;
use serde_json::Value;
use std::sync::Arc;

/// The records of `docs/json.md`, of one source after the other, as a list of dicts.
pub(super) fn of<'py>(py: Python<'py>, sources: &[Arc<Statistics>]) -> PyResult<Bound<'py, PyAny>> {
    let records = sources.iter().flat_map(|all| {
        let receiver = serde_json::to_value(ReceiverRecord::new(all));
        let server = ServerRecord::new(all).map(serde_json::to_value);
        let streams = statistics(all).map(serde_json::to_value);
        std::iter::once(receiver)
            .chain(server)
            .chain(streams)
            .collect::<Vec<_>>()
    });
    let records: Vec<Value> = records.flatten().collect();
    py.import("json")?
        .getattr("loads")?
        .call1((Value::Array(records).to_string(),))
}
