//! How far a file has come, shown while it is worked on.

use crate::context::{end_progress, show_progress};
use posewire::file::Progress;
use posewire::stop::Stop;
use std::fmt::Display;
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// A bar on the standard error, when that is a terminal. It is redrawn by a thread of its own.
pub(super) struct Bar {
    progress: Progress,
    done: Stop,
    thread: JoinHandle<()>,
}

impl Bar {
    /// Begins to show how far it has come what is done with a file; `stop` ends the work.
    pub(super) fn start(doing: &'static str, what: impl Display, stop: &Stop) -> Self {
        let (progress, done, what) = (Progress::new(stop.clone()), Stop::new(), what.to_string());
        let (shown, ended) = (progress.clone(), done.clone());
        let thread = thread::spawn(move || {
            while !ended.wait(EVERY) {
                show_progress(format_args!("{doing} {what} {}", drawn(shown.done(), shown.total())));
            }
        });
        Self { progress, done, thread }
    }

    pub(super) fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Removes the bar.
    pub(super) fn end(self) {
        self.done.stop();
        // It only draws.
        let _ = self.thread.join();
        end_progress();
    }
}

fn drawn(done: u64, total: u64) -> String {
    let share = if total == 0 {
        0.0
    } else {
        (done as f64 / total as f64).min(1.0)
    };
    let full = (share * WIDTH as f64) as usize;
    format!(
        "[{}{}] {:3.0} %",
        "#".repeat(full),
        "-".repeat(WIDTH - full),
        share * 100.0
    )
}

const EVERY: Duration = Duration::from_millis(200);
const WIDTH: usize = 30;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_is_filled_by_its_share() {
        assert_eq!(drawn(1, 3), "[##########--------------------]  33 %");
        assert_eq!(drawn(0, 0), format!("[{}]   0 %", "-".repeat(30)));
        assert_eq!(drawn(9, 3), format!("[{}] 100 %", "#".repeat(30)));
    }
}
