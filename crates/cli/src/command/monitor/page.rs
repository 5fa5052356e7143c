//! The live page of a terminal: a screen, the keys, and twenty pictures a second at most.

mod angles;
mod blocks;
mod bodies;
mod characters;
mod controls;
mod draw;
#[cfg(test)]
mod example;
mod figure;
mod header;
mod layout;
mod overlay;
mod pose;
mod positions;
mod problems;
mod server;
mod stick;
mod table;
mod text;
mod theme;
mod transit;
mod types;
mod view;
mod watch;

use super::board::Board;
use controls::{Controls, Pane};
use posewire::stop::Stop;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyEvent, KeyEventKind};
use std::mem::ManuallyDrop;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};
use theme::Theme;
use view::View;
use watch::Watch;

/// Shows the boards, one at a time, until `q` is pressed or `stop` is set.
pub(super) fn run(boards: &[Board], stop: &Stop) -> anyhow::Result<()> {
    let mut screen = Screen::open()?;
    let keys = read_keys();
    let mut watches: Vec<_> = boards.iter().map(|_| Watch::new(Instant::now())).collect();
    let mut controls = Controls {
        sources: boards.len(),
        ..Controls::default()
    };
    let theme = Theme::of_terminal();
    let mut views = look(&mut watches, boards, Instant::now());
    while !stop.is_stopped() && !controls.quit {
        let begun = Instant::now();
        if !controls.paused {
            views = look(&mut watches, boards, begun);
        }
        let Some(view) = views.get(controls.source) else { break };
        let mut turns: &[Pane] = &[];
        screen
            .0
            .draw(|frame| turns = draw::draw(frame, view, &controls, theme))?;
        controls.turns = turns;
        press_keys(&keys, &mut controls, &view.ids(), begun + PICTURE);
    }
    Ok(())
}

/// Also at those that are not shown, which go on.
fn look(watches: &mut [Watch], boards: &[Board], now: Instant) -> Vec<View> {
    let both = watches.iter_mut().zip(boards);
    both.map(|(watch, board)| watch.look(board, now)).collect()
}

/// Reads keys on a thread of its own, which lives as long as the program: reading from a terminal that has been closed
/// never returns.
fn read_keys() -> Receiver<KeyEvent> {
    let (sender, keys) = mpsc::sync_channel(QUEUED_KEYS);
    thread::spawn(move || {
        while let Ok(event) = event::read() {
            if let Event::Key(key) = event
                && key.kind != KeyEventKind::Release
                && sender.send(key).is_err()
            {
                break;
            }
        }
    });
    keys
}

/// Takes what is typed until it is time for the next picture. A key is answered at once when the time has come anyway.
fn press_keys(keys: &Receiver<KeyEvent>, controls: &mut Controls, characters: &[u32], until: Instant) {
    while !controls.quit {
        match keys.recv_timeout(until.saturating_duration_since(Instant::now())) {
            Ok(key) => controls.press(key, characters),
            Err(RecvTimeoutError::Timeout) => break,
            // Nobody can ask for the end any more.
            Err(RecvTimeoutError::Disconnected) => controls.quit = true,
        }
    }
}

/// The terminal in raw mode on its second screen, put back on every way out: a return, an error, a panic.
///
/// Not dropped as usual: a terminal that has gone cannot show its cursor again, and dropped it would complain of that on
/// the standard error, which has gone with it, and panic.
struct Screen(ManuallyDrop<DefaultTerminal>);

impl Screen {
    fn open() -> std::io::Result<Self> {
        let terminal = ratatui::try_init().inspect_err(|_| restore())?;
        Ok(Self(ManuallyDrop::new(terminal)))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.0.show_cursor();
        restore();
    }
}

/// A terminal that has gone needs no restoring, and nobody is left there to be told.
fn restore() {
    let _ = ratatui::try_restore();
}

/// Twenty pictures a second are as many as an eye can use of numbers.
const PICTURE: Duration = Duration::from_millis(50);
const QUEUED_KEYS: usize = 64;
