//! The list of characters, a line for each.

use super::super::protocol::Protocol;
use super::bodies;
use super::draw::rule;
use super::layout::top;
use super::table::{Column, Table, put, put_right, slot, width};
use super::text;
use super::theme::{Theme, bold, faint};
use super::view::{Character, State, View};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// Draws the list so that the selected character is in it.
pub(super) fn draw(buffer: &mut Buffer, mut area: Rect, view: &View, selected: &Character, theme: Theme) {
    let title = top(&mut area, 1);
    let (columns, cell): (&[Column], Cell) = match view.protocol {
        Protocol::Mxtp => (&COLUMNS, cell),
        Protocol::NatNet => (&bodies::COLUMNS, bodies::cell),
    };
    let table = Table::fit(columns, area.width);
    let head = if area.height > 1 { top(&mut area, 1) } else { Rect::ZERO };
    table.head(buffer, head, 0);
    let place = view
        .characters
        .iter()
        .position(|character| character.subject.id == selected.subject.id)
        .unwrap_or(0);
    let first = first_line(place, view.characters.len(), area.height.into());
    for (line, character) in view.characters.iter().skip(first).take(area.height.into()).enumerate() {
        let is_selected = character.subject.id == selected.subject.id;
        table.row(buffer, area, line as u16, |column, width| {
            cell(character, is_selected, (column, width), theme)
        });
    }
    draw_title(buffer, title, view, (first, area.height.into()), theme);
}

/// What a list shows of a subject, whether it is the selected one, in a column of a width.
type Cell = fn(&Character, bool, (usize, usize), Theme) -> (String, Style);

fn draw_title(buffer: &mut Buffer, line: Rect, view: &View, (first, shown): (usize, usize), theme: Theme) {
    rule(buffer, line);
    let all = view.characters.len();
    let what = view.protocol.subject();
    let text = match all {
        1 => format!(" 1 {what} "),
        _ if shown < all => format!(" {all} {what}s, {} to {} ", first + 1, all.min(first + shown)),
        _ => format!(" {all} {what}s "),
    };
    put(
        buffer,
        slot(line, 0, 1, line.width.saturating_sub(1)),
        &text,
        theme.title(),
    );
    let lost = view
        .characters
        .iter()
        .filter(|character| character.state() == State::Lost)
        .count();
    let rest = slot(line, 0, width(&text) + 1, line.width.saturating_sub(width(&text) + 2));
    if lost > 0 && rest.width > 9 {
        put_right(buffer, rest, &format!(" {lost} lost "), theme.bad());
    }
}

/// The first line of a list that keeps `place` in the middle, as far as the list goes.
fn first_line(place: usize, all: usize, shown: usize) -> usize {
    place.saturating_sub(shown / 2).min(all.saturating_sub(shown))
}

fn cell(character: &Character, is_selected: bool, (column, width): (usize, usize), theme: Theme) -> (String, Style) {
    let subject = &character.subject;
    let frame = character.frame.as_deref();
    let fastest = character.fastest();
    let state = character.state();
    let plain = if is_selected { bold() } else { Style::new() };
    let or_dash = |text: Option<String>| (text.unwrap_or_else(|| "-".to_owned()), plain);
    match column {
        MARK => (if is_selected { "▸" } else { "" }.to_owned(), bold()),
        SWATCH if theme == Theme::Plain || subject.color.is_none() => (String::new(), plain),
        SWATCH => ("██".to_owned(), Style::new().fg(theme.own(subject.color))),
        NUMBER => (subject.id.to_string(), plain),
        NAME => (subject.name.clone(), plain),
        STATE => (state_text(state).to_owned(), theme.state(state)),
        SEGMENTS => (subject.skeleton.segments.len().to_string(), plain),
        RATE => or_dash(fastest.map(|row| text::rate(row.rate_hz))),
        STRIDE => or_dash(
            fastest
                .and_then(|row| row.counters.stride)
                .map(|stride| stride.to_string()),
        ),
        TIMECODE => or_dash(character.timecode.map(|timecode| timecode.to_string())),
        SAMPLE => or_dash(frame.map(|frame| text::count(frame.sample.into(), width))),
        TIME => or_dash(frame.map(|frame| format!("{:.3}", frame.time.as_secs_f64()))),
        _ if state == State::Waiting => ("-".to_owned(), faint()),
        _ => (format!("{:.1}", character.age.as_secs_f64()), plain),
    }
}

/// The state in a word and a shape: not by colour alone.
pub(super) const fn state_text(state: State) -> &'static str {
    match state {
        State::Waiting => "○ WAIT",
        State::Live => "● LIVE",
        State::Partial => "◔ PART",
        State::Stale => "◐ STALE",
        State::Lost => "✗ LOST",
    }
}

const MARK: usize = 0;
const SWATCH: usize = 1;
const NUMBER: usize = 2;
const NAME: usize = 3;
const STATE: usize = 4;
const SEGMENTS: usize = 5;
const RATE: usize = 6;
const STRIDE: usize = 7;
const TIMECODE: usize = 8;
const SAMPLE: usize = 9;
const TIME: usize = 10;

const COLUMNS: [Column; 12] = [
    Column::text("", (1, 1), 2),
    Column::text("", (2, 2), 5),
    Column::number(("#", "#"), (2, 2), 3),
    Column::text("name", (13, 30), 0),
    Column::text("state", (7, 8), 1),
    Column::number(("segm", "segments"), (4, 8), 8),
    Column::number(("rate", "rate Hz"), (6, 8), 4),
    Column::number(("strd", "stride"), (4, 6), 9),
    Column::text("timecode", (12, 12), 6),
    Column::number(("sample", "sample"), (7, 10), 7),
    Column::number(("time s", "time s"), (9, 10), 10),
    Column::number(("age s", "age s"), (6, 6), 11),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_list_keeps_the_selected_character_in_sight() {
        assert_eq!(first_line(0, 64, 5), 0);
        assert_eq!(first_line(30, 64, 5), 28);
        assert_eq!(first_line(63, 64, 5), 59);
        assert_eq!(first_line(2, 3, 5), 0);
        assert_eq!(first_line(2, 3, 0), 2);
    }
}
