//! Statistics, and how a stream goes, as the JSON that every face of posewire gives: `posewire monitor --json`, the page and
//! Python alike. The field names are an interface, described in `docs/json.md`.
//!
//! ```
//! use posewire::json::ReceiverRecord;
//! use posewire::stats::Statistics;
//!
//! let statistics = Statistics::default();
//! let json = serde_json::to_value(ReceiverRecord::new(&statistics))?;
//! assert_eq!((&json["kind"], &json["malformed"]), (&"receiver".into(), &0.into()));
//! # Ok::<(), serde_json::Error>(())
//! ```

mod faults;
mod server;
mod spread;
mod statistics;
mod stream;

pub use faults::FaultsRecord;
pub use server::ServerRecord;
pub use spread::Spread;
pub use statistics::{ReceiverRecord, StatisticsRecord, statistics};
pub use stream::{StreamRecord, TargetRecord};

/// To a thousandth: what is measured is not known better.
pub fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
