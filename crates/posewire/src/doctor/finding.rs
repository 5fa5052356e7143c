//! What was found, and what to do about it.

use super::Check;
use std::fmt;

/// One thing that was found: what it is, why it matters and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Which check found it.
    pub check: Check,
    /// Where: a character, a sender, a port, an interface; `None` where it is about all.
    pub place: Option<String>,
    /// What was found, in sentences.
    pub what: String,
    /// What to do about it, in sentences; the check's own advice, or better advice where more is known.
    pub remedy: String,
}

/// How bad a finding is. The worst comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Nothing arrives, or what arrives is wrong.
    Broken,
    /// Something is lost or late, or will be when more is asked for.
    Warning,
    /// Good to know.
    Note,
}

impl Finding {
    /// A finding about everything, with the check's own advice.
    pub(super) fn new(check: Check, what: impl Into<String>) -> Self {
        Self {
            check,
            place: None,
            what: what.into(),
            remedy: check.remedy().to_owned(),
        }
    }

    /// The same finding at a place.
    pub(super) fn at(self, place: impl fmt::Display) -> Self {
        let place = Some(place.to_string());
        Self { place, ..self }
    }

    /// The same finding with other advice.
    pub(super) fn with_remedy(self, remedy: impl Into<String>) -> Self {
        let remedy = remedy.into();
        Self { remedy, ..self }
    }

    /// How bad it is.
    pub const fn severity(&self) -> Severity {
        self.check.severity()
    }

    /// Why it matters.
    pub const fn why(&self) -> &'static str {
        self.check.why()
    }
}

impl Severity {
    /// The stable name: `broken`, `warning` or `note`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Broken => "broken",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Puts the worst first, and otherwise leaves the order.
pub(super) fn sort(findings: &mut [Finding]) {
    findings.sort_by_key(Finding::severity);
}

/// `1 datagram`, `5 datagrams`.
pub(super) fn plural(count: u64, word: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {word}{ending}")
}
