//! When a client has what to do.

use std::time::Duration;

use posewire_motion::Stamp;

use super::{ClientOptions, Mode};
use crate::retry::Retry;

/// The timers of a client.
#[derive(Debug)]
pub(super) struct Timers {
    /// Runs until the server answers.
    pub(super) connect: Retry,
    /// Runs until the descriptions come.
    pub(super) model: Retry,
    pub(super) keep_alive: Retry,
    pub(super) echo: Retry,
    /// Runs while a server that answers no echoes is connected: it is asked to connect instead.
    pub(super) probe: Retry,
    /// Starts again with every frame. A server that answers but sends no frames may have forgotten the client.
    pub(super) stalled: Retry,
    frames_due: Option<Stamp>,
}

impl Timers {
    pub(super) fn new(options: &ClientOptions) -> Self {
        Self {
            connect: Retry::new(options.retry, LONGEST_RETRY),
            model: Retry::new(options.retry, LONGEST_RETRY),
            keep_alive: Retry::every(options.keep_alive),
            echo: Retry::every(options.echo),
            probe: Retry::every(options.keep_alive),
            stalled: Retry::new(options.lost_after, options.lost_after * 4),
            frames_due: None,
        }
    }

    /// A server has answered.
    pub(super) fn connected(&mut self, now: Stamp, has_clock: bool, options: &ClientOptions) {
        *self = Self::new(options);
        self.model.start(now);
        if options.mode == Mode::Unicast {
            self.keep_alive.start(now.after(options.keep_alive));
        }
        if has_clock {
            self.echo.start(now);
        } else {
            self.probe.start(now.after(options.keep_alive));
        }
        self.frame_came(now, options);
    }

    /// Waits for the next frame. True when this one comes after a pause.
    pub(super) fn frame_came(&mut self, now: Stamp, options: &ClientOptions) -> bool {
        let was_due = self.frames_due.is_some_and(|due| due <= now);
        let due = now.after(options.lost_after);
        self.frames_due = Some(due);
        self.stalled.start(due);
        was_due
    }

    pub(super) fn next(&self) -> Option<Stamp> {
        let timers = [
            &self.connect,
            &self.model,
            &self.keep_alive,
            &self.echo,
            &self.probe,
            &self.stalled,
        ];
        timers.into_iter().filter_map(Retry::next).min()
    }
}

const LONGEST_RETRY: Duration = Duration::from_secs(2);
