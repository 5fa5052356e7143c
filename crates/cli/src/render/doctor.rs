//! What the doctor found, as people read it.

use crate::plain::{plural, printable};
use posewire::doctor::{Finding, Severity};
use posewire::endpoint::Endpoint;
use posewire::{Error, Result};
use std::fmt::Write as _;
use std::io::Write;

/// Prints findings, and how many there are of each severity.
pub(crate) fn print_findings(findings: &[Finding], endpoint: Option<&Endpoint>) -> Result<()> {
    let text = described(findings, endpoint);
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())
        .map_err(|error| Error::write("the standard output", &error))
}

/// Findings of the same check in a row share why it matters and what to do.
fn described(findings: &[Finding], endpoint: Option<&Endpoint>) -> String {
    let mut text = String::new();
    for (place, finding) in findings.iter().enumerate() {
        let is_like = |other: Option<&Finding>| {
            other.is_some_and(|other| other.check == finding.check && other.remedy == finding.remedy)
        };
        let before = place.checked_sub(1).and_then(|before| findings.get(before));
        if !is_like(before) {
            _ = writeln!(text, "{:<INDENT$}{}", finding.severity().name(), finding.check.name());
        }
        push_wrapped(&mut text, "", &what(finding));
        if !is_like(findings.get(place + 1)) {
            push_advice(&mut text, finding);
        }
    }
    text + &counted(findings, endpoint)
}

fn what(finding: &Finding) -> String {
    let place = finding
        .place
        .as_deref()
        .map(|place| format!("{place}: "))
        .unwrap_or_default();
    printable(&format!("{place}{}", finding.what))
}

fn push_advice(text: &mut String, finding: &Finding) {
    push_wrapped(text, "    why", finding.why());
    if finding.remedy != NOTHING {
        push_wrapped(text, "    do", &printable(&finding.remedy));
    }
    text.push('\n');
}

/// `2 broken, 1 warning, 5 notes`
fn counted(findings: &[Finding], endpoint: Option<&Endpoint>) -> String {
    let count = |severity| {
        let of_it = findings.iter().filter(|finding| finding.severity() == severity);
        of_it.count() as u64
    };
    let broken = match count(Severity::Broken) {
        0 => "nothing broken".to_owned(),
        broken => format!("{broken} broken"),
    };
    let warnings = plural(count(Severity::Warning), "warning");
    let mut text = format!("{broken}, {warnings}, {}\n", plural(count(Severity::Note), "note"));
    if endpoint.is_none() {
        text += "posewire doctor mxtp://0.0.0.0 or natnet://HOST listens to a stream\n";
    }
    text
}

/// A label and words behind it, in lines of 80 columns. What is longer than a line stays whole.
fn push_wrapped(text: &mut String, label: &str, words: &str) {
    let mut line = format!("{label:<INDENT$}");
    let mut is_empty = true;
    for word in words.split_whitespace() {
        let is_full = line.chars().count() + 1 + word.chars().count() > WIDTH;
        if is_full && !is_empty {
            text.push_str(line.trim_end());
            text.push('\n');
            line = " ".repeat(INDENT);
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    text.push_str(line.trim_end());
    text.push('\n');
}

const WIDTH: usize = 80;
const INDENT: usize = 9;
const NOTHING: &str = "Nothing.";

#[cfg(test)]
mod tests {
    use super::*;
    use posewire::doctor::Check;

    fn finding(check: Check, place: &str, what: &str) -> Finding {
        Finding {
            check,
            place: (!place.is_empty()).then(|| place.to_owned()),
            what: what.to_owned(),
            remedy: check.remedy().to_owned(),
        }
    }

    #[test]
    fn findings_of_a_check_share_its_advice_and_fit_80_columns() {
        let long = "10.0.0.1:5000 and 10.0.0.2:5000 send character 0 at the same time, and much else is to be said.";
        let findings = [
            finding(Check::TwoSenders, "character 0", long),
            finding(Check::Interfaces, "eth0", "Has the address 10.0.0.1."),
            finding(Check::Interfaces, "wlan\u{1b}0", "Has the address 10.0.0.2."),
        ];
        let text = described(&findings, None);
        assert_eq!(text.matches("    why").count(), 2, "{text}");
        assert!(
            text.starts_with("broken   two-senders\n         character 0: 10.0.0.1:5000"),
            "{text}"
        );
        assert!(text.contains("1 broken, 0 warnings, 2 notes"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert!(!text.contains('\u{1b}'));
    }

    #[test]
    fn what_needs_nothing_done_is_not_told_to_do_it() {
        let text = described(&[finding(Check::Stream, "Ada", "23 segments.")], None);
        assert!(!text.contains("    do"), "{text}");
    }
}
