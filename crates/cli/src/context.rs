//! What every verb needs of its surroundings: the wish to stop, the terminal, people to talk to.

use crate::plain::printable;
use posewire::remote::Remote;
use posewire::stop::Stop;
use posewire::{Item, Notice, Result, Sink, SourceId, Wants};
use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// A stop that Ctrl-C and a request to terminate set; the second one ends the program at once.
pub(crate) fn stop_on_interrupt() -> anyhow::Result<Stop> {
    let stop = Stop::new();
    let on_interrupt = stop.clone();
    ctrlc::set_handler(move || {
        if on_interrupt.is_stopped() {
            std::process::exit(130);
        }
        on_interrupt.stop();
    })?;
    Ok(stop)
}

/// What Ctrl-C ends: what is being captured, if anything is, and else the work.
#[derive(Clone, Default)]
pub(crate) struct Stops {
    pub(crate) work: Stop,
    capture: Arc<Mutex<Option<Stop>>>,
}

impl Stops {
    /// The stop of a capture that begins. What it captured can then be written, until Ctrl-C is pressed again.
    pub(crate) fn begin_capture(&self) -> Stop {
        let stop = Stop::new();
        *self.capturing() = Some(stop.clone());
        stop
    }

    pub(crate) fn end_capture(&self) {
        *self.capturing() = None;
    }

    fn interrupt(&self) {
        if let Some(capture) = self.capturing().take() {
            capture.stop();
        } else if self.work.is_stopped() {
            std::process::exit(130);
        } else {
            self.work.stop();
        }
    }

    fn capturing(&self) -> MutexGuard<'_, Option<Stop>> {
        self.capture.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Stops that Ctrl-C and a request to terminate set; once all is stopped, another one ends the program at once.
pub(crate) fn stops_on_interrupt() -> anyhow::Result<Stops> {
    let stops = Stops::default();
    let on_interrupt = stops.clone();
    ctrlc::set_handler(move || on_interrupt.interrupt())?;
    Ok(stops)
}

/// Says where commands are taken.
pub(crate) fn announce_remote(remote: &Remote) {
    say(format_args!("remote control on udp {}", remote.local_address()));
}

/// Says what came of a command.
pub(crate) fn tell_of_remote(line: &str) {
    end_progress();
    say(format_args!("remote {}", printable(line)));
}

/// What this program calls itself to those who control it.
pub(crate) const REMOTE_NAME: &str = "posewire";

/// Sets `stop` after a while, if one is given.
pub(crate) fn stop_after(stop: &Stop, duration: Option<Duration>) {
    if let Some(duration) = duration {
        let stop = stop.clone();
        thread::spawn(move || {
            if !stop.wait(duration) {
                stop.stop();
            }
        });
    }
}

/// Whether a live page can be shown.
pub(crate) fn has_terminal() -> bool {
    std::io::stdout().is_terminal() && std::io::stdin().is_terminal()
}

/// Says something to people, beside the results.
pub(crate) fn say(text: impl std::fmt::Display) {
    // Nobody reads it when the standard error is closed.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Says what sources have to say, and keeps what of them was lost.
#[derive(Clone, Default)]
pub(crate) struct Teller {
    heard: Arc<Mutex<Heard>>,
}

#[derive(Default)]
struct Heard {
    lost_here: BTreeMap<SourceId, u64>,
    damage: Option<String>,
}

impl Teller {
    /// How many datagrams were lost on this machine before the sources could read them.
    pub(crate) fn lost_here(&self) -> u64 {
        self.heard().lost_here.values().sum()
    }

    /// Whether a file ended before its end.
    pub(crate) fn is_damaged(&self) -> bool {
        self.heard().damage.is_some()
    }

    /// What ended a file before its end.
    pub(crate) fn damage(&self) -> Option<String> {
        self.heard().damage.clone()
    }

    fn heard(&self) -> MutexGuard<'_, Heard> {
        self.heard.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for Teller {
    fn wants(&self) -> Wants {
        Wants {
            frames: false,
            ..Wants::default()
        }
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        match item {
            Item::Notice(notice) => {
                if let Notice::Damaged { problem, .. } = notice {
                    self.heard().damage.get_or_insert_with(|| problem.clone());
                }
                end_progress();
                say(notice);
            }
            Item::Statistics(statistics) => {
                self.heard().lost_here.insert(source, statistics.lost_here());
            }
            _ => {}
        }
        Ok(())
    }
}

/// Whether [`show_progress`] shows something.
pub(crate) fn shows_progress() -> bool {
    std::io::stderr().is_terminal()
}

/// Shows how far it has come, in place, when the standard error is a terminal.
pub(crate) fn show_progress(text: impl std::fmt::Display) {
    let mut stderr = std::io::stderr().lock();
    if stderr.is_terminal() {
        let _ = write!(stderr, "\r\x1b[2K{text}");
        let _ = stderr.flush();
    }
}

/// Removes the line of [`show_progress`].
pub(crate) fn end_progress() {
    show_progress("");
}
