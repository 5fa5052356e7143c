//! How durations are spread.

use super::rounded;
use crate::histogram::Summary;
use serde::Serialize;
use std::time::Duration;

/// Milliseconds: the median, the 99th percentile and the largest.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    p50: f64,
    p99: f64,
    max: f64,
}

impl From<Summary> for Spread {
    fn from(summary: Summary) -> Self {
        let milliseconds = |duration: Duration| rounded(duration.as_secs_f64() * 1000.0);
        Self {
            p50: milliseconds(summary.p50),
            p99: milliseconds(summary.p99),
            max: milliseconds(summary.max),
        }
    }
}
