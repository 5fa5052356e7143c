//! Colours that can be read on a dark and on a light background, and none where none are wanted.

use super::view::State;
use posewire_motion::Color as Rgb;
use ratatui::style::{Color, Modifier, Style};

/// How many colours the terminal may be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Theme {
    /// None: `NO_COLOR` is set. What matters is bold or said in words.
    Plain,
    /// The 256 of the usual palette.
    Palette,
    /// Any.
    True,
}

impl Theme {
    /// What the environment says of the terminal.
    pub(super) fn of_terminal() -> Self {
        let variable = |name| std::env::var(name).unwrap_or_default();
        if !variable("NO_COLOR").is_empty() || variable("TERM") == "dumb" {
            Self::Plain
        } else if matches!(variable("COLORTERM").as_str(), "truecolor" | "24bit") {
            Self::True
        } else {
            Self::Palette
        }
    }

    pub(super) fn bad(self) -> Style {
        self.ink(Color::Red).add_modifier(Modifier::BOLD)
    }

    pub(super) fn warn(self) -> Style {
        self.ink(ORANGE).add_modifier(Modifier::BOLD)
    }

    pub(super) fn good(self) -> Style {
        self.ink(Color::Green).add_modifier(Modifier::BOLD)
    }

    pub(super) fn title(self) -> Style {
        self.ink(Color::Cyan).add_modifier(Modifier::BOLD)
    }

    pub(super) fn state(self, state: State) -> Style {
        match state {
            State::Waiting => faint(),
            State::Live => self.good(),
            State::Stale | State::Partial => self.warn(),
            State::Lost => self.bad(),
        }
    }

    /// A character's own colour, for its swatch.
    pub(super) fn own(self, color: Option<Rgb>) -> Color {
        match (self, color) {
            (Self::Plain, _) | (_, None) => Color::Reset,
            (Self::Palette, Some(Rgb(rgb))) => Color::Indexed(nearest_of_cube(rgb)),
            (Self::True, Some(Rgb([red, green, blue]))) => Color::Rgb(red, green, blue),
        }
    }

    /// A character's own colour for lines: the terminal's own ink where the colour is too near to white or black to be
    /// seen on every background.
    pub(super) fn line(self, color: Option<Rgb>) -> Color {
        self.own(color.filter(|color| VISIBLE.contains(&lightness(*color))))
    }

    /// Markers, to be told from bones.
    pub(super) fn marker(self) -> Color {
        match self {
            Self::Plain => Color::Reset,
            _ => Color::Cyan,
        }
    }

    fn ink(self, color: Color) -> Style {
        if self == Self::Plain {
            Style::new()
        } else {
            Style::new().fg(color)
        }
    }
}

pub(super) fn faint() -> Style {
    Style::new().add_modifier(Modifier::DIM)
}

pub(super) fn bold() -> Style {
    Style::new().add_modifier(Modifier::BOLD)
}

/// Thousandths of white.
fn lightness(Rgb([red, green, blue]): Rgb) -> u32 {
    (u32::from(red) * 213 + u32::from(green) * 715 + u32::from(blue) * 72) / 255
}

/// The entry of the 6 x 6 x 6 colours from 16 on that is nearest to a colour.
fn nearest_of_cube(rgb: [u8; 3]) -> u8 {
    let level = |value: u8| match value {
        0..48 => 0,
        48..115 => 1,
        _ => (value - 35) / 40,
    };
    let [red, green, blue] = rgb.map(level);
    16 + 36 * red + 6 * green + blue
}

/// Yellow is hard to read on white.
const ORANGE: Color = Color::Indexed(166);
const VISIBLE: std::ops::RangeInclusive<u32> = 150..=800;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_colour_nothing_has_one() {
        assert_eq!(Theme::Plain.bad().fg, None);
        assert_eq!(Theme::Plain.own(Some(Rgb([255, 0, 0]))), Color::Reset);
    }

    #[test]
    fn white_and_black_lines_take_the_terminals_ink() {
        for extreme in [[255; 3], [0; 3]] {
            assert_eq!(Theme::True.line(Some(Rgb(extreme))), Color::Reset);
        }
        assert_eq!(
            Theme::True.line(Some(Rgb([0xe9, 0x64, 0x17]))),
            Color::Rgb(0xe9, 0x64, 0x17)
        );
    }

    #[test]
    fn the_palette_has_its_corners_where_the_colours_are() {
        assert_eq!(nearest_of_cube([0; 3]), 16);
        assert_eq!(nearest_of_cube([255; 3]), 231);
        assert_eq!(nearest_of_cube([0xe9, 0x64, 0x17]), 16 + 36 * 4 + 6);
    }
}
