//! What the keys have set.

use super::super::protocol::Protocol;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// What the keys have set.
#[derive(Clone, Debug)]
pub(super) struct Controls {
    pub(super) quit: bool,
    pub(super) paused: bool,
    pub(super) help: bool,
    /// How many sources there are, and the place of the one that is shown.
    pub(super) sources: usize,
    pub(super) source: usize,
    /// The number of the chosen character; the first when none is chosen or it is not there.
    pub(super) selected: Option<u32>,
    /// The pane that is shown where there is no room for all of them.
    pub(super) pane: Pane,
    /// The panes that take turns in the picture that is shown.
    pub(super) turns: &'static [Pane],
    /// The first line of a list that is too long for its pane. The pane bounds it.
    pub(super) scroll: u16,
}

/// A part of the page that takes turns with others on a small terminal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Pane {
    /// What comes: the datagram types of a character, or the server.
    #[default]
    Stream,
    Figure,
    /// The numbers of a sample: joint angles, or positions.
    Details,
    Problems,
}

impl Pane {
    pub(super) const ALL: [Self; 4] = [Self::Stream, Self::Figure, Self::Details, Self::Problems];

    pub(super) const fn title(self, protocol: Protocol) -> &'static str {
        match (self, protocol) {
            (Self::Stream, Protocol::Mxtp) => "datagram types",
            (Self::Stream, Protocol::NatNet) => "server",
            (Self::Figure, _) => "figure",
            (Self::Details, Protocol::Mxtp) => "joint angles",
            (Self::Details, Protocol::NatNet) => "positions",
            (Self::Problems, _) => "problems",
        }
    }
}

impl Default for Controls {
    fn default() -> Self {
        Self {
            quit: false,
            paused: false,
            help: false,
            sources: 1,
            source: 0,
            selected: None,
            pane: Pane::default(),
            turns: &Pane::ALL,
            scroll: 0,
        }
    }
}

impl Controls {
    /// Takes a key. `characters` are the numbers of those who are there, in order.
    pub(super) fn press(&mut self, key: KeyEvent, characters: &[u32]) {
        if key.modifiers.contains(KeyModifiers::CONTROL) {
            self.quit |= key.code == KeyCode::Char('c');
            return;
        }
        let leaves_help = matches!(key.code, KeyCode::Char('?' | 'h') | KeyCode::F(1) | KeyCode::Esc);
        match key.code {
            _ if leaves_help && self.help => self.help = false,
            KeyCode::Char('q') | KeyCode::Esc => self.quit = true,
            KeyCode::Char('?' | 'h') | KeyCode::F(1) => self.help = true,
            KeyCode::Char('p' | ' ') => self.paused = !self.paused,
            _ => self.turn(key.code, characters),
        }
    }

    fn turn(&mut self, key: KeyCode, characters: &[u32]) {
        match key {
            KeyCode::Down | KeyCode::Right | KeyCode::Char('j') => self.select(characters, 1),
            KeyCode::Up | KeyCode::Left | KeyCode::Char('k') => self.select(characters, -1),
            KeyCode::Char('s') => self.show_next_source(),
            KeyCode::Tab => self.show_next(1),
            KeyCode::BackTab => self.show_next(self.turns.len().saturating_sub(1)),
            KeyCode::PageDown => self.scroll = self.scroll.saturating_add(SCROLL),
            KeyCode::PageUp => self.scroll = self.scroll.saturating_sub(SCROLL),
            KeyCode::Home => self.scroll = 0,
            _ => {}
        }
    }

    fn select(&mut self, characters: &[u32], by: isize) {
        let place = characters.iter().position(|id| Some(*id) == self.selected).unwrap_or(0);
        let place = place.saturating_add_signed(by).min(characters.len().saturating_sub(1));
        self.selected = characters.get(place).copied();
    }

    /// Its characters are others.
    fn show_next_source(&mut self) {
        if self.sources > 1 {
            self.source = (self.source + 1) % self.sources;
            (self.selected, self.scroll) = (None, 0);
        }
    }

    fn show_next(&mut self, by: usize) {
        let place = self.turns.iter().position(|pane| *pane == self.pane).unwrap_or(0);
        if let Some(pane) = self.turns.iter().cycle().nth(place + by) {
            self.pane = *pane;
            self.scroll = 0;
        }
    }
}

const SCROLL: u16 = 5;

#[cfg(test)]
mod tests {
    use super::*;

    fn after(keys: &[KeyCode]) -> Controls {
        let mut controls = Controls::default();
        for key in keys {
            controls.press(KeyEvent::from(*key), &[0, 3, 7]);
        }
        controls
    }

    #[test]
    fn arrows_choose_a_character_and_stop_at_the_ends() {
        assert_eq!(after(&[KeyCode::Down]).selected, Some(3));
        assert_eq!(after(&[KeyCode::Char('j'); 5]).selected, Some(7));
        assert_eq!(after(&[KeyCode::Down, KeyCode::Up, KeyCode::Up]).selected, Some(0));
    }

    #[test]
    fn s_goes_round_the_sources() {
        let mut controls = Controls {
            sources: 2,
            ..Controls::default()
        };
        let shown = [KeyCode::Down, KeyCode::Char('s'), KeyCode::Char('s')].map(|key| {
            controls.press(key.into(), &[0, 3]);
            (controls.source, controls.selected)
        });
        assert_eq!(shown, [(0, Some(3)), (1, None), (0, None)]);
        assert_eq!(after(&[KeyCode::Char('s')]).source, 0);
    }

    #[test]
    fn a_choice_among_nobody_is_none() {
        let mut controls = Controls::default();
        controls.press(KeyCode::Down.into(), &[]);
        assert_eq!(controls.selected, None);
    }

    #[test]
    fn tab_goes_round_the_panes_and_back() {
        assert_eq!(after(&[KeyCode::Tab; 4]).pane, Pane::Stream);
        assert_eq!(after(&[KeyCode::BackTab]).pane, Pane::Problems);
    }

    #[test]
    fn tab_chooses_among_those_that_take_turns() {
        let turns: &[Pane] = &[Pane::Figure, Pane::Details];
        let mut controls = Controls {
            turns,
            ..Controls::default()
        };
        controls.press(KeyCode::Tab.into(), &[]);
        assert_eq!(controls.pane, Pane::Details, "the figure was shown already");
        controls.press(KeyCode::Tab.into(), &[]);
        assert_eq!(controls.pane, Pane::Figure);
        controls.turns = &[];
        controls.press(KeyCode::BackTab.into(), &[]);
        assert_eq!(controls.pane, Pane::Figure);
    }

    #[test]
    fn escape_leaves_the_help_first_and_the_page_then() {
        let controls = after(&[KeyCode::Char('?'), KeyCode::Esc]);
        assert!(!controls.help && !controls.quit);
        assert!(after(&[KeyCode::Esc]).quit);
        assert!(after(&[KeyCode::Char('q')]).quit);
    }

    #[test]
    fn control_c_quits_and_c_does_not() {
        let mut controls = Controls::default();
        controls.press(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL), &[]);
        assert!(controls.quit);
        assert!(!after(&[KeyCode::Char('c')]).quit);
    }
}
