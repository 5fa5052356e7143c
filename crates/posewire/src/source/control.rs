//! Pausing a playback and jumping in it, from any thread.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Pauses a playback and jumps in it, from any thread, before and while it runs. Clones control the same playback.
///
/// A sample that is jumped to is sent at once, also while paused, and has its own number: the stream goes back or ahead as MVN's
/// does when somebody moves its cursor. While paused nothing else is sent.
#[derive(Clone, Debug, Default)]
pub struct PlaybackControl {
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    paused: bool,
    jump: Option<Jump>,
    stays: bool,
    at_end: bool,
}

/// Where to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Jump {
    Start,
    Sample(u32),
}

impl PlaybackControl {
    /// Pauses, or goes on; from the start where the end was reached. Gives whether it is paused now.
    pub fn play_or_pause(&self) -> bool {
        let mut state = self.lock();
        state.paused = !state.paused;
        if !state.paused && std::mem::take(&mut state.at_end) {
            state.jump = Some(Jump::Start);
        }
        state.paused
    }

    /// Goes to the first sample.
    pub fn jump_to_start(&self) {
        self.jump(Jump::Start);
    }

    /// Goes to the sample of this number, or the first one after it; to the last sample where there is none.
    pub fn jump_to(&self, sample: u32) {
        self.jump(Jump::Sample(sample));
    }

    /// Whether it is paused.
    pub fn is_paused(&self) -> bool {
        self.lock().paused
    }

    /// Makes the playback pause at its end, where it would be over.
    pub fn stay_at_end(&self) {
        self.lock().stays = true;
    }

    fn jump(&self, jump: Jump) {
        let mut state = self.lock();
        state.jump = Some(jump);
        state.at_end = false;
    }

    /// Where to jump to, once.
    pub(super) fn take_jump(&self) -> Option<Jump> {
        self.lock().jump.take()
    }

    /// Whether somebody waits for a jump.
    pub(super) fn wants_jump(&self) -> bool {
        self.lock().jump.is_some()
    }

    /// Whether there is nothing to do but wait.
    pub(super) fn holds(&self) -> bool {
        let state = self.lock();
        state.paused && state.jump.is_none()
    }

    /// The playback has come to its end. Gives whether it waits there.
    pub(super) fn end(&self) -> bool {
        let mut state = self.lock();
        if state.stays {
            (state.paused, state.at_end) = (true, true);
        }
        state.stays
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_at_the_end_begins_anew_and_a_jump_does_not() {
        let control = PlaybackControl::default();
        assert!(!control.end(), "nobody has asked it to stay");
        control.stay_at_end();
        assert!(control.end() && control.holds());
        assert!(!control.play_or_pause());
        assert_eq!(control.take_jump(), Some(Jump::Start));

        assert!(control.end());
        control.jump_to(7);
        assert!(control.is_paused() && !control.holds());
        assert_eq!(control.take_jump(), Some(Jump::Sample(7)));
        assert!(!control.play_or_pause());
        assert_eq!(control.take_jump(), None);
    }
}
