//! What sets the clock of this machine.

use super::super::{Check, Finding};
use super::processes;
use std::path::Path;

/// What sets the clock, as far as running programs tell; `None` where there are none to be seen.
pub(super) fn finding() -> Option<Finding> {
    let mut names = processes::all().map(|process| process.name).peekable();
    names.peek()?;
    let setters: Vec<_> = names.filter(|name| SETTERS.contains(&name.as_str())).collect();
    let is_set = Path::new("/run/systemd/timesync/synchronized").exists();
    Some(of(&setters, is_set))
}

fn of(setters: &[String], is_set: bool) -> Finding {
    let what = match setters {
        [] if is_set => "The clock has been set by systemd-timesyncd.".to_owned(),
        [] => "No program that sets the clock is running here; in a virtual machine its host may do it.".to_owned(),
        all => {
            let is_sure = if is_set { ", and it has been set" } else { "" };
            format!("The clock is kept by {}{is_sure}.", all.join(" and "))
        }
    };
    let finding = Finding::new(Check::ClockSync, what);
    if setters.is_empty() && !is_set {
        finding.with_remedy("Where clocks of several machines matter, run chrony, or ptp4l for a network that has PTP.")
    } else {
        finding
    }
}

/// As their processes are called, after 15 bytes cut off.
const SETTERS: [&str; 8] = [
    "chronyd",
    "systemd-timesyn",
    "ntpd",
    "openntpd",
    "ptp4l",
    "phc2sys",
    "timemaster",
    "ntpsec",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keepers_of_the_clock_are_named() {
        let setters = ["ptp4l", "phc2sys"].map(str::to_owned);
        assert_eq!(of(&setters, false).what, "The clock is kept by ptp4l and phc2sys.");
        assert!(of(&[], false).what.starts_with("No program"));
        assert!(of(&[], true).what.contains("timesyncd"));
    }
}
