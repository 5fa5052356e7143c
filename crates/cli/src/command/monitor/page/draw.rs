//! The whole page.

use super::super::protocol::Protocol;
use super::controls::{Controls, Pane};
use super::layout::{Layout, Wanted, top};
use super::problems::Problem;
use super::table::{put, put_right, slot, width};
use super::theme::{Theme, bold, faint};
use super::view::{Character, View};
use super::{angles, characters, figure, header, overlay, positions, problems, server, types};
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Draws the page. Gives the panes that take turns in it.
pub(super) fn draw(frame: &mut Frame, view: &View, controls: &Controls, theme: Theme) -> &'static [Pane] {
    let area = frame.area();
    let buffer = frame.buffer_mut();
    let turns: &[Pane] = if let Some(selected) = view.character(controls.selected) {
        draw_stream(buffer, area, view, selected, controls, theme)
    } else {
        draw_silence(buffer, area, view, controls, theme);
        &[]
    };
    if controls.help {
        overlay::draw_help(buffer, area, view.protocol, theme);
    }
    turns
}

fn draw_silence(buffer: &mut Buffer, area: Rect, view: &View, controls: &Controls, theme: Theme) {
    let wanted = Wanted {
        characters: 0,
        share: 1,
        stream: 0,
        details: 0,
        problems: 0,
    };
    let layout = Layout::new(area, wanted, Pane::Stream);
    let mut rest = area;
    top(&mut rest, 1);
    rest.height -= layout.footer.height;
    header::draw(buffer, layout.header, view, controls, theme);
    overlay::draw_silence(buffer, rest, view, theme);
    header::draw_keys(buffer, layout.footer, 0, view);
}

fn draw_stream(
    buffer: &mut Buffer,
    area: Rect,
    view: &View,
    selected: &Character,
    controls: &Controls,
    theme: Theme,
) -> &'static [Pane] {
    let problems = problems::of(view, selected);
    let layout = Layout::new(area, wanted(view, selected, &problems), controls.pane);
    header::draw(buffer, layout.header, view, controls, theme);
    characters::draw(buffer, layout.characters, view, selected, theme);
    for (place, (pane, part)) in layout.panes.iter().enumerate() {
        let takes_turns = place + 1 == layout.panes.len();
        let titles = (*pane, if takes_turns { layout.turns } else { &[] }, view.protocol);
        let body = draw_title(buffer, *part, titles, selected, theme);
        match (pane, view.protocol) {
            (Pane::Stream, Protocol::Mxtp) => types::draw(buffer, body, selected, theme),
            (Pane::Stream, Protocol::NatNet) => server::draw(buffer, body, view.server.as_ref(), selected, theme),
            (Pane::Figure, protocol) => figure::draw(buffer, body, selected, protocol, theme),
            (Pane::Details, Protocol::Mxtp) => angles::draw(buffer, body, selected, controls.scroll),
            (Pane::Details, Protocol::NatNet) => positions::draw(buffer, body, selected, controls.scroll, theme),
            (Pane::Problems, _) => problems::draw(buffer, body, &problems, theme),
        }
    }
    header::draw_keys(buffer, layout.footer, layout.turns.len(), view);
    draw_hint(buffer, area, layout.characters.bottom(), view, theme);
    layout.turns
}

fn wanted(view: &View, selected: &Character, problems: &[Problem]) -> Wanted {
    let (share, stream, details) = match view.protocol {
        Protocol::Mxtp => (4, types::lines(selected), angles::count(selected)),
        Protocol::NatNet => (3, server::LINES, positions::count(selected)),
    };
    Wanted {
        characters: lines(view.characters.len()),
        share,
        stream,
        details: lines(details),
        problems: lines(problems.len()),
    }
}

/// Draws what to check, if there is something, from a few lines below the list on.
fn draw_hint(buffer: &mut Buffer, area: Rect, list_end: u16, view: &View, theme: Theme) {
    let Some(hint) = &view.hint else { return };
    let mut rest = area;
    top(&mut rest, list_end.saturating_sub(area.y) + NAME_OF_SERVER);
    let place = if rest.height < ROOM_FOR_HINT { area } else { rest };
    overlay::draw_hint(buffer, place, hint, &view.remarks, theme);
}

/// A rule with the pane's name, or with the names of all that take turns; gives what is below.
fn draw_title(
    buffer: &mut Buffer,
    mut area: Rect,
    (pane, turns, protocol): (Pane, &[Pane], Protocol),
    selected: &Character,
    theme: Theme,
) -> Rect {
    let line = top(&mut area, 1);
    rule(buffer, line);
    let mut x = 1;
    let mut say = |text: &str, style| {
        put(buffer, slot(line, 0, x, width(text)), text, style);
        x = x.saturating_add(width(text));
    };
    if turns.len() < 2 {
        say(&format!(" {} ", pane.title(protocol)), theme.title());
    } else {
        for turn in turns {
            let shown = *turn == pane;
            let name = if shown {
                format!(" [{}] ", turn.title(protocol))
            } else {
                format!(" {} ", turn.title(protocol))
            };
            say(&name, if shown { theme.title() } else { faint() });
        }
    }
    if pane == Pane::Figure || turns.len() > 1 {
        let name = format!(" {} ", selected.subject.name);
        let end = slot(line, 0, x, line.width.saturating_sub(x + 1));
        if end.width >= width(&name) {
            put_right(buffer, end, &name, bold());
        }
    }
    area
}

/// A thin line across.
pub(super) fn rule(buffer: &mut Buffer, line: Rect) {
    put(buffer, line, &"─".repeat(line.width.into()), faint());
}

/// A title, and the lines of a server that are worth seeing beside a hint.
const NAME_OF_SERVER: u16 = 4;
const ROOM_FOR_HINT: u16 = 12;

fn lines(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX / 2)
}

#[cfg(test)]
mod natnet_tests;
#[cfg(test)]
mod tests;
