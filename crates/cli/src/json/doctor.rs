//! What the doctor found.

use posewire::doctor::{Finding, Listened, Severity};
use posewire::endpoint::Endpoint;
use posewire::json::rounded;
use serde::Serialize;

/// One finding.
#[derive(Serialize)]
pub(crate) struct FindingRecord<'a> {
    kind: &'static str,
    name: &'static str,
    severity: &'static str,
    place: Option<&'a str>,
    what: &'a str,
    why: &'static str,
    r#do: &'a str,
}

impl<'a> FindingRecord<'a> {
    pub(crate) fn new(finding: &'a Finding) -> Self {
        Self {
            kind: "finding",
            name: finding.check.name(),
            severity: finding.severity().name(),
            place: finding.place.as_deref(),
            what: &finding.what,
            why: finding.why(),
            r#do: &finding.remedy,
        }
    }
}

/// All of them together.
#[derive(Serialize)]
pub(crate) struct DoctorRecord {
    kind: &'static str,
    endpoint: Option<String>,
    elapsed_s: f64,
    datagrams: u64,
    lost_here: u64,
    broken: usize,
    warnings: usize,
    notes: usize,
}

impl DoctorRecord {
    pub(crate) fn new(endpoint: Option<&Endpoint>, examined: &Listened) -> Self {
        let count = |severity| {
            let findings = examined.findings.iter();
            findings.filter(|finding| finding.severity() == severity).count()
        };
        Self {
            kind: "doctor",
            endpoint: endpoint.map(ToString::to_string),
            elapsed_s: rounded(examined.elapsed.as_secs_f64()),
            datagrams: examined.datagrams,
            lost_here: examined.lost_here,
            broken: count(Severity::Broken),
            warnings: count(Severity::Warning),
            notes: count(Severity::Note),
        }
    }
}
